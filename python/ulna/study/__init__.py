"""What to fit to what: a study, its file, its readings, and how it enters the core."""
