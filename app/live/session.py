"""The server's side of one browser tab: its user, the image on screen, and how to send it messages.

All of this lives on the gateway's event loop. viser's callbacks run on viser's own loop and hop over;
work that waits for the disk or computes hops to a thread and comes back.
"""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Literal

import viser

from fairyring.app.caps.copies import Copy
from fairyring.app.caps.image_caps import ImageCaps, caps_of
from fairyring.app.protocol import FromServer, Notice
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import Kind
from fairyring.storage.images import ImageFilter
from fairyring.storage.records import Annotation, Image, ImageContents, Run

log = logging.getLogger(__name__)

MOST_UNSENT = 2000
"""Messages a tab may lag behind before it is cut off; it comes back and loads its image afresh."""


@dataclass(frozen=True)
class Selection:
    """What the editor has selected, for the inspector."""

    annotations: tuple[str, ...] = ()
    predictions: tuple[int, ...] = ()


@dataclass(eq=False, kw_only=True)
class Session:
    """A tab, from the moment viser's client connects until it disconnects."""

    client: viser.ClientHandle
    beacon: viser.GuiHtmlHandle
    """The element that carries the token into the page."""
    token: str | None
    """Admits one editor socket; None while that socket is open."""
    user: str = ""
    has_panel: bool = False
    redraw: Callable[[tuple[str, ...]], None] = lambda _parts: None
    """Has these parts of the panel drawn anew, together with what else changes within a moment."""
    redraw_at_once: Callable[[tuple[str, ...]], None] = lambda _parts: None
    """The same without waiting for what else may change: the person has asked for these."""
    redraw_soon: Callable[[tuple[str, ...]], None] = lambda _parts: None
    """Has them drawn anew within a second or two, together with what else changes until then."""
    outbox: asyncio.Queue[FromServer] | None = None
    """Messages for the editor's socket; None while the editor is not connected."""
    hang_up: Callable[[], object] = lambda: None
    """Closes the editor's socket."""
    caps: ImageCaps | None = None
    """The image on screen with its caps as they are now."""
    copy: Copy = field(default_factory=Copy)
    """The copy of these caps where fits are worked out."""
    getting_ready: asyncio.Task[None] | None = None
    """Fits all of them, before many are accepted at once."""
    run: Run | None = None
    """The run whose predictions are on screen."""
    filter: ImageFilter = field(default_factory=ImageFilter)
    """The filter and order of the image list, which decide the next image."""
    gallery: Kind = "worst"
    """Which caps of all images the review shows."""
    gallery_group: Group | None = None
    """Only those of this group; None for all."""
    only_sure: bool = False
    """The review's figures leave out doubtful caps and marks that hardly determine a centre."""
    run_on_photo: Run | None = None
    """The run that the photo is compared with, where a reviewer chose one; else the one on screen."""
    queue: tuple[int, ...] = ()
    """The images that a reviewer goes through, which then decide the next image."""
    position: int = 0
    count: int = 0
    selection: Selection = field(default_factory=Selection)
    storing: set[str] = field(default_factory=set)
    """Annotations with edits of this tab on their way to the disk."""
    waiting: int = 0
    """Edits not acknowledged yet, as the browser counts them."""

    @property
    def image(self) -> Image | None:
        """The image on screen."""
        return self.caps.image if self.caps else None

    @property
    def second_annotator(self) -> str | None:
        """What the second annotator's version is called that photos are compared with; None for a model's."""
        return self.run_on_photo.second_annotator if self.run_on_photo else None

    def shows(self, image_id: int) -> bool:
        """Whether this image is on screen."""
        return self.image is not None and self.image.id == image_id

    def send(self, message: FromServer) -> None:
        """Queues a message for the editor; dropped while it is away, as it loads its image afresh."""
        if self.outbox is None:
            return
        try:
            self.outbox.put_nowait(message)
        except asyncio.QueueFull:
            log.warning("A tab of %s does not read its messages; it is cut off.", self.user)
            self.hang_up()

    def notify(
        self, text: str, level: Literal["info", "warning", "error"] = "info", *, undo: int | None = None
    ) -> None:
        """Shows a sentence to the person at this tab, which may have the status of an image taken back."""
        self.send(Notice(text=text, level=level, undo=undo))

    def refresh(self, *parts: str) -> None:
        """Asks for parts of the panel to be drawn anew, after what the person at this tab did."""
        self.redraw(parts)

    def follow(self, *parts: str) -> None:
        """The same after what others did, or what is looked at later: soon is early enough."""
        self.redraw_soon(parts)

    def show(self, contents: ImageContents) -> None:
        """Notes that another image is on screen, with these contents."""
        self.caps, self.run = caps_of(contents), contents.run

    def take_in(self, annotations: list[Annotation]) -> None:
        """Notes what has become of annotations of the image on screen."""
        here = {annotation.uid: annotation for annotation in annotations if self.shows(annotation.image)}
        if self.caps is not None and here:
            self.caps = self.caps.with_annotations({**self.caps.annotations, **here})

    def take_predictions(self, contents: ImageContents) -> None:
        """Notes what a later run said of the image on screen."""
        if self.caps is not None and self.shows(contents.image.id):
            self.caps = caps_of(contents).with_annotations(self.caps.annotations)
            self.run = contents.run


class Tabs:
    """The sessions of all open tabs; they share nothing but the store."""

    def __init__(self) -> None:
        self._sessions: dict[int, Session] = {}

    def __iter__(self) -> Iterator[Session]:
        return iter(tuple(self._sessions.values()))

    def arrive(self, client: viser.ClientHandle) -> None:
        """Makes a session for a new viser client, whose panel holds a hidden token for the editor to send."""
        token = secrets.token_urlsafe(24)
        beacon = client.gui.add_html(_beacon(token), order=-1)
        self._sessions[client.client_id] = Session(client=client, beacon=beacon, token=token)

    def leave(self, client: viser.ClientHandle) -> None:
        """Removes the session of a viser client that has gone, and closes its editor's socket."""
        session = self._sessions.pop(client.client_id, None)
        if session is not None:
            session.hang_up()

    def claim(self, token: str, user: str) -> Session | None:
        """The session this token was made for; None where it was used before. It is used up by this."""
        for session in self:
            if session.token is not None and secrets.compare_digest(session.token, token):
                session.token, session.user = None, user
                return session
        return None

    def release(self, session: Session) -> None:
        """Notes that the editor's socket has closed, and gives the tab a new token to come back with."""
        session.outbox = None
        session.hang_up = lambda: None
        if session.client.client_id in self._sessions:
            session.token = secrets.token_urlsafe(24)
            session.beacon.content = _beacon(session.token)

    def others_on(self, image_id: int, *, besides: Session | None = None) -> Iterator[Session]:
        """Tabs that show this image."""
        return (session for session in self if session is not besides and session.shows(image_id))


def _beacon(token: str) -> str:
    # A urlsafe token has no character that HTML would read as anything else.
    return f'<div id="fairyring-tab" data-token="{token}"></div>'
