"""Drawings of what documents say, on axes of Matplotlib."""
