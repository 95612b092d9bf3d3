"""What documents are made from besides the result: one file and one row each."""
