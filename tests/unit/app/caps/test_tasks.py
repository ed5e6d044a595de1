"""What processes beside the server are asked: they are up soon, and know no more than they need."""

from __future__ import annotations

import subprocess
import sys

from fairyring.app.caps import tasks


def test_a_process_that_fits_loads_neither_the_page_nor_the_network() -> None:
    ask = f"import sys, {tasks.__name__}; print(*sys.modules)"
    known = subprocess.check_output([sys.executable, "-c", ask], text=True).split()
    assert "fairyring.app.caps.whole_outlines" in known
    assert not {"viser", "starlette", "torch", "fairyring.app.panels"} & set(known)
