"""Frames of a chain: rigid transforms, links between axes, the two conventions called Denavit–Hartenberg."""
