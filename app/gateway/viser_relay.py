"""The proxy at ``/``: passes the panel's messages on to viser, and all of viser's to the browser."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from fairyring.app.gateway.hidden_viser import Upstream
from fairyring.app.gateway.login import name_of
from fairyring.app.gateway.viser_messages import may_pass

log = logging.getLogger(__name__)

NO_NAME = 4401
GOING_AWAY = 1001
UNREACHABLE = 1011
UNSENDABLE = frozenset({1005, 1006, 1015})
"""Close codes that only report; a peer may not send them."""


def relay_to(upstream: Upstream) -> Callable[[WebSocket], Awaitable[None]]:
    """The WebSocket endpoint that stands before the hidden viser."""

    async def relay(browser: WebSocket) -> None:
        if name_of(browser) is None:
            await browser.close(NO_NAME, "Open the page first and say your name.")
            return
        offered = [Subprotocol(name) for name in browser.scope["subprotocols"]]
        try:
            async with connect(
                f"ws://127.0.0.1:{upstream.port}/",
                additional_headers=upstream.headers,
                subprotocols=offered or None,
                compression=None,
                max_size=None,
                ping_interval=None,
                proxy=None,
            ) as panels:
                await browser.accept(subprotocol=panels.subprotocol)
                await _pump(browser, panels)
        except (OSError, WebSocketException) as error:
            log.warning("The panel's server cannot be reached: %s", error)
            await browser.close(UNREACHABLE)

    return relay


async def _pump(browser: WebSocket, panels: ClientConnection) -> None:
    """Carries frames both ways until either side closes, then closes the other with the same code."""
    pumps = {
        asyncio.create_task(_to_viser(browser, panels)),
        asyncio.create_task(_to_browser(browser, panels)),
    }
    try:
        done, _ = await asyncio.wait(pumps, return_when=asyncio.FIRST_COMPLETED)
        code, reason = done.pop().result()
    finally:
        for pump in pumps:
            pump.cancel()
        await asyncio.gather(*pumps, return_exceptions=True)
    code = GOING_AWAY if code in UNSENDABLE else code
    await panels.close(code, reason)
    if (
        browser.application_state is WebSocketState.CONNECTED
        and browser.client_state is WebSocketState.CONNECTED
    ):
        await browser.close(code, reason)


async def _to_viser(browser: WebSocket, panels: ClientConnection) -> tuple[int, str]:
    try:
        while True:
            frame = await browser.receive()
            if frame["type"] == "websocket.disconnect":
                return frame.get("code") or GOING_AWAY, frame.get("reason") or ""
            data = frame.get("bytes")
            if data is not None and may_pass(data):
                await panels.send(data)
            else:
                log.info("A message to the panel was dropped: it is none that a control makes.")
    except ConnectionClosed as closed:
        return _close_of(closed)


async def _to_browser(browser: WebSocket, panels: ClientConnection) -> tuple[int, str]:
    try:
        while True:
            frame = await panels.recv()
            if isinstance(frame, str):
                await browser.send_text(frame)
            else:
                await browser.send_bytes(frame)
    except ConnectionClosed as closed:
        return _close_of(closed)
    except WebSocketDisconnect:
        # The page went while a message was on its way, as it does when it is loaded anew.
        return GOING_AWAY, ""


def _close_of(closed: ConnectionClosed) -> tuple[int, str]:
    return (closed.rcvd.code, closed.rcvd.reason) if closed.rcvd else (GOING_AWAY, "")
