"""The command rules: how people work in a project, said and set."""

import json

from tests.support.terminal import fairyring


def test_rules_are_said_and_set(tmp_path):
    beds = tmp_path / "beds"
    fairyring("init", beds)
    assert "not allowed" in fairyring("rules", beds).stdout
    assert json.loads(fairyring("rules", beds, "--approve-own", "--json").stdout) == {"approve_own": True}
    assert "own work: allowed" in fairyring("rules", beds).stdout
    fairyring("rules", beds, "--no-approve-own")
    assert json.loads(fairyring("rules", beds, "--json").stdout) == {"approve_own": False}
