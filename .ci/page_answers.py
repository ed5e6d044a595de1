"""Runs a command until the page whose address it prints answers; says how long that took, and ends it.

    python3 .ci/page_answers.py fairyring serve beds --port 9000

Fails where the command ends by itself, or where the address is not on its last line.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from http.cookiejar import CookieJar
from typing import IO
from urllib.request import HTTPCookieProcessor, build_opener

PATIENCE_S = 1800
ADDRESS = re.compile(r"http://localhost:\d+\S*")


def main(command: list[str]) -> None:
    began = time.monotonic()
    with tempfile.TemporaryFile("w+") as said:
        running = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            while (address := ADDRESS.search(last_line(said))) is None:
                if running.poll() is not None or time.monotonic() - began > PATIENCE_S:
                    sys.exit(f"{read(said)}\n{' '.join(command)}: no page answered.")
                time.sleep(0.05)
            # The address of a first visit may hold a token, which is exchanged for a cookie.
            with build_opener(HTTPCookieProcessor(CookieJar())).open(address[0], timeout=60) as answer:
                page = answer.read().decode()
            taken = time.monotonic() - began
            if "<title>Fairyring</title>" not in page or not ADDRESS.search(last_line(said)):
                sys.exit(f"{read(said)}\n{page}\nThis is not the page, or its address is not the last line.")
        finally:
            with suppress(ProcessLookupError):
                os.killpg(running.pid, signal.SIGTERM)
            running.wait(30)
        sys.stdout.write(f"{' '.join(command)}: the page answered after {taken:.1f} s\n")


def read(said: IO[str]) -> str:
    said.seek(0)
    return said.read().strip()


def last_line(said: IO[str]) -> str:
    return read(said).rpartition("\n")[2]


main(sys.argv[1:])
