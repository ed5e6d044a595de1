"""What holds for all tests."""

import os
from typing import Any

import pytest
from hypothesis import settings
from xdist.scheduler import LoadScopeScheduling

# As the command does: servers, browsers and networks of tests share the cores. Read when PyTorch is imported.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")

# How long an example takes says more about what else the machine does.
settings.register_profile("unhurried", deadline=None)
settings.load_profile("unhurried")

ONE_AFTER_ANOTHER = ("tests/browser/", "tests/bench/")
"""Tests that draw the page or measure: no two of them at once."""


class _PagesTogether(LoadScopeScheduling):
    """Gives all tests of the page to one process, and any other test to whichever is free."""

    def _split_scope(self, nodeid: str) -> str:
        return "page" if nodeid.startswith(ONE_AFTER_ANOTHER) else nodeid


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> LoadScopeScheduling:
    """Several processes share the tests so (docs/decisions/0030)."""
    return _PagesTogether(config, log)
