"""How sure marked centres are is kept with annotations, and with what is compared with them."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Adds the columns; caps that were fitted before have none until they are edited again."""
    op.add_column("annotation", sa.Column("sd_x", REAL))
    op.add_column("annotation", sa.Column("sd_y", REAL))
    op.add_column("comparison", sa.Column("floor_mean", REAL))
