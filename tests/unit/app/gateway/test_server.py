"""The gateway as a browser, a script and an attacker meet it."""

from __future__ import annotations

import re
import socket
from collections.abc import Callable

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from fairyring.app.gateway import server
from fairyring.app.gateway.security import is_loopback, is_same_origin
from fairyring.app.gateway.static_files import static_files
from fairyring.app.gateway.viser_page import POLICY
from fairyring.app.settings import Settings
from fairyring.storage.project import Project
from tests.support.tab import SUBPROTOCOL, Panel, Tab, open_socket

ADA = {"Cookie": "fairyring_name=Ada"}


def get(port: int, path: str, **headers: str) -> httpx.Response:
    return httpx.get(f"http://127.0.0.1:{port}{path}", headers={**ADA, **headers})


def test_the_page_is_visers_with_the_editor_added(shared_port: int) -> None:
    page = get(shared_port, "/")
    assert page.status_code == 200
    assert f'<script type="module" src="{static_files().url("editor/main.js")}"></script>' in page.text
    assert '<div id="root"></div>' in page.text
    assert "<title>Fairyring</title>" in page.text
    assert "<title>Viser</title>" not in page.text


def test_no_script_stands_in_the_page_and_the_policy_allows_none(shared_port: int) -> None:
    page = get(shared_port, "/")
    scripts = re.findall(r"<script[^>]*>(.*?)</script>", page.text, re.DOTALL)
    assert scripts == ["", ""]
    assert page.headers["content-security-policy"] == POLICY
    script_sources = re.search(r"script-src ([^;]*)", POLICY).group(1).split()
    assert script_sources == ["'self'", "'unsafe-eval'"]
    assert "frame-ancestors 'none'" in POLICY


def test_everything_the_page_names_may_be_kept_for_ever(shared_port: int) -> None:
    named = re.findall(r'(?:href|src)="([^"]*)"', get(shared_port, "/").text)
    assert len(named) > 40
    assert len(set(named)) == len(named)
    for address in named:
        answer = get(shared_port, address)
        assert answer.status_code == 200, address
        assert answer.headers["cache-control"] == "public, max-age=31536000, immutable", address


def test_a_query_that_could_lead_visers_client_to_another_server_is_dropped(shared_port: int) -> None:
    answer = get(shared_port, "/?websocket=wss://evil.example")
    assert answer.status_code == 307
    assert answer.headers["location"] == "/"


def test_the_name_is_asked_for_once_and_kept_in_a_strict_cookie(shared_port: int) -> None:
    address = f"http://127.0.0.1:{shared_port}"
    with httpx.Client(base_url=address, headers={"Origin": address}) as browser:
        assert 'name="name"' in browser.get("/").text
        answer = browser.post("/name", data={"name": "  Åsa \t Ek "})
        assert answer.status_code == 303
        cookie = answer.headers["set-cookie"]
        assert "HttpOnly" in cookie
        assert "SameSite=strict" in cookie
        assert "Max-Age=31536000" in cookie
        assert "/editor/main.js" in browser.get("/").text
        assert 'value="Åsa Ek"' in browser.get("/name").text


@pytest.mark.parametrize("name", ["", "   ", "x" * 61, "zero\u200bwidth", "bell\x07"])
def test_a_name_that_cannot_be_shown_is_asked_for_again(shared_port: int, name: str) -> None:
    headers = {"Origin": f"http://127.0.0.1:{shared_port}"}
    answer = httpx.post(f"http://127.0.0.1:{shared_port}/name", data={"name": name}, headers=headers)
    assert answer.status_code == 422
    assert "set-cookie" not in answer.headers


def test_a_name_is_escaped_on_its_page(shared_port: int) -> None:
    page = get(shared_port, "/name", Cookie="fairyring_name=%22%3E%3Cscript%3E").text
    assert 'value="&quot;&gt;&lt;script&gt;"' in page


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1.evil.example", "10.0.0.1:8080", "", "a@localhost"]
)
def test_a_foreign_host_is_refused_even_for_reading(shared_port: int, host: str) -> None:
    assert get(shared_port, "/", Host=host).status_code == 403


@pytest.mark.parametrize("host", ["127.0.0.1:1", "localhost", "[::1]:8080", "LOCALHOST:80"])
def test_loopback_names_are_accepted_with_any_forwarded_port(host: str) -> None:
    assert is_loopback(host)


@pytest.mark.parametrize(
    "origin",
    [None, "null", "http://evil.example", "http://localhost:8081", "http://localhost", "ws://localhost:8080"],
)
def test_only_the_very_same_origin_counts(origin: str | None) -> None:
    assert is_same_origin("http://localhost:8080", "localhost:8080")
    assert not is_same_origin(origin, "localhost:8080")


@pytest.mark.parametrize("origin", [None, "http://evil.example", "http://127.0.0.1:1"])
@pytest.mark.parametrize("path", ["/", "/editor"])
def test_a_socket_from_another_page_is_refused(shared_port: int, path: str, origin: str | None) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        open_socket(shared_port, path, origin=origin, subprotocols=[SUBPROTOCOL])


def test_a_change_from_another_page_is_refused(shared_port: int) -> None:
    address = f"http://127.0.0.1:{shared_port}/name"
    assert httpx.post(address, data={"name": "Eve"}).status_code == 403
    evil = {"Origin": "http://evil.example"}
    assert httpx.post(address, data={"name": "Eve"}, headers=evil).status_code == 403


