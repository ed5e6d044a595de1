"""What a comparison says of each cap is kept, so that the worst of all images can be listed at once.

Comparisons can be made anew at any time; older ones, which lack their caps, are dropped.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Makes the table."""
    op.create_table(
        "compared_cap",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("run", sa.Integer(), nullable=False),
        sa.Column("annotation", sa.Text()),
        sa.Column("prediction", sa.Integer()),
        sa.Column("iou", REAL),
        sa.Column("cdr", REAL),
        sa.Column("floor", REAL),
        sa.Column("doubtful", sa.Integer(), nullable=False),
        sa.Column("unsure", sa.Integer(), nullable=False),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_compared_cap_image")),
        sa.ForeignKeyConstraint(["run"], ["run.id"], name=op.f("fk_compared_cap_run")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_compared_cap")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(op.f("ix_compared_cap_run_image"), "compared_cap", ["run", "image"], unique=False)
    op.execute("DELETE FROM comparison")
