"""An arm that nobody has described: which channel is which joint, which way it counts, how far it goes, how it errs."""
