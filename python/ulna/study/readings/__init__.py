"""Readings from tables: columns, checks, merging."""
