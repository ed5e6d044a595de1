"""Column types: JSON text checked by msgspec, booleans and reals that SQLite's STRICT tables allow."""

from __future__ import annotations

from typing import Any

import msgspec
from sqlalchemy import REAL, Dialect, Double, Integer, Text
from sqlalchemy.types import TypeDecorator, TypeEngine
from typing_extensions import override

Real: TypeEngine[float] = Double().with_variant(REAL(), "sqlite")


class Json(TypeDecorator[Any]):
    """JSON text of one Python type."""

    impl = Text
    cache_ok = True

    def __init__(self, kind: Any) -> None:
        super().__init__()
        self.kind = kind
        self._decoder = msgspec.json.Decoder(kind)

    @override
    def process_bind_param(self, value: Any, dialect: Dialect) -> str | None:
        return None if value is None else msgspec.json.encode(value).decode()

    @override
    def process_result_value(self, value: str | None, dialect: Dialect) -> Any:
        return None if value is None else self._decoder.decode(value)


class Flag(TypeDecorator[bool]):
    """True or false as 1 or 0."""

    impl = Integer
    cache_ok = True

    @override
    def process_bind_param(self, value: bool | None, dialect: Dialect) -> int | None:
        return None if value is None else int(value)

    @override
    def process_result_value(self, value: int | None, dialect: Dialect) -> bool | None:
        return None if value is None else bool(value)
