"""Inputs that nobody means: good ones, changed by chance, as values or as bytes."""

from __future__ import annotations

import json
import math
import random
from copy import deepcopy
from typing import Any

VALUES: list[Any] = [
    *(None, True, False, 0, -1, 1, 0.5, 2**31, 2**53 + 1, 2**63, -(2**63) - 1, 10**400, 1e308, -1e-320),
    *(math.nan, math.inf, -math.inf),
    *(
        "",
        "a",
        "\0",
        "\ud800",
        "a\nb",
        "\u202e",
        "é",
        "../../etc/passwd",
        "C:\\x",
        "x" * 3000,
        "1",
        "1.0",
        "NaN",
    ),
    *([], {}, [[]], [[], []], [5], [[5]], [None], {"a": None}, [[1, 2, 3, 4]], [[0] * 6], [1e9] * 8),
    *({"size": [10, 10], "counts": "0"}, {"size": [2**20, 2**20], "counts": [0, 2**40]}, {"counts": []}),
]
"""JSON values that break what does not expect them."""
DEEP = "a list in a list in a list"
"""Stands for a value that Python's own JSON would not write."""
DEPTH = 50_000


def changed(value: Any, chance: random.Random, *, times: int = 1) -> Any:
    """A copy of a JSON value with some places changed: replaced, left out, doubled, moved or wrapped."""
    value = json.loads(json.dumps(value))
    for _ in range(times):
        places = list(_places(value))
        if not places:
            return deepcopy(chance.choice(VALUES))
        holder, key = chance.choice(places)
        _change(holder, key, chance)
    return value


def text_of(value: Any, *, ascii_only: bool = True) -> bytes:
    """The JSON of a value; half characters come out as such."""
    text = json.dumps(value, ensure_ascii=ascii_only).replace(f'"{DEEP}"', "[" * DEPTH + "]" * DEPTH)
    return text.encode("utf-8", errors="surrogatepass")


def as_text(value: Any, chance: random.Random) -> bytes:
    """The JSON of a value, now and then with bytes flipped, cut off, doubled or in another encoding."""
    text = text_of(value, ascii_only=chance.random() < 0.5)
    what = chance.random()
    if what < 0.8:
        return text
    if what < 0.83:
        return text.decode(errors="replace").encode(chance.choice(["utf-16", "utf-32", "utf-8-sig"]))
    return changed_bytes(text, chance)


def changed_bytes(data: bytes, chance: random.Random) -> bytes:
    """Bytes with a few flipped, a piece left out or doubled, or the end cut off."""
    raw = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        what, at = chance.random(), chance.randrange(len(raw) + 1)
        until = min(len(raw), at + chance.choice([1, 4, 64, 4096]))
        if what < 0.5 and at < len(raw):
            raw[at] = chance.randrange(256)
        elif what < 0.7:
            del raw[at:until]
        elif what < 0.85:
            raw[at:at] = raw[at:until]
        else:
            del raw[at:]
    return bytes(raw)


def _places(value: Any) -> list[tuple[Any, Any]]:
    """Every place in a value, as what holds it and its key there."""
    found: list[tuple[Any, Any]] = []
    waiting = [value]
    while waiting:
        holder = waiting.pop()
        keys = (
            holder.keys()
            if isinstance(holder, dict)
            else range(len(holder))
            if isinstance(holder, list)
            else ()
        )
        for key in list(keys):
            found.append((holder, key))
            waiting.append(holder[key])
    return found


def _change(holder: Any, key: Any, chance: random.Random) -> None:
    old, what = holder[key], chance.random()
    if what < 0.55:
        holder[key] = deepcopy(chance.choice(VALUES))
    elif what < 0.65:
        del holder[key]
    elif what < 0.7:
        holder[key] = [old]
    elif what < 0.75 and isinstance(old, list):
        holder[key] = old * chance.choice([2, 50])
    elif what < 0.85 and isinstance(old, int | float) and abs(old) < 1e300:
        holder[key] = chance.choice([-old, old * 1e6, old + 0.5, str(old), bool(old)])
    elif what < 0.86:
        holder[key] = DEEP
    elif isinstance(holder, dict):
        holder[chance.choice(["id", "mark", "extra", "\ud800", "light", "size"])] = deepcopy(
            chance.choice(VALUES)
        )
    else:
        holder.insert(0, deepcopy(chance.choice(VALUES)))
