"""The first schema: images, predictions, annotations, the journal of edits, and review figures."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

REAL = sa.Double().with_variant(sa.REAL(), "sqlite")
UNDERIVED = sa.text("whole IS NULL AND refusal IS NULL")
APPEND_ONLY = ("edit", "status_change")


def upgrade() -> None:
    """Makes the tables, and on SQLite the triggers that keep the journal append-only."""
    _names()
    _images()
    _predictions()
    _annotations()
    _comparisons()
    if op.get_bind().dialect.name == "sqlite":
        for table in APPEND_ONLY:
            _refuse_changes(table)


def _refuse_changes(table: str) -> None:
    for change in ("UPDATE", "DELETE"):
        op.execute(
            f"CREATE TRIGGER {table}_refuses_{change.lower()} BEFORE {change} ON {table} "
            f"BEGIN SELECT RAISE(ABORT, 'the journal is append-only'); END"
        )


def _names() -> None:
    op.create_table(
        "project",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_project")),
        sqlite_strict=True,
    )
    op.create_table(
        "category",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("extra", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_category")),
        sa.UniqueConstraint("name", name=op.f("uq_category_name")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_table(
        "run",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.Column("weights", sa.Text()),
        sa.Column("settings", sa.Text(), nullable=False),
        sa.Column("key", sa.Text()),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_run")),
        sa.UniqueConstraint("key", name=op.f("uq_run_key")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )


def _images() -> None:
    op.create_table(
        "image",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("file_name", sa.Text(), nullable=False),
        sa.Column("sort_name", sa.Text(), nullable=False),
        sa.Column("path", sa.Text(), nullable=False),
        sa.Column("width", sa.Integer(), nullable=False),
        sa.Column("height", sa.Integer(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("light", sa.Text()),
        sa.Column("form", sa.Text()),
        sa.Column("split", sa.Text()),
        sa.Column("status", sa.Text(), nullable=False),
        sa.Column("extra", sa.Text(), nullable=False),
        sa.Column("added_at", sa.Text(), nullable=False),
        sa.Column("caps", sa.Integer(), server_default="0", nullable=False),
        sa.Column("ignored", sa.Integer(), server_default="0", nullable=False),
        sa.Column("run", sa.Integer()),
        sa.Column("predicted", sa.Integer(), server_default="0", nullable=False),
        sa.Column("version", sa.Integer(), server_default="0", nullable=False),
        sa.ForeignKeyConstraint(["run"], ["run.id"], name=op.f("fk_image_run")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_image")),
        sa.UniqueConstraint("file_name", name=op.f("uq_image_file_name")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(op.f("ix_image_sha256"), "image", ["sha256"], unique=False)
    op.create_index(op.f("ix_image_sort_name"), "image", ["sort_name"], unique=False)
    op.create_table(
        "status_change",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("before", sa.Text(), nullable=False),
        sa.Column("after", sa.Text(), nullable=False),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_status_change_image")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_status_change")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(op.f("ix_status_change_image"), "status_change", ["image"], unique=False)


def _predictions() -> None:
    op.create_table(
        "prediction",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("run", sa.Integer(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("uid", sa.Text(), nullable=False),
        sa.Column("category", sa.Integer(), nullable=False),
        sa.Column("visible", sa.Text(), nullable=False),
        sa.Column("score", REAL, nullable=False),
        sa.Column("whole", sa.Text()),
        sa.Column("centre_x", REAL),
        sa.Column("centre_y", REAL),
        sa.Column("refusal", sa.Text()),
        sa.Column("extra", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["category"], ["category.id"], name=op.f("fk_prediction_category")),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_prediction_image")),
        sa.ForeignKeyConstraint(["run"], ["run.id"], name=op.f("fk_prediction_run")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_prediction")),
        sa.UniqueConstraint("image", "run", "uid", name=op.f("uq_prediction_image_run_uid")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(
        "ix_prediction_underived",
        "prediction",
        ["image"],
        unique=False,
        sqlite_where=UNDERIVED,
        postgresql_where=UNDERIVED,
    )


def _annotations() -> None:
    op.create_table(
        "annotation",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("uid", sa.Text(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("deleted", sa.Integer(), nullable=False),
        sa.Column("visible", sa.Text(), nullable=False),
        sa.Column("mark", sa.Text()),
        sa.Column("ignored", sa.Integer(), nullable=False),
        sa.Column("doubtful", sa.Integer(), nullable=False),
        sa.Column("overlap", sa.Integer()),
        sa.Column("category", sa.Integer(), nullable=False),
        sa.Column("prediction", sa.Integer()),
        sa.Column("whole", sa.Text()),
        sa.Column("centre_x", REAL),
        sa.Column("centre_y", REAL),
        sa.Column("refusal", sa.Text()),
        sa.Column("extra", sa.Text(), nullable=False),
        sa.Column("edited_by", sa.Text(), nullable=False),
        sa.Column("edited_at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["category"], ["category.id"], name=op.f("fk_annotation_category")),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_annotation_image")),
        sa.ForeignKeyConstraint(["prediction"], ["prediction.id"], name=op.f("fk_annotation_prediction")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_annotation")),
        sa.UniqueConstraint("uid", name=op.f("uq_annotation_uid")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )
    op.create_index(
        op.f("ix_annotation_image_deleted_ignored"),
        "annotation",
        ["image", "deleted", "ignored"],
        unique=False,
    )
    op.create_index(op.f("ix_annotation_prediction"), "annotation", ["prediction"], unique=False)
    op.create_index(
        "ix_annotation_underived",
        "annotation",
        ["image"],
        unique=False,
        sqlite_where=UNDERIVED,
        postgresql_where=UNDERIVED,
    )
    op.create_table(
        "edit",
        sa.Column("sequence", sa.Integer(), nullable=False),
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("digest", sa.Text(), nullable=False),
        sa.Column("annotation", sa.Text(), nullable=False),
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("base", sa.Integer(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("before", sa.Text()),
        sa.Column("after", sa.Text()),
        sa.Column("user", sa.Text(), nullable=False),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["annotation"], ["annotation.uid"], name=op.f("fk_edit_annotation")),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_edit_image")),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_edit")),
        sa.UniqueConstraint("annotation", "revision", name=op.f("uq_edit_annotation_revision")),
        sa.UniqueConstraint("id", name=op.f("uq_edit_id")),
        sqlite_autoincrement=True,
        sqlite_strict=True,
    )


def _comparisons() -> None:
    op.create_table(
        "comparison",
        sa.Column("image", sa.Integer(), nullable=False),
        sa.Column("run", sa.Integer(), nullable=False),
        sa.Column("version", sa.Integer(), nullable=False),
        sa.Column("caps", sa.Integer(), nullable=False),
        sa.Column("marked", sa.Integer(), nullable=False),
        sa.Column("matched", sa.Integer(), nullable=False),
        sa.Column("missed", sa.Integer(), nullable=False),
        sa.Column("extra", sa.Integer(), nullable=False),
        sa.Column("cdr_mean", REAL),
        sa.Column("cdr_worst", REAL),
        sa.Column("worst", sa.Text()),
        sa.Column("px_mean", REAL),
        sa.Column("relative_mean", REAL),
        sa.Column("dx", REAL),
        sa.Column("dy", REAL),
        sa.Column("made_at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["image"], ["image.id"], name=op.f("fk_comparison_image")),
        sa.ForeignKeyConstraint(["run"], ["run.id"], name=op.f("fk_comparison_run")),
        sa.PrimaryKeyConstraint("image", "run", name=op.f("pk_comparison")),
        sqlite_strict=True,
    )
