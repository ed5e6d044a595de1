"""What people said of pieces of an outline is kept beside it."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0011"
down_revision = "0010"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Adds the column; nobody had said anything before."""
    op.add_column("annotation", sa.Column("arcs", sa.Text()))
