"""What holds for all tests."""

import os
from collections.abc import Generator
from typing import Any

import pytest
from hypothesis import settings
from xdist.scheduler import LoadScopeScheduling

# As the command does: servers, browsers and networks of tests share the cores. PyTorch reads both.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
if "PYTEST_XDIST_WORKER" in os.environ:
    # There is a process of tests for each core.
    os.environ.setdefault("OMP_NUM_THREADS", "1")

# How long an example takes says more about what else the machine does.
settings.register_profile("unhurried", deadline=None)
settings.load_profile("unhurried")


class _ByFile(LoadScopeScheduling):
    """A process gets whole files, whose tests share a browser, project or network; or all measurements."""

    def _split_scope(self, nodeid: str) -> str:
        if nodeid.startswith("tests/bench/"):
            return "tests/bench"
        # Of these a test takes up to minutes, and those of a file share little.
        return nodeid if nodeid.startswith("tests/faults/") else nodeid.split("::", maxsplit=1)[0]


@pytest.hookimpl(wrapper=True)
def pytest_report_to_serializable() -> Generator[None, Any, Any]:
    """Half a character in the report of a failing test would end the whole run, unsaid which test it was."""
    return _encodable((yield))


def _encodable(value: Any) -> Any:
    if isinstance(value, str):
        return value.encode(errors="backslashreplace").decode()
    if isinstance(value, dict):
        return {_encodable(key): _encodable(each) for key, each in value.items()}
    return type(value)(map(_encodable, value)) if type(value) in (list, tuple) else value


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> LoadScopeScheduling:
    """Several processes share the tests so (docs/decisions/0030)."""
    return _ByFile(config, log)
