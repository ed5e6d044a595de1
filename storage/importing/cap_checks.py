"""Checks the caps a file holds against the photo they belong to."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from hashlib import blake2b
from pathlib import PurePosixPath

import msgspec
from msgspec import structs

from fairyring.model.coco.visible import outline_in
from fairyring.model.errors import FairyringError
from fairyring.model.geometry.outline_checks import check_centre, check_mark
from fairyring.model.geometry.shapes import (
    Centre,
    Circle,
    Ellipse,
    area_of_outline,
    centre_of_shape,
    polygon_of_shape,
)
from fairyring.storage.cap_validity import check_cap
from fairyring.storage.errors import StoreError
from fairyring.storage.formats.found import FoundCap, Problem
from fairyring.storage.importing.photos import Photo
from fairyring.storage.records import Cap, Outline, Shape

SAME_CENTRE = 0.5
"""How far ``center`` may lie from the shape's centre without a remark, pixels (files are rounded)."""
OWN_NUMBER = re.compile(r"[A-Za-z0-9_-]{1,64}")


def check_caps(caps: Sequence[FoundCap], *, photo: Photo, file: str) -> tuple[list[FoundCap], list[Problem]]:
    """The caps that can be stored, each with a number of its own, and what is wrong with the others."""
    good: list[FoundCap] = []
    problems: list[Problem] = []
    by_uid: dict[str | None, FoundCap] = {}
    for cap in caps:
        try:
            checked, left_out = _checked(structs.replace(cap, file=file), photo)
        except FairyringError as error:
            problems.append(Problem(file, cap.where, str(error)))
            continue
        if by_uid.setdefault(checked.uid, checked).cap != checked.cap:
            # A tool has copied a cap with all its keys: it is another one.
            checked = structs.replace(checked, uid=content_number(checked.cap, photo=photo), id=None)
        first = by_uid.setdefault(checked.uid, checked)
        if first is not checked:
            problems.append(
                Problem(file, cap.where, f"It has the outline of {first.where}, which was taken.")
            )
            continue
        good.append(checked)
        problems += [Problem(file, cap.where, reason) for reason in left_out]
    return good, problems


def _checked(found: FoundCap, photo: Photo) -> tuple[FoundCap, list[str]]:
    remarks: list[str] = []
    whole, centre = _checked_shape(found.whole, photo), _checked_centre(found.centre, photo)
    cap = _with_outline(found, photo, whole, left_out=remarks.append)
    cap = check_cap(cap, width=photo.width, height=photo.height, left_out=remarks.append)
    if found.marked and cap.mark is None and centre is not None:
        cap = structs.replace(cap, mark=_mark_around(centre, cap.visible))
    mark = cap.mark
    if isinstance(mark, Circle | Ellipse):
        whole, centre = mark, (mark.cx, mark.cy)
        remarks += _remarks_on_centre(found, centre)
    elif whole is None:
        centre = None
    else:
        centre = centre or centre_of_shape(whole)
    own = found.uid if found.uid and OWN_NUMBER.fullmatch(found.uid) else None
    uid = own or content_number(cap, photo=photo)
    sd = None if whole is None else found.centre_sd
    checked = structs.replace(found, cap=cap, whole=whole, centre=centre, centre_sd=sd, uid=uid, rle=None)
    return checked, remarks


def _with_outline(
    found: FoundCap, photo: Photo, whole: Shape | None, *, left_out: Callable[[str], object]
) -> Cap:
    """The cap with its visible outline; where a file gives only a worked-out whole outline, with that one."""
    if found.rle is not None:
        outline = outline_in(found.rle, width=photo.width, height=photo.height, left_out=left_out)
        return structs.replace(found.cap, visible=outline)
    if found.cap.visible or found.cap.mark is not None or whole is None:
        return found.cap
    return structs.replace(found.cap, visible=[polygon_of_shape(whole)])


def _remarks_on_centre(found: FoundCap, centre: tuple[float, float]) -> list[str]:
    apart = math.dist(found.centre or centre, centre)
    if apart <= SAME_CENTRE:
        return []
    return [f"Its center lies {apart:.1f} px from that of its circle or ellipse, which was taken."]


def content_number(cap: Cap, *, photo: Photo) -> str:
    """A uid from a cap's content: the same outline and mark in the same photo always get the same one."""
    name = PurePosixPath(photo.file_name).name
    content = msgspec.json.encode((name, photo.sha256, cap.visible, cap.mark))
    return blake2b(content, digest_size=16).hexdigest()


def _checked_shape(shape: Shape | None, photo: Photo) -> Shape | None:
    if shape is not None:
        check_mark(shape, width=photo.width, height=photo.height)
    return shape


def _checked_centre(centre: Centre | None, photo: Photo) -> Centre | None:
    return centre and check_centre(centre, width=photo.width, height=photo.height)


def _mark_around(centre: tuple[float, float], visible: Outline) -> Circle:
    """The mark for a cap with a bare ``center``: the circle of the visible outline's area around it."""
    if not visible:
        raise StoreError("A center without an outline, circle or ellipse is no cap.")
    return Circle(*centre, math.sqrt(area_of_outline(visible) / math.pi))
