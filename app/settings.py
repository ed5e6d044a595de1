"""Settings of ``fairyring serve``: defaults < the project's fairyring.toml < environment < options."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Struct

from fairyring.model.errors import FairyringError
from fairyring.storage.folder import SETTINGS

ENVIRONMENT_PREFIX = "FAIRYRING_"
TABLE = "serve"
"""The table of fairyring.toml that is read here; the others belong to the store."""


class SettingsError(FairyringError):
    """A setting has a name or a value that is not understood."""


class Settings(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The settings, each with its default."""

    host: str = "127.0.0.1"
    port: int = 8080
    token: bool = True
    """Whether only browsers are let in that open the address which the server printed."""
    photo_cache_mb: int = 1024
    """Most megabytes of converted photos in the project's cache folder."""
    message_limit_mb: int = 16
    """Megabytes of the largest message an editor may send."""
    look_ahead: bool = True
    """Whether the network looks at a photo as soon as somebody stays on it, so that Point answers at once."""


def load_settings(
    project_folder: Path,
    *,
    file: Path | None = None,
    environment: Mapping[str, str] = os.environ,
    **options: Any,
) -> Settings:
    """Settings of a project; ``file`` stands in for its fairyring.toml, None is no option.

    Raises SettingsError for an unknown name or a value of the wrong kind, with the place it came from.
    """
    if file is not None and not file.exists():
        raise SettingsError(f"{file} does not exist; give a TOML file.")
    file = file or project_folder / SETTINGS
    sources = (
        (str(file), _from_file(file)),
        *((variable, {name: environment[variable]}) for variable, name in _variables(environment).items()),
        ("the command line", {name: value for name, value in options.items() if value is not None}),
    )
    values: dict[str, Any] = {}
    for place, found in sources:
        try:
            checked = msgspec.convert(found, Settings, strict=False)
        except msgspec.ValidationError as error:
            raise SettingsError(f"A setting in {place} is not understood: {error}.") from None
        values |= {name: getattr(checked, name) for name in found}
    return Settings(**values)


def _from_file(file: Path) -> dict[str, Any]:
    if not file.exists():
        return {}
    try:
        return tomllib.loads(file.read_text(encoding="utf-8")).get(TABLE, {})
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SettingsError(f"{file} is not valid TOML ({error}); correct or restore it.") from None


def _variables(environment: Mapping[str, str]) -> dict[str, str]:
    """The settings that are in the environment, by the names of their variables."""
    known = {f"{ENVIRONMENT_PREFIX}{name.upper()}": name for name in Settings.__struct_fields__}
    return {variable: name for variable, name in known.items() if variable in environment}
