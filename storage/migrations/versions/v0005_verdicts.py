"""What reviewers say of images and caps is kept as a history; a project has rules of its own.

Approvals that were given before are in the history of statuses, and become verdicts.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

APPROVALS = """
    INSERT INTO verdict (id, digest, image, says, words, "user", made_at, change_set)
    SELECT 'status-of-' || CAST(sequence AS TEXT), 'unknown', image, 'approved', '',
        "user", made_at, change_set
    FROM status_change WHERE after = 'approved' AND id IS NOT NULL ORDER BY sequence
"""


def upgrade() -> None:
    """Makes the table, enters the approvals that are known, and adds the column of the rules."""
    _make_table()
    op.add_column("project", sa.Column("rules", sa.Text()))
    op.execute(APPROVALS)
    if op.get_bind().dialect.name == "sqlite":
        for change in ("UPDATE", "DELETE"):
            op.execute(
                f"CREATE TRIGGER verdict_refuses_{change.lower()} BEFORE {change} ON verdict "
                f"BEGIN SELECT RAISE(ABORT, 'the journal is append-only'); END"
            )


def _make_table() -> None:
    op.create_table(
        "verdict",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("digest", sa.Text(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("annotation", sa.Text()),
        sa.Column("revision", sa.Integer()),
        sa.Column("says", sa.Text(), nullable=False),
        sa.Column("words", sa.Text(), nullable=False),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.Column("change_set", sa.Integer()),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_verdict_image")),
        sa.ForeignKeyConstraint(["annotation"], ["annotation.uid"], name=op.f("fk_verdict_annotation")),
        sa.ForeignKeyConstraint(["change_set"], ["change_set.sequence"], name=op.f("fk_verdict_change_set")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_verdict")),
        sa.UniqueConstraint("id", name=op.f("uq_verdict_id")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    for column in ("image", "annotation", "change_set"):
        op.create_index(op.f(f"ix_verdict_{column}"), "verdict", [column], unique=False)
