"""The tables. What a person or a model said is kept as it was said; counters serve the image list.

``image.caps``, ``image.ignored``, ``image.run``, ``image.predicted`` and ``image.version`` repeat what
other tables hold, so that a list of 10 000 images needs no join over 500 000 caps; whoever changes
annotations or predictions keeps them right (``storage.db.counters``). What comparisons say of images stands
in ``comparison_schema``.
"""

from __future__ import annotations

from typing import Any

from sqlalchemy import Column, ForeignKey, Index, Integer, MetaData, Table, Text, UniqueConstraint, and_

from fairyring.model.geometry.ellipse_parameters import LikelyEllipse
from fairyring.model.geometry.told_arcs import ToldArc
from fairyring.storage.db.columns import Flag, Json, Real
from fairyring.storage.records import Cap, Mark, Outline, Rules, SamplingPlan, Shape

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
    }
)

STRICT: dict[str, Any] = {"sqlite_strict": True}
NEVER_REUSED: dict[str, Any] = {"sqlite_strict": True, "sqlite_autoincrement": True}


def underived(table: Table) -> Index:
    """Finds the few rows whose whole outline nobody has worked out yet, without a scan over all caps."""
    pending = and_(table.c.whole.is_(None), table.c.refusal.is_(None))
    return Index(f"ix_{table.name}_underived", table.c.image, sqlite_where=pending, postgresql_where=pending)


project = Table(
    "project",
    metadata,
    Column("id", Text, primary_key=True),
    Column("name", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("rules", Json(Rules)),
    **STRICT,
)

category = Table(
    "category",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", Text, nullable=False, unique=True),
    Column("extra", Json(dict[str, Any]), nullable=False),
    **NEVER_REUSED,
)

run = Table(
    "run",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("name", Text, nullable=False),
    Column("kind", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("weights", Text),
    Column("settings", Json(dict[str, Any]), nullable=False),
    Column("key", Text, unique=True),
    **NEVER_REUSED,
)

image = Table(
    "image",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("file_name", Text, nullable=False, unique=True),
    Column("sort_name", Text, nullable=False, index=True),
    Column("path", Text, nullable=False),
    Column("width", Integer, nullable=False),
    Column("height", Integer, nullable=False),
    Column("sha256", Text, nullable=False, index=True),
    Column("light", Text),
    Column("form", Text),
    Column("split", Text),
    Column("status", Text, nullable=False),
    Column("statistics", Json(dict[str, float])),
    Column("extra", Json(dict[str, Any]), nullable=False),
    Column("added_at", Text, nullable=False),
    Column("caps", Integer, nullable=False, server_default="0"),
    Column("ignored", Integer, nullable=False, server_default="0"),
    Column("run", Integer, ForeignKey("run.id")),
    Column("predicted", Integer, nullable=False, server_default="0"),
    Column("version", Integer, nullable=False, server_default="0"),
    **NEVER_REUSED,
)

prediction = Table(
    "prediction",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("run", Integer, ForeignKey("run.id"), nullable=False),
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("uid", Text, nullable=False),
    Column("category", Integer, ForeignKey("category.id"), nullable=False),
    Column("visible", Json(Outline), nullable=False),
    Column("score", Real, nullable=False),
    Column("quality", Real),
    Column("likely_whole", Json(LikelyEllipse)),
    Column("whole", Json(Shape)),
    Column("centre_x", Real),
    Column("centre_y", Real),
    Column("refusal", Text),
    Column("extra", Json(dict[str, Any]), nullable=False),
    UniqueConstraint("image", "run", "uid"),
    **NEVER_REUSED,
)
underived(prediction)

annotation = Table(
    "annotation",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("uid", Text, nullable=False, unique=True),
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("revision", Integer, nullable=False),
    Column("deleted", Flag, nullable=False),
    Column("visible", Json(Outline), nullable=False),
    Column("mark", Json(Mark)),
    Column("ignored", Flag, nullable=False),
    Column("doubtful", Flag, nullable=False),
    Column("overlap", Integer),
    Column("category", Integer, ForeignKey("category.id"), nullable=False),
    Column("prediction", Integer, ForeignKey("prediction.id")),
    Column("arcs", Json(list[ToldArc])),
    Column("whole", Json(Shape)),
    Column("centre_x", Real),
    Column("centre_y", Real),
    Column("sd_x", Real),
    Column("sd_y", Real),
    Column("refusal", Text),
    Column("extra", Json(dict[str, Any]), nullable=False),
    Column("edited_by", Text, nullable=False),
    Column("edited_at", Text, nullable=False),
    Index(None, "image", "deleted", "ignored"),
    Index(None, "prediction"),
    **NEVER_REUSED,
)
underived(annotation)

change_set = Table(
    "change_set",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("id", Text, nullable=False),
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("user", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("takes_back", Text),
    UniqueConstraint("image", "user", "id"),
    **NEVER_REUSED,
)

edit = Table(
    "edit",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("id", Text, nullable=False, unique=True),
    Column("digest", Text, nullable=False),
    Column("annotation", Text, ForeignKey("annotation.uid"), nullable=False),
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("base", Integer, nullable=False),
    Column("revision", Integer, nullable=False),
    Column("before", Json(Cap)),
    Column("after", Json(Cap)),
    Column("user", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("change_set", Integer, ForeignKey("change_set.sequence"), index=True),
    UniqueConstraint("annotation", "revision"),
    **NEVER_REUSED,
)

status_change = Table(
    "status_change",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("image", Integer, ForeignKey("image.id"), nullable=False, index=True),
    Column("before", Text, nullable=False),
    Column("after", Text, nullable=False),
    Column("user", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("id", Text),
    Column("digest", Text),
    Column("change_set", Integer, ForeignKey("change_set.sequence"), index=True),
    Index(None, "id", unique=True),
    **NEVER_REUSED,
)

verdict = Table(
    "verdict",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("id", Text, nullable=False, unique=True),
    Column("digest", Text, nullable=False),
    Column("image", Integer, ForeignKey("image.id"), nullable=False, index=True),
    Column("annotation", Text, ForeignKey("annotation.uid"), index=True),
    Column("revision", Integer),
    Column("says", Text, nullable=False),
    Column("words", Text, nullable=False),
    Column("user", Text, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("change_set", Integer, ForeignKey("change_set.sequence"), index=True),
    **NEVER_REUSED,
)

queue = Table(
    "queue",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("user", Text, nullable=False, index=True),
    Column("title", Text, nullable=False),
    Column("images", Json(list[int]), nullable=False),
    Column("plan", Json(SamplingPlan)),
    Column("after_verdict", Integer, nullable=False),
    Column("made_at", Text, nullable=False),
    Column("ended_at", Text),
    **NEVER_REUSED,
)

repeat = Table(
    "repeat",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("id", Text, nullable=False, unique=True),
    Column("annotation", Text, ForeignKey("annotation.uid"), nullable=False, index=True),
    Column("image", Integer, ForeignKey("image.id"), nullable=False, index=True),
    Column("user", Text, nullable=False),
    Column("mirrored", Flag, nullable=False),
    Column("first", Json(Mark), nullable=False),
    Column("second", Json(Mark), nullable=False),
    Column("size", Text),
    Column("visibility", Text),
    Column("made_at", Text, nullable=False),
    **NEVER_REUSED,
)
