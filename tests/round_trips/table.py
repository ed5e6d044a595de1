"""Prints the table of round trips in docs/results.md: ``python -m tests.round_trips.table [PYTHON]``.

PYTHON is the interpreter of an environment in which the packages are installed; else it is this one.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from tests.round_trips.trip import PACKAGES, NotInstalledError, Trip, taken_through

HEAD = (
    "| through | version | image ids | category ids | annotation ids | least IoU "
    "| back in the project: same | changed | new | gone |"
)


def main() -> None:
    python = sys.argv[1] if len(sys.argv) > 1 else sys.executable
    rows = [HEAD, "|---" * HEAD.count(" | ") + "|---|"]
    for package, name in PACKAGES.items():
        with tempfile.TemporaryDirectory() as folder:
            try:
                rows.append(_row(name, taken_through(package, Path(folder), python=python)))
            except NotInstalledError:
                rows.append(f"| {name} | not installed" + " | " * 8 + "|")
    sys.stdout.write("\n".join([*rows, ""]))


def _row(name: str, trip: Trip) -> str:
    back = trip.back
    cells = [name, trip.version]
    cells += [f"{kept} of {total}" for kept, total in (trip.images, trip.categories, trip.annotations)]
    cells += [f"{trip.least_iou:.3f}"]
    cells += [str(count) for count in (back.known - back.changed, back.changed, back.annotations, back.gone)]
    return "| " + " | ".join(cells) + " |"


if __name__ == "__main__":
    main()
