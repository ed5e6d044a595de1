"""Called by alembic: migrates over the connection that ``storage.db.upgrade`` passes in."""

from __future__ import annotations

from alembic import context

from fairyring.storage.db.comparison_schema import metadata  # with all tables, so not that of schema

context.configure(connection=context.config.attributes["connection"], target_metadata=metadata)
with context.begin_transaction():
    context.run_migrations()
