"""The whole ellipse that a network sees of a cap is kept with the prediction."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Adds the column; of predictions that were made before nothing is known."""
    op.add_column("prediction", sa.Column("likely_whole", sa.Text))
