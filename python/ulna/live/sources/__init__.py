"""One file for each way in which readings come."""
