"""`ulna live`: its commands."""
