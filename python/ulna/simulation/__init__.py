"""Arms that are only numbers: they are moved, touch things and are read, and the truth is known."""
