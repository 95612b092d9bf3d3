"""Alembic's own folder: `env.py`, which it runs, and the versions of the schema."""
