"""Reads configuration files; every error names file and key.

Files are not trusted: size, depth and types are checked before their values are used.
"""

from __future__ import annotations

import math
import os
import reprlib
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from tuisim.config.options import nearest
from tuisim.errors import ConfigError

Value = TypeVar("Value")

MAX_FILE_BYTES = 1_000_000
MAX_LINE = 1000
"""Longest line of a TOML file: a key of many thousand parts would take the parser hours."""

MAX_NAME = 100
FILE_SUFFIXES = (".toml", ".json")

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 60


def shown(value: object) -> str:
    """Return the `repr` of a value for messages, shortened."""
    if isinstance(value, bool):
        return str(value).lower()
    return _SHORT.repr(value)


def means_file(word: str) -> bool:
    """Return whether a word names a file, not a preset."""
    return os.sep in word or Path(word).suffix.lower() in FILE_SUFFIXES


def name_of(path: Path) -> str:
    """Return the default name of the object in a file, from the file name."""
    return "".join(letter if letter.isprintable() else "_" for letter in path.stem)[:MAX_NAME] or "unnamed"


def with_location(error: ConfigError, file: str, key: str) -> ConfigError:
    """Return the same error with another file and key as its location."""
    where = ": ".join(part for part in (error.file, error.key) if part)
    message = error.message.removeprefix(f"{where}: ") if where else error.message
    return type(error)(message, error.hint, file=file, key=key)


@contextmanager
def errors_at(file: str, prefix: str = "") -> Iterator[None]:
    """Add a file to ConfigErrors that are raised in the block without one."""
    try:
        yield
    except ConfigError as error:
        if error.file:
            raise
        raise with_location(error, file, ".".join(part for part in (prefix, error.key) if part)) from None


def read_file(path: Path, error: type[ConfigError]) -> Any:
    """Read a TOML or JSON file and return its data.

    Raises:
        ConfigError: of the class `error`: the file is missing, not a regular file, too large, not text, empty or
            not valid TOML or JSON.
    """
    shown_path = str(path)
    suffix = path.suffix.lower()
    if suffix not in FILE_SUFFIXES:
        raise error("is neither a .toml nor a .json file", "the suffix selects the format", file=shown_path)
    text = _text(path, error)
    if suffix == ".json":
        return _json(text, shown_path, error)
    return parse_toml(text, shown_path, error)


def _text(path: Path, error: type[ConfigError]) -> str:
    file = str(path)
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise error("is a folder, not a file", file=file)
        # Reading from a device or a pipe may never end.
        if not stat.S_ISREG(mode):
            raise error("is not a regular file", file=file)
        with path.open("rb") as stream:
            data = stream.read(MAX_FILE_BYTES + 1)
    except FileNotFoundError:
        raise error("there is no such file", _neighbours(path), file=file) from None
    except (OSError, ValueError) as reason:
        raise error(f"cannot be read: {getattr(reason, 'strerror', None) or reason}", file=file) from None
    if len(data) > MAX_FILE_BYTES:
        raise error("is too large", f"at most {MAX_FILE_BYTES:,} bytes".replace(",", " "), file=file)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        line = data.count(b"\n", 0, reason.start) + 1
        raise error(f"line {line} is not UTF-8 text", "save it as UTF-8", file=file) from None
    if not text.strip():
        raise error("is empty", file=file)
    return text


def _neighbours(path: Path) -> str:
    """Return the hint for a missing file: files beside it with similar names."""
    import difflib

    try:
        beside = [other.name for other in path.parent.iterdir() if other.suffix.lower() in FILE_SUFFIXES]
    except (OSError, ValueError):
        return ""
    close = difflib.get_close_matches(path.name, beside, 3)
    return f"did you mean {' or '.join(close)}?" if close else ""


def parse_toml(text: str, file: str, error: type[ConfigError]) -> Any:
    """Parse a TOML text and return its data.

    Raises:
        ConfigError: of the class `error`: it is not valid TOML, or is nested too deeply.
    """
    import tomllib

    for number, line in enumerate(text.split("\n"), start=1):
        if len(line) > MAX_LINE:
            raise error(f"line {number} is too long", f"at most {MAX_LINE} characters", file=file)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise error("is nested too deeply", file=file) from None
    except ValueError as reason:
        raise error(f"is not TOML: {reason}", file=file) from None


def _json(text: str, file: str, error: type[ConfigError]) -> Any:
    import json

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in pairs:
            if key in found:
                raise error("is given twice", file=file, key=shown(key)[1:-1])
            found[key] = value
        return found

    try:
        return json.loads(text, object_pairs_hook=unique)
    except RecursionError:
        raise error("is nested too deeply", file=file) from None
    except ValueError as reason:
        raise error(f"is not JSON: {reason}", file=file) from None


