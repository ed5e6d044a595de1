"""viser's page, with the editor's modules and styles added and the strictest policy it can live with.

The page holds no script of its own, so none that ends up in the panel's HTML can ever run. It names all
modules at once, so that none waits for another that imports it.
"""

from __future__ import annotations

import re
from functools import lru_cache

from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from fairyring.app.gateway.access import COMING_BACK
from fairyring.app.gateway.compressed import compressed
from fairyring.app.gateway.login import ask_for_name, name_of
from fairyring.app.gateway.static_files import StaticFiles, static_files
from fairyring.app.gateway.viser_client import DECODER, MODULE, START, STYLES, WASM, load_viser

MAIN = "editor/main.js"
OWN_STYLES = tuple(
    f"styles/{name}.css"
    for name in (
        *("editor", "messages", "dialogs"),
        *("viser", "panel", "tools", "cap", "view", "desk", "overview"),
    )
)
"""Over the photo, then in the panel: what several share comes before what refines it."""
POLICY = "; ".join(
    (
        "default-src 'none'",
        # viser's WebAssembly names its functions by evaluating a string.
        "script-src 'self' 'unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "connect-src 'self' data: blob:",
        "worker-src 'self' blob: data:",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    )
)


def page(request: Request) -> Response:
    """GET /: the editor, or the question for a name while the cookie is missing."""
    if request.url.query:
        # viser's client takes the address of another server from here; nobody may be led to one.
        return RedirectResponse("/")
    if name_of(request) is None:
        if request.headers.get("sec-fetch-site") == "cross-site":
            # A strict cookie is held back when a link elsewhere leads here; asked again from here, it comes.
            return HTMLResponse(COMING_BACK, headers={"Cache-Control": "no-store"})
        return ask_for_name()
    html = page_with(static_files())
    response = compressed(request, html.encode(), media_type="text/html", cache_control="no-store")
    response.headers["Content-Security-Policy"] = POLICY
    return response


@lru_cache(maxsize=1)
def page_with(own: StaticFiles) -> str:
    """viser's page, made ours. Raises FairyringError where the installed viser is not the expected one."""
    viser = load_viser()
    modules = [viser.url(MODULE), *map(own.url, own.imported_by(MAIN))]
    head = [
        "<title>Fairyring</title>",
        f'<link rel="icon" type="image/svg+xml" href="{own.url("icon.svg")}">',
        f'<link rel="preload" as="fetch" type="{WASM}" crossorigin href="{viser.url(DECODER)}">',
        *(f'<link rel="modulepreload" href="{module}">' for module in modules),
        *(f'<link rel="stylesheet" href="{own.url(sheet)}">' for sheet in OWN_STYLES),
        f'<link rel="stylesheet" href="{viser.url(STYLES)}">',
        f'<script type="module" src="{viser.url(START)}"></script>',
        f'<script type="module" src="{own.url(MAIN)}"></script>',
    ]
    before = re.sub(r"<title>.*?</title>|<link\s+rel=\"icon\"[^>]*>", "", viser.before, flags=re.DOTALL)
    return before + "\n    ".join(head) + viser.after
