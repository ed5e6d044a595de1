"""HTTP requests that come whole within a while, or are given up.

uvicorn waits for the rest of a request for ever, and keeps a connection open for each.
"""

from __future__ import annotations

import asyncio
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

WHOLE_WITHIN_S = 15.0


class TimelyRequests(H11Protocol):
    """uvicorn's HTTP, which closes a connection on which half a request has stood for too long."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Nothing at all is half a request, too."""
        super().connection_made(transport)
        self._set_deadline()

    def data_received(self, data: bytes) -> None:
        """Begins to wait with the first byte of a request, and ends with the last."""
        super().data_received(data)
        if self._is_waiting_for_more():
            self._set_deadline()
        else:
            self._clear_deadline()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """Leaves the connection to the WebSocket."""
        self._clear_deadline()
        super().handle_websocket_upgrade(event)

    def connection_lost(self, exc: Exception | None) -> None:
        """Nothing is waited for any longer."""
        self._clear_deadline()
        super().connection_lost(exc)

    def _is_waiting_for_more(self) -> bool:
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return False
        has_begun = self.conn.their_state is h11.IDLE and bool(self.conn.trailing_data[0])
        return has_begun or self.conn.their_state is h11.SEND_BODY

    def _set_deadline(self) -> None:
        if self._deadline is None:
            self._deadline = self.loop.call_later(WHOLE_WITHIN_S, self.transport.abort)

    def _clear_deadline(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None
