"""What people choose among when they import and export. Light to import: the command line lists it."""

from __future__ import annotations

from enum import Enum, StrEnum


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
    second = "second"
    """What a second annotator labelled, kept beside the annotations."""


class Polygons(StrEnum):
    """What the polygons of labelme files are."""

    visible = "visible"
    """What the photo shows of a cap; its whole outline and centre are worked out."""
    marks = "marks"
    """The paper's procedure: marks of the whole cap as well, whose fitted ellipse has the centre."""


class KnownCaps(Enum):
    """What an import does about caps that the project has already."""

    tell = "tell"
    """Leaves them as they are, and says how many differ."""
    keep = "keep"
    """Leaves them as they are."""
    update = "update"
    """Takes what the files say otherwise, as edits."""
    replace = "replace"
    """The same, and deletes what the files lack."""


class Said(StrEnum):
    """What people say of an image all of whose caps are labelled."""

    annotated = "annotated"
    approved = "approved"


class ExportFormat(StrEnum):
    """The formats an export can be written in."""

    coco = "coco"


class ExportedPhotos(Enum):
    """What becomes of the photos of an export."""

    copied = "copied"
    linked = "linked"
    """Symbolic links to where they lie; one that is turned by EXIF is copied all the same."""
    none = "none"
    """Labels alone, also of photos that are gone."""


class Only(StrEnum):
    """Which images an export holds."""

    annotated = "annotated"
    """Those with annotations, or whose status says that they are done."""
    approved = "approved"
    predicted = "predicted"
    """Those that a run saw, each with what the latest of its runs said."""
    all = "all"
    """Every image: with its annotations, else with its predictions."""
