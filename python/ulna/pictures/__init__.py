"""An arm drawn: its bodies with what is drawn of each, and how they look from somewhere. No words, no files."""
