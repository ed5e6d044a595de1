"""Prints the table of strangers' files in docs/results.md: ``python -m tests.strangers.table``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from tests.strangers.tried import ALL, Outcome, tried


def main() -> None:
    rows = ["| # | tool | file | images | caps | exit code | what is said |", "|---|---|---|---|---|---|---|"]
    for number, stranger in enumerate(ALL, start=1):
        with tempfile.TemporaryDirectory() as folder:
            rows.append(_row(number, stranger.tool, stranger.what, tried(stranger, Path(folder))))
    sys.stdout.write("\n".join([*rows, ""]))


def _row(number: int, tool: str, what: str, outcome: Outcome) -> str:
    said = " ".join(outcome.said) or "nothing"
    caps = f"{len(outcome.caps)} {outcome.kind}" if outcome.caps else "0"
    cells = [number, tool, what, outcome.photos, caps, outcome.exit_code, said]
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"


if __name__ == "__main__":
    main()
