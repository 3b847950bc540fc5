"""Writes TOML files with comments, atomically."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from tuisim.atomic import replacing
from tuisim.errors import ConfigError

Scalar = str | bool | int | float | list[str] | list[float]

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_key(key: str) -> str:
    """Return a key in TOML syntax."""
    return key if _BARE.fullmatch(key) else toml_value(key)


def toml_value(value: Scalar) -> str:
    """Return a value in TOML syntax; numbers round-trip exactly."""
    match value:
        case bool():
            return str(value).lower()
        case str():
            # TOML has all escapes of JSON, and requires one more character to be escaped.
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case list():
            return f"[{', '.join(map(toml_value, value))}]"
        case float() if value.is_integer() and abs(value) < 1e15:
            return f"{value:.1f}"
        case _:
            return repr(value)


def toml_lines(values: Mapping[str, Scalar], comments: Mapping[str, str] = MappingProxyType({})) -> list[str]:
    """Return the lines of one table, with their comments, aligned."""
    pairs = [(f"{toml_key(key)} = {toml_value(value)}", comments.get(key, "")) for key, value in values.items()]
    width = max((len(pair) for pair, comment in pairs if comment and len(pair) <= 36), default=0)
    return [f"{pair:<{width}}  # {comment}" if comment else pair for pair, comment in pairs]


def write_toml(path: Path, lines: Iterable[str], error: type[ConfigError], *, owner_only: bool = False) -> None:
    """Write a TOML file atomically.

    Raises:
        ConfigError: of the class `error`: it cannot be written; an existing file is unchanged.
    """
    try:
        if path.suffix != ".toml":
            raise error("must end in .toml", file=str(path))
        with replacing(path, owner_only=owner_only) as stream:
            stream.write(("\n".join(lines) + "\n").encode())
    except (OSError, ValueError) as reason:
        message = f"cannot be written: {getattr(reason, 'strerror', None) or reason}"
        raise error(message, file=str(path)) from None
