"""The login without accounts: everybody says their name once, and a cookie remembers it."""

from __future__ import annotations

import unicodedata
from html import escape
from urllib.parse import quote, unquote

from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response

from fairyring.app.gateway.static_files import static_files

COOKIE = "fairyring_name"
LONGEST_NAME = 60
LARGEST_FORM = 4096
"""Most bytes of the form in which a name is given."""
A_YEAR = 365 * 24 * 3600


def clean_name(text: str) -> str | None:
    """A name fit to be stored with edits: printable, single spaces, at most 60 characters; else None."""
    name = " ".join(unicodedata.normalize("NFC", text).split())
    return name if 0 < len(name) <= LONGEST_NAME and name.isprintable() else None


def name_of(connection: HTTPConnection) -> str | None:
    """The name in the cookie of a request or socket; None without a valid one."""
    return clean_name(unquote(connection.cookies.get(COOKIE, "")))


async def name_page(request: Request) -> Response:
    """GET /name asks for the name, POST /name remembers it and leads to the editor."""
    if request.method != "POST":
        return ask_for_name(name_of(request) or "")
    length = request.headers.get("content-length", "")
    if not length.isdigit() or int(length) > LARGEST_FORM:
        return PlainTextResponse("A name is a short form.", status_code=413)
    form = await request.form(max_files=0, max_fields=4)
    name = clean_name(str(form.get("name", "")))
    if name is None:
        problem = f"Please give a name of 1 to {LONGEST_NAME} letters."
        return ask_for_name(problem=problem, status_code=422)
    response = RedirectResponse("/", status_code=303)
    response.set_cookie(COOKIE, quote(name), max_age=A_YEAR, httponly=True, samesite="strict")
    return response


def ask_for_name(name: str = "", *, problem: str = "", status_code: int = 200) -> Response:
    """The page that asks for a name."""
    files = static_files()
    filled = files.contents["name.html"].decode()
    for hole, words in {
        "style": files.url("name.css"),
        "icon": files.url("icon.svg"),
        "name": name,
        "problem": problem,
    }.items():
        filled = filled.replace(f"{{{{{hole}}}}}", escape(words))
    return HTMLResponse(filled, status_code=status_code, headers={"Cache-Control": "no-store"})
