"""What people choose among when they import and export. Light to import: the command line lists it."""

from __future__ import annotations

from enum import StrEnum


class ImportFormat(StrEnum):
    """What a path to import holds."""

    auto = "auto"
    images = "images"
    coco = "coco"
    labelme = "labelme"


class ImportAs(StrEnum):
    """What imported shapes become."""

    annotations = "annotations"
    predictions = "predictions"


class Said(StrEnum):
    """What people say of an image all of whose caps are labelled."""

    annotated = "annotated"
    approved = "approved"


class ExportFormat(StrEnum):
    """The formats an export can be written in."""

    coco = "coco"


class Only(StrEnum):
    """Which images an export holds."""

    annotated = "annotated"
    """Those with annotations, or whose status says that they are done."""
    approved = "approved"
    predicted = "predicted"
    """Those of the latest run, with its predictions."""
    all = "all"
    """Every image: with its annotations, else with its predictions."""
