"""Writes what the store holds as COCO. ``model.coco`` lists the keys that are ours."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.metadata import version
from typing import Any, BinaryIO

import msgspec
from msgspec import Raw

from fairyring.model.coco.annotations import TOLD_ARCS
from fairyring.model.coco.writing import MARKED, RECONSTRUCTED, centre_keys, rounded
from fairyring.model.geometry.shapes import Circle, Ellipse
from fairyring.storage.formats.coco_geometry import Drawn
from fairyring.storage.formats.foreign_keys import without_geometry
from fairyring.storage.provenance import Standing
from fairyring.storage.records import IMPORT, Annotation, GivenVerdict, Image, Prediction

VERDICTS = "verdicts"
KEYPOINTS = ["centre"]
WRITTEN_BY = f"Fairyring {version('fairyring')}"
NOT_SAID: dict[str, Any] = {}


def drawn(cap: Annotation | Prediction, *, visible_json: Raw | None = None) -> Drawn:
    """Where a cap is; ``visible_json`` is its outline as text, where somebody has it."""
    if isinstance(cap, Prediction):
        return Drawn(visible=cap.visible, visible_json=visible_json, whole=cap.whole)
    said = cap.cap
    whole = said.mark if isinstance(said.mark, Circle | Ellipse) else cap.whole
    text = visible_json if said.visible else None
    return Drawn(visible=said.visible, visible_json=text, mark=said.mark, whole=whole)


def annotation_entry(
    annotation: Annotation,
    geometry: dict[str, Any],
    *,
    number: int,
    category: int,
    origin: dict[str, Any] = NOT_SAID,
    verdicts: Sequence[GivenVerdict] = (),
) -> dict[str, Any]:
    """The entry of an annotation.

    ``geometry`` are the keys that ``geometry_keys`` gives it, ``number`` and ``category`` are ids in the
    file, ``origin`` says who made it, and ``verdicts`` what reviewers said of it. What an imported file says
    of its origin stands until the cap is edited.
    """
    cap = annotation.cap
    marked, centre = cap.mark is not None, annotation.centre
    if isinstance(cap.mark, Circle | Ellipse):
        centre = cap.mark.cx, cap.mark.cy
    # As long as nobody has touched the cap since it was imported, what its file said of it still holds.
    untouched = annotation.revision == 1
    extra = annotation.extra if untouched else without_geometry(annotation.extra) | origin
    entry: dict[str, Any] = {"id": number, **origin, **extra, **geometry}
    entry["image_id"] = annotation.image
    entry["category_id"] = category
    entry["iscrowd"] = int(cap.ignored)
    entry["marked"] = marked
    entry |= centre_keys(centre, visibility=MARKED if marked else RECONSTRUCTED)
    if annotation.centre_sd is not None:
        entry["mark_sd" if marked else "center_sd"] = rounded(annotation.centre_sd)
    if cap.doubtful:
        entry["doubt"] = True
    if cap.ignored:
        entry["ignored"] = True
    if cap.order is not None:
        entry["order"] = cap.order
    if cap.told:
        entry[TOLD_ARCS] = msgspec.to_builtins(cap.told)
    if "amodal_segmentation" in extra:
        entry["amodal_segmentation"] = extra["amodal_segmentation"]
    if verdicts or VERDICTS in extra:
        entry |= verdict_keys(verdicts, extra)
    entry["uid"] = annotation.uid
    return entry


def prediction_entry(
    prediction: Prediction, geometry: dict[str, Any], *, number: int, category: int
) -> dict[str, Any]:
    """The entry of a prediction, with its score and quality; the rest as for ``annotation_entry``."""
    entry = geometry | {"image_id": prediction.image, "category_id": category, "iscrowd": 0}
    entry |= {"score": prediction.score}
    entry |= {} if prediction.quality is None else {"quality": prediction.quality}
    entry |= centre_keys(prediction.centre, visibility=RECONSTRUCTED) | {"marked": False}
    return {"id": number} | prediction.extra | entry


def image_entry(
    image: Image,
    *,
    sha256: str,
    partial: bool,
    licenses: list[dict[str, Any]],
    verdicts: Sequence[GivenVerdict] = (),
) -> dict[str, Any]:
    """The entry of an image; its licence is added to ``licenses`` and named by number.

    ``sha256`` is that of its file in the export. ``partial``: nobody has said that the annotations are all
    its caps. ``verdicts``: what reviewers said of it.
    """
    entry: dict[str, Any] = {"id": image.id, "file_name": image.file_name}
    entry |= {"width": image.width, "height": image.height, "status": image.status}
    entry |= {"sha256": sha256}
    entry |= {"partial": True} if partial else {}
    known = {"light": image.light, "form": image.form, "split": image.split}
    extra = dict(image.extra)
    license_ = extra.pop("license", None)
    if isinstance(license_, dict):
        extra["license"] = _number_of_license(license_, licenses)
    entry |= verdict_keys(verdicts, extra)
    return extra | entry | {key: value for key, value in known.items() if value is not None}


def verdict_keys(verdicts: Sequence[GivenVerdict], extra: dict[str, Any]) -> dict[str, Any]:
    """``verdicts``: what reviewers said of an image or a cap, after what an imported file has them say."""
    imported = extra.get(VERDICTS)
    said = [*imported] if isinstance(imported, list) else []
    decided = [
        entry.get("says") for entry in said if isinstance(entry, dict) and entry.get("says") != "comment"
    ]
    for each in verdicts:
        if each.user == IMPORT and each.says == "approved" and decided[-1:] == ["approved"]:
            # The import only took over an approval, whose giver stands in the file.
            continue
        of_cap = {} if each.revision is None else {"revision": each.revision}
        entry = {"says": each.says, "words": each.words} | of_cap | {"by": each.user, "at": each.made_at}
        # An export that comes back says what the project itself says.
        said += [] if entry in said else [entry]
    return {VERDICTS: said} if said else {}


def info_entry(
    name: str, standing: Standing, licenses: list[dict[str, Any]], *, license_: str | None
) -> dict[str, Any]:
    """COCO's ``info``: the same for every export of a project as it stands.

    ``version`` counts the edits, and the date is that of the last change. Where nobody says which licence the
    data have, it is that of their photos.
    """
    named = [license_] if license_ else sorted({str(each["name"]) for each in licenses if each.get("name")})
    info: dict[str, Any] = {"description": name, "version": str(standing.edits)}
    info |= {"contributor": ", ".join(standing.people), "contributors": standing.people}
    if standing.changed_at is not None:
        info |= {"date_created": standing.changed_at, "year": int(standing.changed_at[:4])}
    info |= {"license": ", ".join(named)} if named else {}
    return info | {"written_by": WRITTEN_BY}


def category_entry(name: str, extra: dict[str, Any], *, number: int) -> dict[str, Any]:
    """The entry of a category; its one keypoint is the centre."""
    return extra | {"id": number, "name": name, "keypoints": KEYPOINTS, "skeleton": []}


def write_document(file: BinaryIO, head: dict[str, Any], lines: Iterable[tuple[int, bytes]]) -> int:
    """Writes ``head`` and then the annotations one a line, so that half a million need no memory.

    ``lines`` are some of these at a time: how many, and their text. Returns how many there were.
    """
    written = 0
    file.write(msgspec.json.encode(head)[:-1] + b',\n"annotations": [')
    for count, text in lines:
        if count:
            file.write((b",\n" if written else b"\n") + text)
            written += count
    file.write(b"\n]}\n")
    return written


def _number_of_license(license_: dict[str, Any], licenses: list[dict[str, Any]]) -> int:
    plain = {key: value for key, value in license_.items() if key != "id"}
    for known in licenses:
        if known == plain | {"id": known["id"]}:
            return known["id"]
    licenses.append(plain | {"id": len(licenses) + 1})
    return len(licenses)
