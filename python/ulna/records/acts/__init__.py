"""What can be done to a record: a file for each act, a row in `registry`."""
