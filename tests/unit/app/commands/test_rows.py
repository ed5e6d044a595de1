"""Tables of figures."""

from __future__ import annotations

import json

import pytest

from fairyring.app.commands.rows import print_rows

ROWS = [{f"figure_{nth}": f"value {nth} of some length" for nth in range(12)} | {"none": None}]


def test_a_table_that_goes_into_a_file_is_as_wide_as_its_figures(capsys: pytest.CaptureFixture[str]) -> None:
    print_rows("figures", ROWS, as_json=False)
    printed = capsys.readouterr().out
    heads, values = (
        next(line for line in printed.splitlines() if word in line) for word in ("figure 0", "value 0")
    )
    assert all(f"figure {nth}" in heads and f"value {nth} of some length" in values for nth in range(12))
    assert "None" not in printed
    assert not any(line.endswith(" ") for line in printed.splitlines()[1:])


def test_as_json_the_rows_are_what_they_were(capsys: pytest.CaptureFixture[str]) -> None:
    print_rows("figures", ROWS, as_json=True)
    assert json.loads(capsys.readouterr().out) == ROWS
