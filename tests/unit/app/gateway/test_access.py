"""The way into a project on a machine that others use, too."""

from __future__ import annotations

import stat
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from fairyring.app.gateway.access import KEY_FILE, Door, door_of
from tests.support.tab import SUBPROTOCOL, open_socket


@pytest.fixture
def door() -> Door:
    return Door(key=b"k" * 32, cookie="fairyring_pass_beds")


@pytest.fixture
def browser(serve: Callable[..., int], door: Door) -> httpx.Client:
    return httpx.Client(base_url=f"http://127.0.0.1:{serve(door=door)}")


@pytest.mark.parametrize(
    "path", ["/", "/name", "/photos/1/0", "/static/styles/editor.css", "/downloads/a.zip", "/?token="]
)
def test_nothing_is_served_to_a_browser_that_was_not_led_in(browser: httpx.Client, path: str) -> None:
    answer = browser.get(path)
    assert answer.status_code == 403
    assert "fairyring serve" in answer.text
    assert answer.headers["x-frame-options"] == "DENY"


def test_whether_the_server_is_up_may_be_asked_by_anybody(browser: httpx.Client) -> None:
    assert browser.get("/healthz").text == "ok"


def test_the_token_leads_in_once_and_the_cookie_for_good(browser: httpx.Client, door: Door) -> None:
    address = f"/?token={door.token}"
    first = browser.get(address)
    assert first.status_code == 303
    assert first.headers["location"] == "/"
    cookie = first.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert "Your name" in browser.get("/").text
    stranger = httpx.get(f"{browser.base_url}{address}")
    assert stranger.status_code == 403


def test_another_token_is_told_when_one_is_spent(door: Door) -> None:
    told: list[str] = []
    door.used = lambda: told.append(door.token)
    spent = door.token
    assert not door.spend("guess")
    assert not door.spend("gu\udce9ss")
    assert told == []
    assert door.spend(spent)
    assert told == [door.token]
    assert door.token != spent
    assert not door.spend(spent)


@pytest.mark.parametrize("value", ["", ".", "a.b", "a", "é.\udce9", "x" * 5000])
def test_a_cookie_of_ones_own_making_leads_nowhere(door: Door, value: str) -> None:
    assert not door.knows(value)


def test_a_cookie_of_another_project_leads_nowhere(door: Door) -> None:
    other = Door(key=b"o" * 32, cookie=door.cookie)
    assert door.knows(door.new_pass())
    assert not other.knows(door.new_pass())


@pytest.mark.parametrize("path", ["/", "/editor"])
def test_no_socket_is_opened_without_the_cookie(browser: httpx.Client, path: str) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        open_socket(browser.base_url.port or 0, path, subprotocols=[SUBPROTOCOL])


def test_browsers_are_known_after_a_restart_and_the_key_is_nobody_elses(tmp_path: Path) -> None:
    before = door_of(tmp_path / "cache", project_id="beds")
    after = door_of(tmp_path / "cache", project_id="beds")
    assert after.knows(before.new_pass())
    assert after.token != before.token
    assert stat.S_IMODE((tmp_path / "cache" / KEY_FILE).stat().st_mode) == 0o600


def test_a_damaged_key_is_made_anew(tmp_path: Path) -> None:
    (tmp_path / KEY_FILE).write_bytes(b"short")
    assert len(door_of(tmp_path, project_id="beds").key) == 32


def test_a_key_that_cannot_be_kept_is_good_until_the_end(tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file where a folder should be")
    door = door_of(tmp_path / "cache", project_id="beds")
    assert door.knows(door.new_pass())


def test_a_link_from_elsewhere_is_asked_again_from_here(browser: httpx.Client) -> None:
    assert 'http-equiv="refresh"' in browser.get("/", headers={"Sec-Fetch-Site": "cross-site"}).text
