"""Where the browser's files lie, and how they are served."""

from __future__ import annotations

import os
from pathlib import Path

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

_APP = Path(__file__).resolve().parent.parent
STATIC = next(folder for folder in (_APP / "static", _APP.parent / "static") if folder.is_dir())
"""Inside the package where it was installed from a wheel, beside it in a checkout."""


class EditorFiles(StaticFiles):
    """The editor's modules: never stale, as their names carry no version, and cheap to revalidate."""

    def __init__(self) -> None:
        super().__init__(directory=STATIC)

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = "no-cache"
        return response
