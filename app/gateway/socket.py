"""The editor's WebSocket: one a tab, JSON text frames, see ``app.protocol``."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from contextlib import suppress

import anyio.to_thread
import msgspec
from msgspec import Struct
from starlette.websockets import WebSocket, WebSocketDisconnect

from fairyring.app.gateway.bounded_sockets import trust
from fairyring.app.gateway.login import name_of
from fairyring.app.live.editing import Refits, apply_edits
from fairyring.app.live.finding import Finding
from fairyring.app.live.opening import open_image, reopen, step
from fairyring.app.live.queues import take_up_queue
from fairyring.app.live.recalling import recall
from fairyring.app.live.repeating import ask_again, keep_again
from fairyring.app.live.reviewing import compare_photo_with_number, tell_differences
from fairyring.app.live.session import MOST_UNSENT, Selection, Session
from fairyring.app.live.tagging import tag
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import tell_errors
from fairyring.app.panels.jobs import cancel
from fairyring.app.panels.layout import build_panel
from fairyring.app.panels.predict import predict_one
from fairyring.app.panels.window import follow_window
from fairyring.app.protocol import (
    AskAgain,
    Cancel,
    Compare,
    Compared,
    CompareWith,
    Edits,
    FindCap,
    FromServer,
    Hello,
    Incoming,
    MarkedAgain,
    Open,
    Outcomes,
    Predict,
    Predicted,
    Recall,
    Recalled,
    Refit,
    Saving,
    Select,
    Show,
    ShowCaps,
    Step,
    Tag,
    Welcome,
    Window,
)
from fairyring.storage.records import Refused

log = logging.getLogger(__name__)

NO_NAME, NO_TAB, TOO_BIG, GONE = 4401, 4403, 1009, 4410
"""Close codes: say your name first; wait for a new token; message too big; the tab is gone or lags behind."""
HELLO_WITHIN_S = 15.0
A_MEGABYTE = 2**20
FRAME_MARGIN = 1024
"""Bytes by which a frame may pass the limit of a message, so that this socket can say so itself."""

UNREADABLE = (msgspec.DecodeError, UnicodeError, RecursionError)
"""What comes of a text that is no message: no JSON, half a character, a list in a list in a list …"""

Answering = tuple[Refits, Finding]
"""Who answers what a tab asks again and again: of its caps, of the network."""

_incoming = msgspec.json.Decoder(Incoming)
_outgoing = msgspec.json.Encoder()


def editor_of(workspace: Workspace) -> Callable[[WebSocket], Awaitable[None]]:
    """The endpoint ``/editor``."""

    async def editor(socket: WebSocket) -> None:
        await socket.accept()
        user = name_of(socket)
        if user is None:
            await socket.close(NO_NAME, "Open the page first and say your name.")
            return
        hello = await _hello(socket)
        session = workspace.tabs.claim(hello.token, user) if hello else None
        if hello is None or session is None:
            with suppress(RuntimeError, WebSocketDisconnect):
                await socket.close(NO_TAB, "This token is not known, or was used before.")
            return
        try:
            await _talk(workspace, session, socket, hello)
        finally:
            workspace.tabs.release(session)

    return editor


async def _hello(socket: WebSocket) -> Hello | None:
    """The first message, if it is one and comes in time."""
    try:
        async with asyncio.timeout(HELLO_WITHIN_S):
            message = _incoming.decode(await socket.receive_text())
    except (TimeoutError, WebSocketDisconnect, KeyError, *UNREADABLE):
        return None
    return message if isinstance(message, Hello) else None


async def _talk(workspace: Workspace, session: Session, socket: WebSocket, hello: Hello) -> None:
    """Serves one editor until either side leaves."""
    outbox = session.outbox = asyncio.Queue[FromServer](MOST_UNSENT)
    sending = asyncio.create_task(_send_all(socket, outbox))
    receiving = asyncio.create_task(_receive_all(workspace, session, socket, hello))
    session.hang_up = receiving.cancel
    try:
        done, _ = await asyncio.wait({sending, receiving}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        sending.cancel()
        receiving.cancel()
        await asyncio.gather(sending, receiving, return_exceptions=True)
    for task in done:
        if task.cancelled():
            with suppress(RuntimeError, WebSocketDisconnect):
                await socket.close(GONE)
        elif error := task.exception():
            log.error("A tab of %s was closed by an error.", session.user, exc_info=error)
            with suppress(RuntimeError, WebSocketDisconnect):
                await socket.close(1011)


async def _send_all(socket: WebSocket, outbox: asyncio.Queue[FromServer]) -> None:
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            message = await outbox.get()
            await socket.send_text(await _encode(message))


async def _encode(message: FromServer) -> str:
    """A message as JSON; encoded in a thread where it may be large."""
    if isinstance(message, Show | Predicted | Recalled | Compared):
        return (await anyio.to_thread.run_sync(_outgoing.encode, message)).decode()
    return _outgoing.encode(message).decode()


async def _receive_all(workspace: Workspace, session: Session, socket: WebSocket, hello: Hello) -> None:
    # Before anything is said: an answer to the first word may be large.
    limit = workspace.settings.message_limit_mb * A_MEGABYTE
    trust(socket.scope, most=limit + FRAME_MARGIN)
    session.send(
        Welcome(
            user=session.user,
            project=workspace.project.id,
            look_ahead=workspace.settings.look_ahead,
        )
    )
    if workspace.project.read_only:
        session.notify("This project is read-only; changes to it are refused.", "warning")
    await take_up_queue(workspace, session)
    build_panel(workspace, session)
    await reopen(workspace, session, hello.image)
    refits, finding = Refits(workspace, session), Finding(workspace, session)
    try:
        while True:
            text = await socket.receive_text()
            if len(text) > limit:
                await socket.close(TOO_BIG, "This message is larger than the server takes.")
                return
            await _handle(workspace, session, (refits, finding), text)
    except (WebSocketDisconnect, KeyError):
        return
    finally:
        refits.close()
        finding.close()


async def _handle(workspace: Workspace, session: Session, answering: Answering, text: str) -> None:
    """Carries out one message; errors that a person can put right are shown, and the socket stays open."""
    try:
        message = _incoming.decode(text)
    except UNREADABLE as error:
        _refuse(session, text, reason=str(error))
        return
    await tell_errors(session, lambda: _carry_out(workspace, session, answering, message))


async def _carry_out(workspace: Workspace, session: Session, answering: Answering, message: Incoming) -> None:
    refits, finding = answering
    match message:
        case Edits():
            await apply_edits(workspace, session, message)
        case Refit():
            refits.ask(message)
        case FindCap():
            finding.ask(message)
        case Open(image=image, select=select):
            await open_image(workspace, session, image, select=select)
        case Step(by=by):
            await step(workspace, session, by)
        case Select(annotations=annotations, predictions=predictions):
            session.selection = Selection(tuple(annotations), tuple(predictions))
            session.refresh("cap")
        case Recall():
            await recall(workspace, session, message)
        case Saving(waiting=waiting):
            session.waiting = waiting
            session.refresh("status")
        case Window() | Tag() | Predict() | Cancel() | Compare() | CompareWith() | ShowCaps():
            await _carry_out_for_panel(workspace, session, message)
        case AskAgain(quiet=quiet):
            await ask_again(workspace, session, quiet=quiet)
        case MarkedAgain():
            await keep_again(workspace, session, message)
        case Hello():
            session.notify("This tab has said hello before.", "warning")


_FromPanel = Window | Tag | Predict | Cancel | Compare | CompareWith | ShowCaps


async def _carry_out_for_panel(workspace: Workspace, session: Session, message: _FromPanel) -> None:
    """Carries out what the panel's own HTML asks for by way of the editor, and what reviewers ask."""
    match message:
        case Compare(image=image):
            await tell_differences(workspace, session, image)
        case CompareWith(run=run):
            await compare_photo_with_number(workspace, session, run)
        case ShowCaps(kind=kind, group=group):
            session.gallery, session.gallery_group = kind, group
            session.redraw_at_once(("gallery",))
        case Window():
            follow_window(session, message)
        case Tag():
            await tag(workspace, message)
        case Predict(image=image):
            await predict_one(workspace, session, image)
        case Cancel(job=job):
            cancel(workspace, session, job)


class _Named(Struct):
    id: str


class _Unreadable(Struct):
    """The ids of an unreadable change set, to refuse its edits one by one."""

    edits: list[_Named] = []
    statuses: list[_Named] = []
    verdicts: list[_Named] = []


def _refuse(session: Session, text: str, *, reason: str) -> None:
    """Answers a message that cannot be read, so that the browser does not send its edits for ever."""
    sentence = f"The server cannot read this: {reason}."
    try:
        message = msgspec.json.decode(text, type=_Unreadable)
    except UNREADABLE:
        message = _Unreadable()
    edits = message.edits + message.statuses + message.verdicts
    if edits:
        session.send(Outcomes(outcomes=[Refused(edit=edit.id, reason=sentence) for edit in edits]))
    else:
        session.notify(sentence, "error")
