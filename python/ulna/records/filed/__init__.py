"""What each of Ulna's formats says of an arm: a file for each, a row in `registry`."""
