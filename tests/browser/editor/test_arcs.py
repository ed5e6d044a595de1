"""What a fit says of itself, as it is drawn."""

from __future__ import annotations

DRAWN = """
  const canvas = new OffscreenCanvas(60, 40);
  const context = canvas.getContext('2d');
  context.lineCap = 'round';
  m[a.draw](context, {scale: 2, x: 10, y: 0}, a.fit);
  const {data} = context.getImageData(0, 0, 60, 40);
  const at = (x, y) => [...data.slice(4 * (60 * y + x), 4 * (60 * y + x) + 4)];
  return a.where.map(([x, y]) => at(x, y));
"""


def test_an_arc_is_drawn_where_it_lies_in_the_colour_of_its_kind(call) -> None:
    arcs = [
        {"kind": "visible", "points": [0, 5, 20, 5]},
        {"kind": "border", "points": [10, 15]},
    ]
    where = [(30, 10), (30, 30), (30, 20)]
    painted = call("render/arcs", DRAWN, {"draw": "drawArcs", "fit": {"arcs": arcs}, "where": where})
    assert painted == [[0x45, 0xC8, 0xFF, 255], [255, 255, 255, 255], [0, 0, 0, 0]]


def test_the_uncertainty_is_an_ellipse_of_one_standard_deviation_that_never_vanishes(call) -> None:
    where = [(30 + 16, 20), (30, 20 + 6), (30 + 2, 20), (30, 20)]
    wide = {"fit": {"centre": [10, 10], "centre_sd": [8, 3]}}
    tiny = {"fit": {"centre": [10, 10], "centre_sd": [0.01, 0.01]}}
    seen = [
        [
            pixel[3] > 100
            for pixel in call("render/arcs", DRAWN, {"draw": "drawUncertainty", "fit": fit, "where": where})
        ]
        for fit in (wide, tiny)
    ]
    assert seen[0] == [True, True, False, False]
    assert seen[1][:3] == [False, False, True]
