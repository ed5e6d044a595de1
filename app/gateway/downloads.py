"""Downloads: the data sets that export jobs have made."""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable

from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response

from fairyring.app.gateway.login import name_of
from fairyring.app.jobs.exports import exports_folder
from fairyring.storage.project import Project

_MADE_HERE = re.compile(r"[0-9a-f]{32}\.zip")


def downloads_of(project: Project) -> Callable[[Request], Awaitable[Response]]:
    """The endpoint of `DOWNLOADS`; only names that an export has chosen itself are looked for."""

    async def downloads(request: Request) -> Response:
        if name_of(request) is None:
            return PlainTextResponse("Open the page first and say your name.", status_code=401)
        name = request.path_params["name"]
        file = exports_folder(project) / name
        if not _MADE_HERE.fullmatch(name) or not file.is_file():
            return PlainTextResponse("This export is gone; make it again.", status_code=404)
        shown = f"{project.name}-coco.zip"
        return FileResponse(file, filename=shown, headers={"Cache-Control": "no-store"})

    return downloads
