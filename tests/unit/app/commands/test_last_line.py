"""The line that stays the last one."""

from __future__ import annotations

import os
import pty
import subprocess
import sys

SCRIPT = """
import logging, sys, warnings
from fairyring.app.commands.last_line import last_line
logging.basicConfig(stream=sys.stderr)
with last_line() as show:
    show("open at http://localhost:8080")
    logging.warning("a log")
    warnings.warn("a warning")
"""


def test_what_is_logged_and_warned_of_on_a_terminal_goes_above_it() -> None:
    ours, theirs = pty.openpty()
    # Wide enough for the line, known as a terminal.
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "80", "LINES": "24"}
    subprocess.run([sys.executable, "-c", SCRIPT], stderr=theirs, env=environment, check=True)
    written = os.read(ours, 65536).decode()
    os.close(theirs)
    os.close(ours)
    shown = written.rindex("open at http://localhost:8080")
    assert 0 < written.index("a log") < shown
    assert 0 < written.index("a warning") < shown


def test_where_stderr_is_no_terminal_the_line_is_written_once() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert done.stderr.count("open at http://localhost:8080\n") == 1
    assert done.stdout == ""
