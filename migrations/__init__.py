"""Alembic's migrations; `server.database.migrate` runs them."""
