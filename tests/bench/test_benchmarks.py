"""The benchmarks run, and say something; how fast the machine is, is not judged here."""

from __future__ import annotations

import json
import math
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from fairyring.app.bench.browser.editor import editor_rows
from fairyring.app.bench.browser.page import page_rows
from fairyring.app.bench.browser.review import review_rows
from fairyring.app.bench.evaluation import evaluation_rows
from fairyring.app.bench.fits import fit_rows
from fairyring.app.bench.store import store_rows
from fairyring.app.bench.timing import Row, p95_row, row
from fairyring.app.commands.benchmarks import commands
from fairyring.model.contour.methods import METHODS

HEAVY = {"numpy", "cv2", "sqlalchemy", "viser", "starlette", "torch", "plotly", "rich", "playwright"}


@pytest.mark.parametrize(
    ("measured", "targets"),
    [
        (store_rows, {"import": 5000, "a page of the list": 100, "open an image": 50, "server memory": 500}),
        (
            editor_rows,
            {
                "edit: release": 50,
                "accept all 449: key to on disk": 1500,
                "next image, 1280 × 720": 100,
                "any image, 4000 × 3000": 400,
            },
        ),
        (
            evaluation_rows,
            {
                "evaluate centres, 1200 caps against as many: memory": 800,
                "evaluate masks, 1200 caps against as many: memory": 800,
            },
        ),
        (page_rows, {"fairyring serve: typed to answering": 4}),
    ],
)
def test_a_quick_run_gives_every_figure_beside_its_target(measured, targets):
    rows = measured(quick=True)

    assert all(math.isfinite(row["value"]) and row["value"] > 0 for row in rows)
    assert all(row["ratio"] > 0 for row in rows if row["reference"] is not None)
    for figure, target in targets.items():
        assert _named(rows, figure)["target"] == target


def test_every_way_to_a_whole_outline_gives_the_same():
    rows = fit_rows(quick=True)

    assert _named(rows, "crowd.jpg, 60 caps: all accepted")["target"] == 1500
    apart = [row for row in rows if row["unit"] == "px"]
    assert [(row["value"], row["target"]) for row in apart] == [(0.0, 0.01)] * 3


# It drives the page, as tests/browser does (docs/decisions/0030).
@pytest.mark.flaky(reruns=1)
def test_a_bed_is_corrected_completely_and_the_inputs_are_counted():
    rows = review_rows(quick=True)

    assert _named(rows, "8 caps: S75")["value"] == 1.0
    assert _named(rows, "8 caps: AP")["value"] >= _named(rows, "8 caps: AP")["reference"]
    counted = [
        _named(rows, f"8 caps: {kind}")["value"] for kind in ("pressed", "clicks", "strokes", "inputs")
    ]
    assert sum(counted[:3]) == counted[3] > 0
    assert 0 < _named(rows, "8 caps: a person")["value"] < _named(rows, "8 caps: with a decision")["value"]


def test_the_95th_percentile_stands_beside_that_of_the_reference():
    found = p95_row("work", [float(i) for i in range(101)], target=50, reference=[10.0] * 5)

    assert (found["value"], found["reference"], found["ratio"]) == (95.0, 10.0, 9.5)


def test_a_figure_without_a_reference_has_no_ratio():
    assert row("memory", 120.0, unit="MB", target=500)["ratio"] is None


def test_help_imports_nothing_heavy():
    script = (
        "import sys; sys.argv = ['fairyring', '--help']\n"
        "from fairyring.app.cli import main\n"
        "try: main()\n"
        "except SystemExit: sys.stderr.write(' '.join({name.split('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)

    assert "Usage" in done.stdout
    assert HEAVY & set(done.stderr.split()) == set()


@pytest.mark.parametrize("name", ["desk", "editor", "page", "review", "store"])
def test_without_playwright_a_benchmark_in_a_browser_says_what_to_type(name):
    script = (
        f"import sys; sys.argv = ['fairyring', 'bench', '{name}']; sys.modules['playwright'] = None\n"
        "from fairyring.app.cli import main; main()"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)

    assert done.returncode == 1
    assert done.stderr.splitlines() == [
        "fairyring: This is measured in a browser, which playwright drives: pip install 'fairyring[bench]'"
    ]


def test_the_contour_benchmark_can_be_called_by_name():
    done = CliRunner().invoke(commands, ["contour", "--quick", "--json"])

    assert done.exit_code == 0
    assert {row["method"] for row in json.loads(done.stdout)} == set(METHODS)


def _named(rows: list[Row], figure: str) -> Row:
    return next(found for found in rows if found["figure"].startswith(figure))
