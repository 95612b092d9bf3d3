"""Who calibrates and what for: laboratory files."""
