"""What is measured on the masks of an image is kept with it."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Adds the column; images that were fitted before are measured when they are next."""
    op.add_column("image", sa.Column("statistics", sa.Text()))