class Section:
    """One table of a file, read key by key.

    Args:
        data: The data of the table; anything but a dict raises `error`.
        file: The file, for errors.
        error: The class of errors about it.
        key: The path of the table in the file; empty for the top level.
    """

    def __init__(self, data: object, file: str, error: type[ConfigError], key: str = "") -> None:
        self.file = file
        self.key = key
        self._error = error
        if not isinstance(data, dict):
            raise error(f"must be a table of keys and values, got {shown(data)}", file=file, key=key)
        self._data: Mapping[str, object] = data

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def wrong(self, key: str, message: str, hint: str = "") -> ConfigError:
        """Return an error about one key of this table, to be raised."""
        return self._error(message, hint, file=self.file, key=self._path(key))

    def instead(self, data: object) -> Section:
        """Return a section with other data at the same location."""
        return Section(data, self.file, self._error, self.key)

    def allow(self, keys: Iterable[str], unlisted: Iterable[str] = ()) -> None:
        """Raise unless every key is in `keys`, or in `unlisted`, which the hint omits."""
        known = list(keys)
        for key in self._data:
            if key not in known and key not in unlisted:
                raise self.wrong(shown(key)[1:-1], "no such key", nearest(key[:MAX_NAME], known))

    def raw(self, key: str) -> object:
        """Return an unchecked value; raise if the key is missing."""
        if key not in self._data:
            raise self.wrong(key, "is missing")
        return self._data[key]

    def number(self, key: str, low: float = -math.inf, high: float = math.inf) -> float:
        """Return a finite number; raise if it is out of range."""
        value = self.raw(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(_float(value)):
            raise self.wrong(key, f"must be a number, got {shown(value)}")
        if not low <= value <= high:
            raise self.wrong(key, f"must be a number from {low:g} to {high:g}, got {shown(value)}")
        return float(value)

    def whole(self, key: str, low: int, high: int) -> int:
        """Return an integer; raise if it is out of range."""
        value = self.raw(key)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.wrong(key, f"must be a whole number, got {shown(value)}")
        if not low <= value <= high:
            raise self.wrong(key, f"must be a whole number from {low} to {high}, got {shown(value)}")
        return value

    def text(self, key: str) -> str:
        """Return a non-empty line of text."""
        value = self.raw(key)
        if not isinstance(value, str):
            raise self.wrong(key, f"must be text, got {shown(value)}")
        if not value.strip() or len(value) > MAX_LINE or not value.isprintable():
            raise self.wrong(key, f"must be one line of text, got {shown(value)}")
        return value

    def flag(self, key: str) -> bool:
        """Return a boolean."""
        value = self.raw(key)
        if not isinstance(value, bool):
            raise self.wrong(key, f"must be true or false, got {shown(value)}")
        return value

    def one_of(self, key: str, allowed: Iterable[str]) -> str:
        """Return a text that must be one of `allowed`."""
        value, words = self.text(key), list(allowed)
        if value not in words:
            raise self.wrong(key, f"no such value {shown(value)}", f"one of {', '.join(words)}")
        return value

    def converted(self, key: str, convert: Callable[[str, str], Value]) -> Value:
        """Return a text converted by the converter of a command-line switch."""
        value = self.text(key)
        try:
            return convert(value, "")
        except ConfigError as error:
            raise self.wrong(key, error.message, error.hint) from None

    def items(self, key: str) -> list[object]:
        """Return a list."""
        value = self.raw(key)
        if not isinstance(value, list):
            raise self.wrong(key, f"must be a list, got {shown(value)}")
        return value

    def section(self, key: str, error: type[ConfigError] | None = None) -> Section:
        """Return a nested table; errors about it are of the class `error`."""
        return Section(self.raw(key), self.file, error or self._error, self._path(key))

    def entries(self, key: str, error: type[ConfigError] | None = None) -> list[Section]:
        """Return the tables in a list; in errors the first is `key[1]`."""
        path, found = self._path(key), self.items(key)
        return [
            Section(entry, self.file, error or self._error, f"{path}[{at}]") for at, entry in enumerate(found, start=1)
        ]

    @contextmanager
    def telling(self, prefix: str | None = None) -> Iterator[None]:
        """Add this table's file and key (or `prefix`) to ConfigErrors raised in the block without a file."""
        with errors_at(self.file, self.key if prefix is None else prefix):
            yield

    def _path(self, key: str) -> str:
        return f"{self.key}.{key}" if self.key else key


def _float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf
