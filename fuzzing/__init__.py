"""Hostile inputs for every door of Ulna: the same for a seed, each through the command as people call it."""
