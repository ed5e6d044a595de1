"""What the panel says where there is nothing to correct yet."""

from __future__ import annotations

from shlex import quote

from fairyring.app.panels.markup import Markup, element
from fairyring.storage.project import Project
from fairyring.storage.records import Image


def first_steps(project: Project) -> Markup:
    """Of a project without images: how photos come in."""
    return element(
        "section",
        element("strong", "No photos yet"),
        element("p", "Drop photos anywhere on this page, or"),
        element(
            "button", "Choose photos…", type="button", class_="fr-primary", data_fairyring_upload="choose"
        ),
        element("p", "In a terminal the same, also with labels:"),
        element("code", f"fairyring import {quote(str(project.folder))} PHOTOS…"),
        class_="fr-cap fr-first",
    )


def offer_prediction(image: Image) -> Markup:
    """Of an image with nothing on it: the network can have a first look."""
    return element(
        "button",
        "Predict this image",
        type="button",
        class_="fr-primary",
        data_fairyring_predict=image.id,
    )
