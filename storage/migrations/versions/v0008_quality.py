"""How good a prediction's outline is held to be is kept beside its score."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Adds the column; of predictions that were made before nothing is known."""
    op.add_column("prediction", sa.Column("quality", REAL))
