"""The server: starts viser on a hidden port and the gateway in front of it."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from functools import partial
from pathlib import Path

import uvicorn
import viser
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp

from fairyring.app.addresses import DOWNLOADS, PHOTOS, REVIEWS, UPLOADS
from fairyring.app.caps import tasks
from fairyring.app.gateway.access import Door, OnlyWithPass, door_of
from fairyring.app.gateway.bounded_sockets import sockets_of_one_server
from fairyring.app.gateway.downloads import downloads_of
from fairyring.app.gateway.hidden_viser import Upstream, start_viser, stop_viser
from fairyring.app.gateway.login import name_page
from fairyring.app.gateway.photos import clear_unfinished, photos_of
from fairyring.app.gateway.reviews import reviews_of
from fairyring.app.gateway.security import LOOPBACK, Guard
from fairyring.app.gateway.socket import editor_of
from fairyring.app.gateway.static_files import static_file
from fairyring.app.gateway.timely_requests import TimelyRequests
from fairyring.app.gateway.uploads import uploads_of
from fairyring.app.gateway.viser_client import load_viser, viser_file
from fairyring.app.gateway.viser_page import page
from fairyring.app.gateway.viser_relay import relay_to
from fairyring.app.jobs.exports import exports_folder
from fairyring.app.live.missing_outlines import find_other_outlines
from fairyring.app.live.watching import watch
from fairyring.app.live.workspace import Workspace
from fairyring.app.settings import Settings, load_settings
from fairyring.app.workers.crew import crew
from fairyring.app.workers.worker import keep_at_hand
from fairyring.model.errors import FairyringError
from fairyring.storage.importing.staging import clear_killed_imports
from fairyring.storage.project import Project, open_project
from fairyring.storage.serving import served
from fairyring.storage.taken_out import let_go
from fairyring.storage.whole_folders import clear_leftovers

log = logging.getLogger(__name__)

CLOSING_WITHIN_S = 3


class ServerError(FairyringError):
    """The server cannot be started as asked."""


def serve(
    project_folder: Path,
    *,
    settings: Settings | None = None,
    ready: Callable[[str], object] = lambda _address: None,
) -> None:
    """Serves a project until SIGINT or SIGTERM, then closes everything.

    ``ready`` is called with the address once the server answers, and again whenever it has led a browser in
    and another one does from then on. Raises ServerError for an address that may not be listened on or a port
    that is taken, and StoreError where the project cannot be opened or is served already; before anything is
    started.
    """
    settings = settings or load_settings(project_folder)
    load_viser()
    with contextlib.ExitStack() as opened:
        listening = opened.enter_context(contextlib.closing(_listen(settings)))
        address = f"http://{_shown_host(settings.host)}:{listening.getsockname()[1]}"
        project = opened.enter_context(open_project(project_folder))
        opened.enter_context(served(project.folder, address=address))
        _clear_leftovers(project)
        if project.read_only:
            log.warning("%s is read-only: it is shown as it is now, and changes are refused.", project.folder)
        keep_at_hand([tasks.__name__])
        workspace = Workspace(project, settings, crew=crew(apart=True))
        door = door_of(project.cache, project_id=project.id) if settings.token else None

        def announce() -> None:
            ready(f"{address}/?token={door.token}" if door else address)

        if door is not None:
            door.used = announce
        server = _Server(configure(make_app(workspace, door=door)), announce)
        # Told to end, uvicorn shuts down and passes the signal on; by itself SIGTERM would end all here.
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        server.run(sockets=[listening])


def _clear_leftovers(project: Project) -> None:
    """Removes what imports, exports and servers that were killed left in the project."""
    clear_killed_imports(project)
    clear_leftovers(exports_folder(project))
    clear_unfinished(project)


def make_app(workspace: Workspace, *, door: Door | None) -> ASGIApp:
    """The ASGI application of a project; starts viser with its lifespan and stops it with it.

    ``door`` None lets every browser on this machine in.
    """
    upstream = Upstream()

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        panels = await asyncio.to_thread(partial(start_viser, upstream, label=workspace.project.name))
        _greet(panels, workspace, asyncio.get_running_loop())
        await find_other_outlines(workspace)
        watching = asyncio.create_task(watch(workspace))
        try:
            yield
        finally:
            watching.cancel()
            await asyncio.gather(watching, return_exceptions=True)
            await workspace.close()
            await asyncio.to_thread(let_go, workspace.project)
            await asyncio.to_thread(stop_viser, panels)

    cache_limit = workspace.settings.photo_cache_mb * 2**20
    app = Starlette(
        routes=[
            Route("/", page),
            WebSocketRoute("/", relay_to(upstream)),
            WebSocketRoute("/editor", editor_of(workspace)),
            Route("/name", name_page, methods=["GET", "POST"]),
            Route(
                PHOTOS, photos_of(workspace.project, cache_limit=cache_limit, run=workspace.crew.photos.run)
            ),
            Route(UPLOADS, uploads_of(workspace), methods=["POST"]),
            Route(DOWNLOADS, downloads_of(workspace.project)),
            Route(REVIEWS, reviews_of(workspace.project)),
            Route("/healthz", _healthz),
            Route("/static/{version}/{path:path}", static_file),
            Route("/viser/{version}/{name}", viser_file),
        ],
        middleware=[Middleware(OnlyWithPass, door)] if door else [],
        lifespan=lifespan,
    )
    # Around all of it, so that even an answer about an error of ours has its headers.
    return Guard(app)


def _listen(settings: Settings) -> socket.socket:
    if settings.host not in LOOPBACK:
        raise ServerError(
            f"Fairyring has no accounts yet, so it listens on this machine alone; give --host 127.0.0.1, not "
            f"{settings.host} (from elsewhere, forward the port with ssh -L)."
        )
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((settings.host, settings.port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        raise ServerError(
            f"Port {settings.port} of {settings.host} cannot be listened on ({error.strerror}); "
            f"stop what uses it, or give another with --port."
        ) from None
    return listening


def _shown_host(host: str) -> str:
    return f"[{host}]" if ":" in host else "localhost" if host == "127.0.0.1" else host


def configure(app: ASGIApp) -> uvicorn.Config:
    """uvicorn for the gateway: silent, no compression, requests and sockets within bounds."""
    return uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        server_header=False,
        http=TimelyRequests,
        ws=sockets_of_one_server(),
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=CLOSING_WITHIN_S,
    )


class _Server(uvicorn.Server):
    """uvicorn's server, which calls back once it answers."""

    def __init__(self, config: uvicorn.Config, announce: Callable[[], None]) -> None:
        super().__init__(config)
        self._announce = announce

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._announce()


def _greet(panels: viser.ViserServer, workspace: Workspace, loop: asyncio.AbstractEventLoop) -> None:
    """Passes viser's clients on to the gateway's event loop, where the sessions are kept."""

    @panels.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        loop.call_soon_threadsafe(workspace.tabs.arrive, client)

    @panels.on_client_disconnect
    async def _(client: viser.ClientHandle) -> None:
        loop.call_soon_threadsafe(workspace.tabs.leave, client)


async def _healthz(_request: Request) -> Response:
    return PlainTextResponse("ok")
