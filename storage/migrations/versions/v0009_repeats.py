"""Caps that were marked again are kept, apart from labels; compared caps say whose they are and their kind.

Comparisons can be made anew at any time; older ones, which do not say this of their caps, are dropped.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")
TEXTS = ("annotator", "size", "shape", "visibility")
COUNTS = ("measured", "doubtful", "unsure", "ignored")
NUMBERS = ("own_floor", "dx", "dy")

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Makes the table and the columns."""
    op.create_table(
        "repeat",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("annotation", sa.Text(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("mirrored", sa.Integer(), nullable=False),
        sa.Column("first", sa.Text(), nullable=False),
        sa.Column("second", sa.Text(), nullable=False),
        sa.Column("size", sa.Text()),
        sa.Column("visibility", sa.Text()),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["annotation"], ["annotation.uid"], name=op.f("fk_repeat_annotation")),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_repeat_image")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_repeat")),
        sa.UniqueConstraint("id", name=op.f("uq_repeat_id")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    for column in ("annotation", "image"):
        op.create_index(op.f(f"ix_repeat_{column}"), "repeat", [column], unique=False)
    op.execute("DELETE FROM compared_cap")
    op.execute("DELETE FROM comparison")
    for name in TEXTS:
        op.add_column("compared_cap", sa.Column(name, sa.Text()))
    for name in NUMBERS:
        op.add_column("compared_cap", sa.Column(name, REAL))
    for name in COUNTS:
        op.add_column("comparison", sa.Column(name, sa.Integer(), nullable=False, server_default="0"))
    op.add_column("compared_cap", sa.Column("ignored", sa.Integer(), nullable=False, server_default="0"))
