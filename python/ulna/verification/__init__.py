"""Acceptance tests: touches to figures, figures to decisions."""
