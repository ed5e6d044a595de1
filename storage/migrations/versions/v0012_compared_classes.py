"""Compared caps are summed up by class, so that figures of groups need not read all of them."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None

ALIKE = ("image", "run", "annotator", "size", "shape", "visibility", "doubtful", "unsure", "ignored")
COUNTS = {
    "caps": "*",
    "measured": "cdr",
    "floors": "CASE WHEN cdr IS NOT NULL THEN floor END",
    "matched": "CASE WHEN annotation IS NOT NULL AND prediction IS NOT NULL THEN 1 END",
    "missed": "CASE WHEN prediction IS NULL THEN 1 END",
    "extra": "CASE WHEN annotation IS NULL THEN 1 END",
}
SUMS = {
    "cdr": "sum(cdr)",
    "floor": "sum(CASE WHEN cdr IS NOT NULL THEN floor END)",
    "dx": "sum(dx)",
    "dy": "sum(dy)",
    "cdr_worst": "max(cdr)",
}


def upgrade() -> None:
    """Makes the table and sums up what is compared already."""
    op.create_table(
        "compared_class",
        *(sa.Column(name, sa.Integer(), nullable=False) for name in ("image", "run")),
        *(sa.Column(name, sa.Text()) for name in ("annotator", "size", "shape", "visibility")),
        *(sa.Column(name, sa.Integer(), nullable=False) for name in ("doubtful", "unsure", "ignored")),
        *(sa.Column(name, sa.Integer(), nullable=False) for name in COUNTS),
        *(sa.Column(name, REAL) for name in SUMS),
        *(
            sa.ForeignKeyConstraint([name], [f"{name}.id"], name=op.f(f"fk_compared_class_{name}"))
            for name in ("image", "run")
        ),
        sqlite_strict=True,
    )
    op.create_index(op.f("ix_compared_class_run_image"), "compared_class", ["run", "image"], unique=False)
    columns = ", ".join((*ALIKE, *COUNTS, *SUMS))
    counted = ", ".join((*ALIKE, *(f"count({what})" for what in COUNTS.values()), *SUMS.values()))
    op.execute(
        f"INSERT INTO compared_class ({columns}) SELECT {counted} FROM compared_cap "
        f"GROUP BY {', '.join(ALIKE)}"
    )
