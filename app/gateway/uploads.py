"""Photos that people drop onto the page: received one by one, and imported as files are."""

from __future__ import annotations

import shutil
import uuid
from collections.abc import Awaitable, Callable
from pathlib import Path
from urllib.parse import unquote

import anyio
import anyio.to_thread
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, PlainTextResponse, Response

from fairyring.app.gateway.login import name_of
from fairyring.app.live.opening import reopen
from fairyring.app.live.workspace import Workspace
from fairyring.model.errors import FairyringError
from fairyring.storage.choices import ImportFormat
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.project import Project

FOLDER, FILE_NAME = "uploads", "x-file-name"
LARGEST = 512 * 2**20
"""Most bytes of a photo."""
LONGEST_NAME = 200


def uploads_of(workspace: Workspace) -> Callable[[Request], Awaitable[Response]]:
    """The endpoint of `UPLOADS`: POST with a photo as its body and its name, escaped, as a header.

    Answers ``{"added": 1}``, or 0 for a photo that the project has already; else says why not.
    """
    one_at_a_time = anyio.CapacityLimiter(1)

    async def uploads(request: Request) -> Response:
        user = name_of(request)
        if user is None:
            return PlainTextResponse("Open the page first and say your name.", status_code=401)
        name = file_name_of(request.headers.get(FILE_NAME, ""))
        if name is None:
            return PlainTextResponse("This is no name of a photo.", status_code=422)
        folder = workspace.project.cache / FOLDER / uuid.uuid4().hex
        await anyio.to_thread.run_sync(lambda: folder.mkdir(parents=True))
        try:
            if not await _received(request, folder / name):
                return PlainTextResponse(f"{name} is larger than {LARGEST // 2**20} MB.", status_code=413)
            added = await anyio.to_thread.run_sync(
                _import, workspace.project, folder / name, user, limiter=one_at_a_time
            )
        except ClientDisconnect:
            return PlainTextResponse("The photo broke off.", status_code=400)
        except FairyringError as error:
            return PlainTextResponse(_without(folder, str(error)), status_code=422)
        finally:
            await anyio.to_thread.run_sync(lambda: shutil.rmtree(folder, ignore_errors=True))
        await _show(workspace)
        return JSONResponse({"added": added})

    return uploads


def file_name_of(header: str) -> str | None:
    """The base name in a header, if files may be called so; else None."""
    name = unquote(header).replace("\\", "/").rsplit("/", 1)[-1].strip()
    usable = name.isprintable() and not name.startswith(".") and 0 < len(name.encode()) <= LONGEST_NAME
    return name if usable else None


async def _received(request: Request, file: Path) -> bool:
    """Writes the body to a file; False where it is too large."""
    size = 0
    async with await anyio.open_file(file, "wb") as opened:
        async for chunk in request.stream():
            size += len(chunk)
            if size > LARGEST:
                return False
            await opened.write(chunk)
    return True


def _import(project: Project, file: Path, user: str) -> int:
    report = import_paths(project, [file], kind=ImportFormat.images, user=user)
    if report.problems and not report.images:
        raise FairyringError(str(report.problems[0]))
    return report.images


def _without(folder: Path, sentence: str) -> str:
    """What went wrong, without where this server keeps its files."""
    return sentence.replace(f"{folder}/", "")


async def _show(workspace: Workspace) -> None:
    """Has every list follow; tabs that have nothing on screen show the first photo."""
    for tab in workspace.tabs:
        if tab.has_panel and tab.image is None and tab.outbox is not None:
            await reopen(workspace, tab, None)
    workspace.refresh("images", "predict")
