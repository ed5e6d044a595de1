"""The command rules: how people work in a project, said and set."""

import json

from tests.support.terminal import fairyring


def test_rules_are_said_and_set(tmp_path):
    beds = tmp_path / "beds"
    fairyring("init", beds)
    assert "not allowed" in fairyring("rules", beds).stdout
    usual = {"approve_own": False, "repeat_share": 0.0, "repeat_seed": 1}
    own = fairyring("rules", beds, "--approve-own", "--json").stdout
    assert json.loads(own) == usual | {"approve_own": True}
    assert "own work: allowed" in fairyring("rules", beds).stdout
    fairyring("rules", beds, "--no-approve-own")
    assert json.loads(fairyring("rules", beds, "--json").stdout) == usual


def test_a_share_of_the_caps_is_asked_for_again(tmp_path):
    beds = tmp_path / "beds"
    fairyring("init", beds)
    assert "Marked again: none" in fairyring("rules", beds).stdout
    said = fairyring("rules", beds, "--repeat-share", "0.05", "--repeat-seed", "7").stdout
    assert "Marked again: 5 % of the marked caps (seed 7)" in said
    assert "not allowed" in said
    assert fairyring("rules", beds, "--repeat-share", "2").exit_code == 2
