"""What a person can do in the editor by key or button, and the layers of its picture: names, words, keys.

They are declared once, in ``static/editor/commands.js``, for the keyboard, the key list and the panel.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
from msgspec import Struct, structs

_FILE = Path(__file__).resolve().parents[1] / "static" / "editor" / "commands.js"


class Worded(Struct, frozen=True, forbid_unknown_fields=True):
    """What a command does where a second annotator's caps are compared; ``{}`` is what theirs are called."""

    words: str
    label: str


class Command(Struct, frozen=True, forbid_unknown_fields=True):
    """Something that can be done without pointing."""

    name: str
    keys: list[str]
    words: str
    label: str = ""
    """What a button says, where that is not ``words``."""
    hint: str = ""
    """What is said of a tool while it is in hand."""
    second: Worded | None = None

    def beside(self, second: str | None) -> Command:
        """The command as it is worded while photos are compared with this second annotator's version."""
        if second is None or self.second is None:
            return self
        words = self.second.words.replace("{}", second)
        return structs.replace(self, words=words, label=self.second.label)

    @property
    def title(self) -> str:
        """What it does, and the first of the keys that do the same, if there are any."""
        return f"{self.words} ({self.keys[0]})" if self.keys else self.words


class Layer(Struct, frozen=True, forbid_unknown_fields=True):
    """Part of the picture that can be hidden."""

    name: str
    key: str
    words: str
    shown: bool
    """In a new tab."""


class _Group(Struct, frozen=True, forbid_unknown_fields=True):
    title: str
    commands: list[Command]


class _Declared(Struct, frozen=True):
    groups: list[_Group]
    layers: list[Layer]


def _declared() -> _Declared:
    """The data of the JavaScript module, which is JSON after ``export default``."""
    _, _, data = _FILE.read_text(encoding="utf-8").partition("export default")
    return msgspec.json.decode(data.strip().removesuffix(";"), type=_Declared)


_DECLARED = _declared()

COMMANDS = {command.name: command for group in _DECLARED.groups for command in group.commands}
"""By name."""
LAYERS = {layer.name: layer for layer in _DECLARED.layers}
"""By name, in the order of their keys."""
