"""Floors follow from second marks, also those of what was compared before."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from fairyring.app.caps.comparison import compare_image
from fairyring.app.caps.repeated import repeated_marks, use_repeats
from fairyring.app.review.figures import figures_of, review_of
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.compared_caps import list_caps
from fairyring.storage.comparisons import list_comparisons
from fairyring.storage.contents import load_annotations
from fairyring.storage.predictions import latest_run
from fairyring.storage.project import Project, open_project
from fairyring.storage.records import Repeat
from fairyring.storage.repeats import store_repeat
from tests.support.annotated_beds import make_annotated_beds
from tests.support.plain_bed import SIZE

SD = 2.0
ROOT_TWO = math.sqrt(2)


def mark_again(project: Project, images: int) -> None:
    """Ada marks all her caps again; of two marks with noise of ``SD`` px the difference has √2 times that."""
    noise = np.random.default_rng(5).normal(0, SD * ROOT_TWO, (images, 5, 2))
    for image in range(1, images + 1):
        with project.read() as connection:
            caps = load_annotations(connection, image)
        for number, cap in enumerate(caps):
            first = cap.cap.mark
            assert isinstance(first, Circle)
            dx, dy = noise[image - 1, number].tolist()
            made = Repeat(
                id=f"again-{cap.uid}",
                annotation=cap.uid,
                image=image,
                user="Ada",
                mirrored=False,
                first=first,
                second=Circle(first.cx + dx, first.cy + dy, first.r),
                size="m",
                visibility="95_percent_and_more",
            )
            project.write(lambda connection, made=made: store_repeat(connection, made))


def test_floors_are_those_of_the_noise_that_was_put_in_once_there_are_enough_repeats(tmp_path: Path) -> None:
    put_in = 100 * math.sqrt(2 / math.pi) * SD * (1 / SIZE[0] + 1 / SIZE[1])
    with open_project(make_annotated_beds(tmp_path, count=12)) as project:
        for image in range(1, 13):
            compare_image(project, image)
        of_geometry = figures_of(review_of(project))["floor"]["cdr_mean"]
        assert of_geometry == pytest.approx(put_in / SD)  # a click is off by a pixel
        mark_again(project, 12)
        project.write(lambda connection: use_repeats(connection, "Ada"))
        figures = figures_of(review_of(project))
        with project.read() as connection:
            run = latest_run(connection)
            assert run is not None
            kept = [cap.floor for cap in list_caps(connection, run.id, "worst", limit=99)]
            of_images = [row.comparison.floor_mean for row in list_comparisons(connection, run.id).rows]
            assert len(repeated_marks(connection)) == 60
    assert figures["floor"]["cdr_mean"] == pytest.approx(put_in, rel=0.15)
    again = figures["marked_again"]
    assert again["all"]["low"] < put_in < again["all"]["high"]
    assert again["by"]["annotator"]["Ada"]["count"] == 60
    assert kept == pytest.approx([figures["floor"]["cdr_mean"]] * len(kept))
    assert of_images == pytest.approx([figures["floor"]["cdr_mean"]] * 12)
