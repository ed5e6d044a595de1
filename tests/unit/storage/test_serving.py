"""One server a project."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fairyring.storage.errors import StoreError
from fairyring.storage.serving import LOCK, require_not_served, served
from tests.support.unprivileged import make_read_only, nobody, open_folder

SERVING = """
import sys, time
from pathlib import Path
from fairyring.storage.serving import served
with served(Path(sys.argv[1]), address="http://localhost:8099"):
    print("serving", flush=True)
    time.sleep(60)
"""


def test_a_second_server_is_refused_with_the_address_of_the_first(tmp_path: Path) -> None:
    with served(tmp_path, address="http://localhost:8080"):
        with (
            pytest.raises(StoreError, match="is served already at http://localhost:8080"),
            served(tmp_path, address="http://localhost:8081"),
        ):
            raise AssertionError
        with pytest.raises(StoreError, match="is served already"):
            require_not_served(tmp_path)
    require_not_served(tmp_path)
    with served(tmp_path, address="http://localhost:8081"):
        assert (tmp_path / LOCK).read_text() == "http://localhost:8081"


def test_a_server_that_was_killed_serves_no_longer(tmp_path: Path) -> None:
    first = subprocess.Popen([sys.executable, "-c", SERVING, str(tmp_path)], stdout=subprocess.PIPE)
    assert first.stdout is not None
    first.stdout.readline()
    with pytest.raises(StoreError, match="served already at http://localhost:8099"):
        require_not_served(tmp_path)
    first.kill()
    first.wait()
    require_not_served(tmp_path)
    with served(tmp_path, address="http://localhost:8080"):
        pass


def test_a_folder_that_cannot_be_written_may_have_any_number_of_servers() -> None:
    with open_folder() as folder:
        make_read_only(folder)
        with nobody(), served(folder, address="a"), served(folder, address="b"):
            require_not_served(folder)
