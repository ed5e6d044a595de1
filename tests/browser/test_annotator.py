"""The scripted annotator of `fairyring bench review` puts every kind of fault right and counts its inputs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from fairyring.app.bench.browser.annotator import Annotator
from fairyring.app.bench.browser.tab import Tab
from fairyring.app.bench.serving import Server
from fairyring.model.geometry.likeness import overlaps
from tests.support.kept import kept_cap, live_caps
from tests.support.plain_bed import SIZE, make_bed, ring

RIGHT, DENTED, POOR, SMALL = (
    ring(120, 120, 40),
    ring(350, 200, 60),
    ring(560, 320, 50),
    ring(560, 60, 12),
)
"""Said as it is; said with a side missing, surely; the same, with little certainty; not said."""
FALSE, FALSE_AND_SURE = ring(120, 300, 30), ring(240, 60, 25)
SAID = {0.95: RIGHT, 0.9: ring(350, 200, 60, cut=360), 0.4: ring(560, 320, 50, cut=570)}
SAID |= {0.35: FALSE, 0.8: FALSE_AND_SURE}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    return make_bed(tmp_path, [list(SAID.values())], said=True, scores=list(SAID))


def test_false_caps_go_poor_ones_are_redrawn_and_missed_ones_are_drawn(
    server: Server, open_tab: Callable[..., Tab], project: Path
) -> None:
    tab = open_tab(server)
    annotator = Annotator(tab, [[rim] for rim in (RIGHT, DENTED, POOR, SMALL)])
    annotator.correct()
    kept = [kept_cap(project, uid) for uid in live_caps(project)]
    outlines = [cap["visible"] for cap in kept if cap is not None]
    truth = [[rim] for rim in (RIGHT, DENTED, POOR, SMALL)]
    likeness = overlaps(truth, outlines, width=SIZE[0], height=SIZE[1])
    assert len(outlines) == 4
    assert (
        min(max(likeness[rim, cap] for cap in range(4) if (rim, cap) in likeness) for rim in range(4)) > 0.9
    )
    done = annotator.hand.done
    # Two rims and a cap; what was drawn is longer on screen than the chords of what was missing.
    assert done.strokes == 3
    assert done.traced_px > 2 * 98 * tab.page.evaluate("() => window.fairyring.view.scale")
    # Accepting, two that were open, a false one, a rim, a missed one, done.
    assert done.decisions >= 7
    assert done.seconds == pytest.approx(
        1.1 * done.points
        + 0.2 * (done.clicks + done.strokes)
        + 0.28 * done.keys
        + done.traced_px / 80
        + 1.35 * done.decisions
    )
