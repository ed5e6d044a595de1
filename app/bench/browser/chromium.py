"""Finds a Chromium to test and measure in, or installs one: one installed, else Debian's, else playwright's.

``python -m fairyring.app.bench.browser.chromium`` prints its path, or fails with the remedy.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
MAC = Path("/Applications/Google Chrome.app/Contents/MacOS/Google Chrome")

FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # Without WebGL viser's page stays empty; the software renderer gives it one on any machine.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # A canvas kept on the CPU pans ten times faster than one read back from a software GPU.
    "--disable-gpu-compositing",
    "--disable-gpu-rasterization",
    "--disable-accelerated-2d-canvas",
)

REMEDY = (
    "No Chromium was found and none could be installed. Install Chromium or Chrome, "
    "or point FAIRYRING_CHROMIUM at one, and try again."
)


def find() -> Path | None:
    """The browser named by FAIRYRING_CHROMIUM, else one on the PATH, else one playwright has fetched."""
    named = os.environ.get("FAIRYRING_CHROMIUM")
    candidates = [Path(named)] if named else [Path(p) for p in map(shutil.which, NAMES) if p]
    return next((p for p in (*candidates, MAC, *_fetched_by_playwright()) if p.exists()), None)


def _fetched_by_playwright() -> list[Path]:
    with sync_playwright() as playwright:
        return [Path(playwright.chromium.executable_path)]


def install() -> None:
    """Tries Debian's package where this user may install one, then playwright's download."""
    sudo = [] if os.geteuid() == 0 else ["sudo", "-n"]
    attempts = [[sys.executable, "-m", "playwright", "install", "chromium"]]
    if shutil.which("apt-get"):
        attempts.insert(0, [*sudo, "apt-get", "install", "-y", "-qq", "chromium"])
        attempts.insert(0, [*sudo, "apt-get", "update", "-qq"])
    for command in attempts:
        if find() is None and (shutil.which(command[0]) or Path(command[0]).exists()):
            sys.stderr.write(f"Looking for a browser: {' '.join(command)}\n")
            subprocess.run(command, check=False, stdout=sys.stderr)


def main() -> int:
    """Exit code 0 and the path on stdout, or 1 and the remedy."""
    if find() is None:
        install()
    path = find()
    (sys.stdout if path else sys.stderr).write(f"{path or REMEDY}\n")
    return 0 if path else 1


if __name__ == "__main__":
    sys.exit(main())
