"""Fairyring's own files for the browser, at addresses that change whenever one of them does.

All share one version, a hash of every name and content. So modules, workers and style sheets find each
other by relative addresses, and a browser keeps them all until there is another version.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath
from posixpath import normpath

from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response

from fairyring.app.gateway.compressed import FOR_EVER, compressed
from fairyring.app.static_folder import STATIC

MEDIA_TYPES = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".html": "text/html"}

_IMPORT = re.compile(r'^(?:import|export)\b[^"();]*?\bfrom\s*"([^"]+)"|^import\s*"([^"]+)"', re.MULTILINE)


@dataclass(frozen=True, eq=False)
class StaticFiles:
    """Everything below ``static``, as it was on the disk at one moment."""

    contents: Mapping[str, bytes]
    """By path below ``static``, with forward slashes."""
    version: str

    def url(self, path: str) -> str:
        """Where the browser finds a file."""
        return f"/static/{self.version}/{path}"

    def imported_by(self, path: str) -> list[str]:
        """The modules that a module imports, directly or by way of others, nearest first."""
        found = [path]
        for module in found:
            imports = _IMPORT.findall(self.contents[module].decode())
            named = (normpath(PurePosixPath(module).parent / (name or bare)) for name, bare in imports)
            found += dict.fromkeys(each for each in named if each in self.contents and each not in found)
        return found[1:]


def static_files() -> StaticFiles:
    """The files as they are now; read again only if one has changed."""
    paths = sorted(path for path in STATIC.rglob("*") if path.is_file())
    return _read(tuple((path, path.stat().st_mtime_ns, path.stat().st_size) for path in paths))


def files_of(version: str) -> StaticFiles:
    """Those of the version read last without a look at the disk, for any other version those of now."""
    return _READ_LAST.get(version) or static_files()


_READ_LAST: dict[str, StaticFiles] = {}


@lru_cache(maxsize=1)
def _read(stamps: tuple[tuple[Path, int, int], ...]) -> StaticFiles:
    contents = {path.relative_to(STATIC).as_posix(): path.read_bytes() for path, *_ in stamps}
    files = StaticFiles(contents, version_of(contents))
    _READ_LAST.clear()
    _READ_LAST[files.version] = files
    return files


def version_of(contents: Mapping[str, bytes]) -> str:
    """A hash of names and contents, fit for an address."""
    each = (f"{name} {hashlib.sha256(content).hexdigest()}\n" for name, content in contents.items())
    return hashlib.sha256("".join(each).encode()).hexdigest()[:16]


def static_file(request: Request) -> Response:
    """GET /static/VERSION/PATH. A page of an older version gets what there is now, to be asked for again."""
    path, version = request.path_params["path"], request.path_params["version"]
    files = files_of(version)
    if path not in files.contents:
        return PlainTextResponse("There is no such file.", status_code=404)
    current = version == files.version
    return compressed(
        request,
        files.contents[path],
        media_type=media_type_of(path),
        cache_control=FOR_EVER if current else "no-cache",
    )


def media_type_of(path: str) -> str:
    """Of a file, by its ending."""
    return MEDIA_TYPES.get(PurePosixPath(path).suffix, "application/octet-stream")