def test_nobody_without_a_name_reaches_the_panel_or_the_photos(shared_port: int) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        open_socket(shared_port, "/", name=None, subprotocols=[SUBPROTOCOL])
    nameless = open_socket(shared_port, "/editor", name=None)
    with pytest.raises(ConnectionClosed) as closed:
        nameless.recv(5)
    assert closed.value.rcvd.code == 4401
    assert httpx.get(f"http://127.0.0.1:{shared_port}/photos/1/0").status_code == 401


def test_the_relay_speaks_visers_protocol_and_its_panel_is_empty_until_the_editor_comes(
    shared_port: int,
) -> None:
    panel = Panel(shared_port, name="Ada")
    assert panel.socket.subprotocol == SUBPROTOCOL
    assert panel.token
    drawn = [m for m in panel.messages if m["type"].startswith("Gui") and "Message" in m["type"]]
    contents = [m["props"]["content"] for m in drawn if m["type"] == "GuiHtmlMessage"]
    assert len(contents) == 1
    assert "bed_1" not in str(panel.messages)
    panel.socket.close()


def test_the_relay_passes_visers_close_code_on(shared_port: int) -> None:
    wrong = open_socket(shared_port, "/", subprotocols=["viser-v0.0.1"])
    with pytest.raises(ConnectionClosed) as closed:
        wrong.recv(5)
    assert closed.value.rcvd.code == 1002
    assert "Version mismatch" in closed.value.rcvd.reason


def test_a_page_of_an_older_version_gets_todays_files_but_may_not_keep_them(shared_port: int) -> None:
    script = get(shared_port, "/static/0123456789abcdef/styles/panel.css")
    assert script.status_code == 200
    assert script.headers["cache-control"] == "no-cache"
    assert get(shared_port, "/viser/0123456789abcdef/client.js").status_code == 404


def test_nothing_outside_static_is_served(shared_port: int) -> None:
    root = static_files().url("")
    for path in ("../pyproject.toml", "%2e%2e/%2e%2e/pyproject.toml", "..%2fpyproject.toml", "editor", ""):
        with socket.create_connection(("127.0.0.1", shared_port)) as raw:
            raw.sendall(f"GET {root}{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
            answer = b"".join(iter(lambda: raw.recv(65536), b""))
        assert answer.startswith(b"HTTP/1.1 404"), path


def test_every_answer_carries_the_security_headers(shared_port: int) -> None:
    asked = [("/", {}), ("/healthz", {}), (static_files().url("styles/panel.css"), {}), ("/nothing", {})]
    for path, sent in [*asked, ("/photos/1/0", {}), ("/", {"Host": "evil.example"})]:
        headers = get(shared_port, path, **sent).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["x-frame-options"] == "DENY"
        assert "frame-ancestors 'none'" in headers["content-security-policy"]


@pytest.mark.parametrize(("path", "name"), [("/", None), ("/nothing", "Ada"), ("/", "Ada")])
def test_a_socket_that_is_refused_is_refused_like_any_other_request(
    shared_port: int, path: str, name: str | None
) -> None:
    origin = "http://evil.example" if (path, name) == ("/", "Ada") else "same"
    with pytest.raises(InvalidStatus) as refused:
        open_socket(shared_port, path, name=name, origin=origin, subprotocols=[SUBPROTOCOL])
    answer = refused.value.response
    assert answer.status_code == 403
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]


def test_a_form_that_is_longer_than_any_name_is_not_read(shared_port: int) -> None:
    address = f"http://127.0.0.1:{shared_port}"
    answer = httpx.post(f"{address}/name", data={"name": "x" * 5000}, headers={"Origin": address})
    assert answer.status_code == 413


def test_a_link_from_elsewhere_does_not_ask_for_the_name_again(shared_port: int) -> None:
    answer = httpx.get(f"http://127.0.0.1:{shared_port}/", headers={"Sec-Fetch-Site": "cross-site"})
    assert 'http-equiv="refresh"' in answer.text
    assert 'name="name"' not in answer.text


def test_downloads_are_found_by_their_own_names_only(port: int, project: Project) -> None:
    exports = project.folder / "cache" / "exports"
    exports.mkdir(parents=True)
    (exports / f"{'0' * 32}.zip").write_bytes(b"zip")
    (exports / "other.zip").write_bytes(b"other")
    assert get(port, f"/downloads/{'0' * 32}.zip").content == b"zip"
    assert get(port, "/downloads/other.zip").status_code == 404
    assert get(port, "/downloads/..%2fexports%2fother.zip").status_code == 404


def test_a_taken_port_is_named_before_anything_is_started(project: Project) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        settings = Settings(port=taken.getsockname()[1])
        with pytest.raises(server.ServerError, match=f"Port {settings.port} .* --port"):
            server.serve(project.folder, settings=settings)


def test_other_hosts_are_refused_until_there_are_accounts(project: Project) -> None:
    with pytest.raises(server.ServerError, match="no accounts yet"):
        server.serve(project.folder, settings=Settings(host="0.0.0.0"))


def test_a_message_larger_than_the_limit_closes_the_socket(serve: Callable[..., int]) -> None:
    with Tab(serve(message_limit_mb=1)) as tab:
        tab.editor.send("x" * (2**20 + 1))
        assert tab.close_code() == 1009
