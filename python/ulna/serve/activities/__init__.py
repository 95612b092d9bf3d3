"""What is done with a stream, one file a kind: each turns what comes into events, and words into deeds."""
