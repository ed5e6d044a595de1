"""Alembic's upgrades of the schema."""
