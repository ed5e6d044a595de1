"""Figures of caps and images, worked out by hand on two round caps in a photo of 160 × 120."""

from __future__ import annotations

import asyncio
import math
from dataclasses import replace

import pytest

from fairyring.app.caps.comparison import Reviewer, compare_cap, compare_image
from fairyring.app.caps.filling_in import fill_in
from fairyring.app.caps.image_caps import caps_of
from fairyring.app.jobs.comparing import compare_work
from fairyring.app.jobs.runner import CancelledError
from fairyring.app.protocol import Show
from fairyring.model.geometry.shapes import Circle
from fairyring.model.progress import silent
from fairyring.storage.compared_caps import count_caps, list_caps
from fairyring.storage.comparisons import list_comparisons, stale_images
from fairyring.storage.contents import load_contents, load_predictions
from fairyring.storage.predictions import latest_run
from fairyring.storage.project import Project
from tests.support.stored import stored_comparison
from tests.support.tab import Tab, new_cap, until
from tests.support.two_marked import mark_both


def test_an_image_is_compared_as_equation_10_says(project: Project) -> None:
    mark_both(project)
    figures = compare_image(project, 1)
    assert figures is not None
    assert (figures.caps, figures.marked, figures.matched, figures.missed, figures.extra) == (3, 2, 2, 1, 0)
    assert figures.cdr_worst == pytest.approx(100 * (1.6 / 160 + 0.6 / 120))
    assert figures.cdr_mean == pytest.approx(figures.cdr_worst / 2)
    assert figures.worst == "left"
    # Marked by circles of 20 px, whose centres are off by .04 of that.
    assert figures.floor_mean == pytest.approx(100 * math.sqrt(2 / math.pi) * 0.8 * (1 / 160 + 1 / 120))
    assert figures.px_mean == pytest.approx((1.6**2 + 0.6**2) ** 0.5 / 2)
    assert figures.relative_mean == pytest.approx(figures.px_mean / 40)
    assert (figures.dx, figures.dy) == (pytest.approx(0.8), pytest.approx(-0.3))


def test_a_cap_is_compared_among_its_neighbours_with_the_same_result(project: Project) -> None:
    mark_both(project)
    with project.read() as connection:
        caps = replace(caps_of(load_contents(connection, 1)), predictions=load_predictions(connection, 1))
    pair = compare_cap(caps, "left")
    assert pair is not None
    assert pair.error is not None
    assert pair.error.cdr == pytest.approx(1.5)
    assert compare_cap(caps, "far") is None


def test_an_image_no_run_has_seen_is_not_compared(project: Project) -> None:
    assert compare_image(project, 2) is None


def test_the_job_compares_what_is_stale_and_can_be_cancelled(project: Project) -> None:
    mark_both(project)

    def cancel(*_: object) -> None:
        raise CancelledError

    with pytest.raises(CancelledError):
        compare_work(project)(cancel)
    assert compare_work(project)(silent).message == "1 image compared."
    assert compare_work(project)(silent).message == "Every image was up to date."


def test_after_edits_an_image_is_compared_once_in_the_background(project: Project) -> None:
    mark_both(project)

    async def edit_thrice() -> list[int]:
        compared: list[int] = []
        reviewer = Reviewer(project, compared=compared.append, quiet_s=0.05)
        for _ in range(3):
            reviewer.touch(1)
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.5)
        await reviewer.close()
        return compared

    assert asyncio.run(edit_thrice()) == [1]
    with project.read() as connection:
        assert stale_images(connection, 1) == []


def test_an_edit_in_a_tab_brings_the_review_up_to_date(port: int, project: Project) -> None:
    fill_in(project)
    with Tab(port, image=1) as tab:
        left = tab.expect(Show).contents.predictions[0]
        tab.edit(new_cap(1, visible=left.visible, mark=Circle(left.centre[0] + 3.2, left.centre[1], 20)))
        until(lambda: ">2.00<" in tab.panel.html, "the worst cap")
        until(lambda: 'data-fairyring-select="cap-1"' in tab.panel.html, "its row of the review")
    with project.read() as connection:
        assert stored_comparison(connection, 1, 1).dx == pytest.approx(-3.2)
        assert list_comparisons(connection, 1).total == 1


def test_every_cap_of_a_comparison_can_be_listed_the_worst_first(project: Project) -> None:
    mark_both(project)
    compare_image(project, 1)
    with project.read() as connection:
        run = latest_run(connection)
        assert run is not None
        worst = list_caps(connection, run.id, "worst")
        missed = list_caps(connection, run.id, "missed")
        counts = count_caps(connection, run.id)
    assert [each.annotation for each in worst] == ["left", "right"]
    assert worst[0].cdr == pytest.approx(100 * (1.6 / 160 + 0.6 / 120))
    assert [(each.annotation, each.prediction) for each in missed] == [("far", None)]
    assert {kind: count for kind, count in counts.items() if count} == {"worst": 2, "matched": 2, "missed": 1}


def test_comparing_again_puts_the_caps_in_place_of_the_older_ones(project: Project) -> None:
    mark_both(project)
    compare_image(project, 1)
    compare_image(project, 1)
    with project.read() as connection:
        run = latest_run(connection)
        assert run is not None
        assert count_caps(connection, run.id)["worst"] == 2
