"""One file for each kind of door."""
