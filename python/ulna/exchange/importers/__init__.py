"""Bring in readings that others have measured: a folder of theirs in, a study folder of Ulna's out."""
