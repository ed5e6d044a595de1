"""Reads COCO: instances with polygons in one or several parts, RLE of both kinds, crowds, and our own keys.

Our own keys, beside COCO's:

``center`` [x, y], ``circle`` [cx, cy, r], ``ellipse`` [cx, cy, a, b, theta_deg]
    A person's mark, unless ``marked`` is false, or the annotation carries a ``score`` or a ``center_sd``:
    then a machine worked them out.
``mark``
    The polygon [x0, y0, …] a person marked; ``ellipse`` is then the one fitted to it.
``segmentation_of``
    ``"mark"`` where the visible outline is unknown and the polygons were drawn from the mark.
``amodal_segmentation``
    The whole outline as a polygon; one alone, without circle or ellipse, is taken as a marked polygon.
``doubt``, ``ignored``, ``ignore``, ``order``, ``uid``
    Flags, overlap order, and the annotation's own number.

Keys that are not known are kept, and written back by an export.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, TypeVar

from fairyring.model.geometry.mask_tracing import outline_of_rle
from fairyring.model.geometry.raster import check_rle
from fairyring.model.geometry.shapes import Circle, Ellipse, GeometryError, Polygon, canonical_ellipse
from fairyring.model.light_and_form import FORMS, LIGHTS
from fairyring.storage.cap_validity import MAX_NAME, MAX_ORDER
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import Found, FoundCap, FoundImage, Problem, UnusableError
from fairyring.storage.formats.values import base_name, flag, kept, number, numbers, read_json, size, text
from fairyring.storage.records import Cap, Mark, Outline, Shape

T = TypeVar("T")


IMAGE_KEYS = {"id", "file_name", "width", "height", "light", "form", "split", "license"}
CATEGORY_KEYS = {"id", "name", "keypoints", "skeleton"}
ANNOTATION_KEYS = {
    *("id", "image_id", "category_id", "segmentation", "bbox", "area", "iscrowd", "score", "uid"),
    *("ignore", "ignored", "doubt", "doubtful", "order", "center", "circle", "ellipse", "mark", "marked"),
    *("segmentation_of", "occlude_rate"),
}
DERIVED_KEYS = {"keypoints", "num_keypoints", "amodal_segmentation"}
"""Written by our export from what else it writes; where others wrote them they are kept."""


def parse_coco(data: bytes, *, file: str) -> Found:
    """All a COCO file says, image by image.

    Raises:
        StoreError: it is not a COCO file at all. What is wrong with single items is in ``problems``.
    """
    document = read_json(data, file=file)
    if isinstance(document, list):
        raise StoreError(f"{file} is a list of results without images; give a COCO file with images.")
    if not isinstance(document, dict) or not isinstance(document.get("images"), list):
        raise StoreError(f"{file} is not a COCO file: it has no list of images.")
    return _Reader(document, file).read()


def outline_of_segmentation(value: Any) -> tuple[Outline, tuple[int, int] | None]:
    """The outline as written, and the (height, width) of its RLE if it is one.

    Raises:
        UnusableError: it is neither polygons nor RLE.
    """
    if value is None or value == []:
        return [], None
    if isinstance(value, dict):
        try:
            rle = check_rle(value)
            return outline_of_rle(rle), (rle["size"][0], rle["size"][1])
        except GeometryError as error:
            raise UnusableError(str(error)) from error
    if not isinstance(value, list):
        raise UnusableError("The segmentation is neither a list of polygons nor an RLE.")
    return ([value] if not isinstance(value[0], list) else value), None


class _Reader:
    """Goes through one document and collects what cannot be taken."""

    def __init__(self, document: dict[str, Any], file: str) -> None:
        self.document = document
        self.file = file
        self.problems: list[Problem] = []
        self.names: set[str] = set()
        self.licenses = self._by_id("licenses")
        self.categories = {
            key: entry for key, entry in self._by_id("categories").items() if _category_name(entry)
        }

    def read(self) -> Found:
        images = self._images()
        caps = self._caps(set(images))
        return Found(
            file=self.file,
            images=[image_with(image, caps.get(key, [])) for key, image in images.items()],
            problems=self.problems,
            categories=self._unknown_keys_of_categories(),
        )

    def _unknown_keys_of_categories(self) -> dict[str, dict[str, Any]]:
        names = {_category_name(entry): entry for entry in self.categories.values()}
        return {
            name: self._try(f"category {name}", lambda entry=entry: _others(entry, CATEGORY_KEYS)) or {}
            for name, entry in names.items()
        }

    def _images(self) -> dict[Any, FoundImage]:
        images: dict[Any, FoundImage] = {}
        for index, entry in enumerate(self.document["images"]):
            where = _where("image", entry, index)
            image = self._try(where, lambda entry=entry, where=where: self._image(entry, where))
            if image is None:
                continue
            if entry["id"] in images:
                self._report(where, "Another image has this id; only the first is taken.")
                continue
            images[entry["id"]] = image
            self.names.add(image.file_name)
        return images

    def _image(self, entry: Any, where: str) -> FoundImage:
        _require_id(entry)
        name = base_name(entry.get("file_name"))
        if name in self.names:
            raise UnusableError(
                f"Another image of this file is called {name} too, in another folder; rename one."
            )
        extra = _others(entry, IMAGE_KEYS)
        if "license" in entry:
            extra |= kept({"license": self.licenses.get(_hashable(entry["license"]), entry["license"])})
        light, form = entry.get("light"), entry.get("form")
        for key, value, allowed in (("light", light, LIGHTS), ("form", form, FORMS)):
            if value is not None and value not in allowed:
                extra[key] = value
                self._report(where, f"The {key} is none of {', '.join(allowed)}; it was left out.")
        return FoundImage(
            where=where,
            file_name=name,
            width=size(entry.get("width"), "The width"),
            height=size(entry.get("height"), "The height"),
            light=light if light in LIGHTS else None,
            form=form if form in FORMS else None,
            split=text(entry.get("split")),
            extra=extra,
        )

    def _caps(self, known: set[Any]) -> dict[Any, list[FoundCap]]:
        entries = self.document.get("annotations", [])
        if not isinstance(entries, list):
            raise StoreError(f"{self.file} is not a COCO file: its annotations are not a list.")
        ids = Counter(_hashable(e.get("id")) for e in entries if isinstance(e, dict) and "id" in e)
        caps: dict[Any, list[FoundCap]] = {}
        lost = Counter(_image_id(entry) for entry in entries if _image_id(entry) not in known)
        for key, count in lost.items():
            self._report(
                f"image {key!s:.40}", f"It is missing or was left out, and {count} annotations with it."
            )
        for index, entry in enumerate(entries):
            if _image_id(entry) in lost:
                continue
            where = _where("annotation", entry, index)
            cap = self._try(where, lambda entry=entry, where=where: self._cap(entry, where))
            if cap is not None:
                caps.setdefault(entry["image_id"], []).append(cap)
        for key, count in ids.items():
            if count > 1:
                self._report(f"annotation {key}", f"{count} annotations have this id; all are taken.")
        return caps

    def _cap(self, entry: Any, where: str) -> FoundCap:
        category = self.categories.get(_hashable(entry.get("category_id")))
        if category is None:
            raise UnusableError(f"There is no category {entry.get('category_id')!r:.40}.")
        return _found_cap(entry, where, _category_name(category))

    def _by_id(self, name: str) -> dict[Any, dict[str, Any]]:
        entries = self.document.get(name, [])
        entries = entries if isinstance(entries, list) else []
        return {_hashable(e["id"]): e for e in reversed(entries) if isinstance(e, dict) and "id" in e}

    def _try(self, where: str, read: Callable[[], T]) -> T | None:
        try:
            return read()
        except UnusableError as error:
            self._report(where, str(error))
            return None

    def _report(self, where: str, reason: str) -> None:
        self.problems.append(Problem(self.file, where, reason))


def image_with(image: FoundImage, caps: list[FoundCap]) -> FoundImage:
    """The image with its caps."""
    image.caps.extend(caps)
    return image


def _found_cap(entry: dict[str, Any], where: str, category: str) -> FoundCap:
    visible, rle_size = outline_of_segmentation(entry.get("segmentation"))
    shape, centre = _shape(entry), _centre(entry)
    marked = _is_marked(entry)
    mark = _mark(entry, shape) if marked else None
    if entry.get("segmentation_of") == "mark" and mark is not None:
        visible = []
    score = None if entry.get("score") is None else number(entry["score"], "The score")
    order = entry.get("order")
    extra = _others(entry, ANNOTATION_KEYS | (DERIVED_KEYS if "marked" in entry else set()))
    if isinstance(mark, Polygon) and shape is None:
        extra.pop("amodal_segmentation", None)
    return FoundCap(
        where=where,
        cap=Cap(
            visible=visible,
            mark=mark,
            ignored=any(flag(entry.get(key), f"“{key}”") for key in ("iscrowd", "ignore", "ignored")),
            doubtful=any(flag(entry.get(key), f"“{key}”") for key in ("doubt", "doubtful")),
            order=order if type(order) is int and abs(order) <= MAX_ORDER else None,
            category=category,
        ),
        score=score,
        marked=marked,
        whole=shape,
        centre=centre,
        uid=entry["uid"] if isinstance(entry.get("uid"), str) else None,
        rle_size=rle_size,
        extra=extra,
    )


def _is_marked(entry: dict[str, Any]) -> bool:
    if "marked" in entry:
        return flag(entry["marked"], "“marked”")
    return "score" not in entry and "center_sd" not in entry


def _shape(entry: dict[str, Any]) -> Shape | None:
    if entry.get("circle") is not None:
        return Circle(*numbers(entry["circle"], "The circle", count=3))
    if entry.get("ellipse") is not None:
        cx, cy, a, b, theta = numbers(entry["ellipse"], "The ellipse", count=5)
        ellipse = Ellipse(cx, cy, a, b, theta)
        return ellipse if a >= b and 0 <= theta < 180 else canonical_ellipse(cx, cy, a, b, theta)
    return None


def _centre(entry: dict[str, Any]) -> tuple[float, float] | None:
    if entry.get("center") is None:
        return None
    x, y = numbers(entry["center"], "The center", count=2)
    return x, y


def _mark(entry: dict[str, Any], shape: Shape | None) -> Mark | None:
    if isinstance(entry.get("mark"), list):
        return Polygon(entry["mark"])
    if shape is not None:
        return shape
    whole = entry.get("amodal_segmentation")
    if isinstance(whole, list) and len(whole) == 1 and isinstance(whole[0], list):
        return Polygon(whole[0])
    return None


def _category_name(entry: dict[str, Any]) -> str:
    name = entry.get("name")
    return name if isinstance(name, str) and name.isprintable() and len(name) <= MAX_NAME else ""


def _require_id(entry: Any) -> None:
    if not isinstance(entry, dict):
        raise UnusableError("It is not an object.")
    if type(entry.get("id")) not in (int, str):
        raise UnusableError("The id is missing or neither a whole number nor text.")


def _image_id(entry: Any) -> Any:
    return _hashable(entry.get("image_id")) if isinstance(entry, dict) else None


def _hashable(value: Any) -> Any:
    return value if type(value) in (int, str) else None


def _others(entry: dict[str, Any], known: set[str]) -> dict[str, Any]:
    return kept({key: value for key, value in entry.items() if key not in known})


def _where(what: str, entry: Any, index: int) -> str:
    if isinstance(entry, dict) and type(entry.get("id")) in (int, str):
        return f"{what} {entry['id']!s:.40}"
    return f"{what} at place {index + 1}"
