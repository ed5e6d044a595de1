"""The tables of what comparisons say: of an image, of its caps, and of these summed up by class.

All of it follows from annotations and predictions, and can be made anew at any time. ``compared_class`` sums
up ``compared_cap`` (``storage.compared_classes``), so that figures of groups need not read 60 000 caps.
"""

from __future__ import annotations

from sqlalchemy import Column, ForeignKey, Index, Integer, Table, Text

from fairyring.storage.db.columns import Flag, Real
from fairyring.storage.db.schema import NEVER_REUSED, STRICT, metadata

comparison = Table(
    "comparison",
    metadata,
    Column("image", Integer, ForeignKey("image.id"), primary_key=True),
    Column("run", Integer, ForeignKey("run.id"), primary_key=True),
    Column("version", Integer, nullable=False),
    Column("caps", Integer, nullable=False),
    Column("marked", Integer, nullable=False),
    Column("matched", Integer, nullable=False),
    Column("missed", Integer, nullable=False),
    Column("extra", Integer, nullable=False),
    Column("measured", Integer, nullable=False, server_default="0"),
    Column("doubtful", Integer, nullable=False, server_default="0"),
    Column("unsure", Integer, nullable=False, server_default="0"),
    Column("ignored", Integer, nullable=False, server_default="0"),
    Column("cdr_mean", Real),
    Column("iou_mean", Real),
    Column("floor_mean", Real),
    Column("cdr_worst", Real),
    Column("worst", Text),
    Column("px_mean", Real),
    Column("relative_mean", Real),
    Column("dx", Real),
    Column("dy", Real),
    Column("made_at", Text, nullable=False),
    **STRICT,
)

compared_cap = Table(
    "compared_cap",
    metadata,
    Column("sequence", Integer, primary_key=True),
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("run", Integer, ForeignKey("run.id"), nullable=False),
    Column("annotation", Text),
    Column("prediction", Integer),
    Column("iou", Real),
    Column("cdr", Real),
    Column("floor", Real),
    Column("doubtful", Flag, nullable=False),
    Column("unsure", Flag, nullable=False),
    Column("annotator", Text),
    Column("size", Text),
    Column("shape", Text),
    Column("visibility", Text),
    Column("own_floor", Real),
    Column("dx", Real),
    Column("dy", Real),
    Column("ignored", Flag, nullable=False, server_default="0"),
    Index(None, "run", "image"),
    **NEVER_REUSED,
)

compared_class = Table(
    "compared_class",
    metadata,
    Column("image", Integer, ForeignKey("image.id"), nullable=False),
    Column("run", Integer, ForeignKey("run.id"), nullable=False),
    Column("annotator", Text),
    Column("size", Text),
    Column("shape", Text),
    Column("visibility", Text),
    Column("doubtful", Flag, nullable=False),
    Column("unsure", Flag, nullable=False),
    Column("ignored", Flag, nullable=False),
    *(
        Column(name, Integer, nullable=False)
        for name in ("caps", "measured", "floors", "matched", "missed", "extra")
    ),
    *(Column(name, Real) for name in ("cdr", "floor", "dx", "dy", "cdr_worst")),
    Index(None, "run", "image"),
    **STRICT,
)
