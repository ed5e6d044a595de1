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


class _PagesByFile(LoadScopeScheduling):
    """A process gets whole files of tests of the page, or all measurements; any other test is alone."""

    def _split_scope(self, nodeid: str) -> str:
        if nodeid.startswith("tests/bench/"):
            return "tests/bench"
        return nodeid.split("::", maxsplit=1)[0] if nodeid.startswith("tests/browser/") else nodeid


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> LoadScopeScheduling:
    """Several processes share the tests so (docs/decisions/0030)."""
    return _PagesByFile(config, log)
