"""The images that a reviewer goes through, in order; how much outlines and predictions overlap."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Makes the table, and adds the column, which is filled when an image is compared again."""
    op.add_column("comparison", sa.Column("iou_mean", REAL))
    op.create_table(
        "queue",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("title", sa.Text(), nullable=False),
        sa.Column("images", sa.Text(), nullable=False),
        sa.Column("plan", sa.Text()),
        sa.Column("after_verdict", sa.Integer(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.Column("ended_at", sa.Text()),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_queue")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(op.f("ix_queue_user"), "queue", ["user"], unique=False)
