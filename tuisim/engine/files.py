"""Configuration files: read, converted to typed data, and written; every error names file and key.

Files are not trusted: size, depth and types are checked before their values are used.
"""

from __future__ import annotations

import json
import math
import os
import re
import stat
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import MISSING, replace
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, closest, did_you_mean, nearest
from tuisim.base.folders import user_path
from tuisim.engine.core.spec_fields import Spec
from tuisim.engine.core.values import NamedNumber, NamedPart, Value, WrongValue, list_values, quote

if TYPE_CHECKING:
    from msgspec import inspect as types

_Kind = TypeVar("_Kind")
_Spec = TypeVar("_Spec", bound=Spec)

MAX_FILE_BYTES = 1_000_000
MAX_LINE = 1000
"""Most characters of a line in a TOML file; longer lines are refused, because a key of many thousand parts would take
the parser hours."""

MAX_NAME = 100
MAX_WHOLE = 2**63
"""Integers of a file beyond ± this value are refused: no key has a use for them."""
FILE_SUFFIXES = (".toml", ".json")


@dataclass(frozen=True, slots=True)
class Location:
    """The location of a value in a file, for errors about the value."""

    file: str
    error: type[ConfigError] = ConfigError
    key: str = ""
    """The path of the value in the file, such as `ultrasonic.x_mm` or `obstacle[1]`; empty for the top level."""

    def at(self, key: str, error: type[ConfigError] | None = None) -> Location:
        """Return the location of a key's value in the table, or list, at this location.

        Args:
            key: The key; for a list the index in brackets, such as `[1]`.
            error: The class of errors about the value; None for the class that this location has.
        """
        joint = "." if self.key and not key.startswith("[") else ""
        return replace(self, key=f"{self.key}{joint}{key}", error=error or self.error)

    def wrong(self, message: str, hint: str = "") -> ConfigError:
        """Return an error about the value at this location; the caller raises it."""
        return self.error(message, hint, file=self.file, key=self.key)


def means_file(word: str) -> bool:
    """Return whether a word names a file, not a preset."""
    return os.sep in word or Path(word).suffix.lower() in FILE_SUFFIXES


def read_named(
    word: str,
    what: str,
    known: Iterable[str],
    error: type[ConfigError],
    key: str,
    kinds: Sequence[str] = FILE_SUFFIXES,
) -> tuple[Any, str, Location]:
    """Read the file that a word names; return its data, the default name of the object in it, and its location.

    Args:
        word: The word that the user gave. The caller has checked that it is not the name of a preset.
        what: What the word should name, such as `robot`, for errors.
        known: The names of the presets, for errors.
        error: The class of errors.
        key: The option that gives the word, for errors.
        kinds: The suffixes that the file may have.

    Raises:
        ConfigError: of the class `error`: the word names no file, or `read_file` cannot read the file.
    """
    if not means_file(word):
        raise error(
            f"no such {what} {word!r}",
            nearest(word, [*known, f"or a {' or '.join(kinds)} file"]),
            key=key,
        )
    path = user_path(word)
    if len(kinds) == 1 and path.suffix.lower() not in kinds:
        raise error(f"is not a {kinds[0]} file", "the suffix selects the format", file=str(path))
    return read_file(path, error), name_of(path), Location(str(path), error)


def name_of(path: Path) -> str:
    """Return the default name of the object in a file: the file's name without suffix, shortened and made printable."""
    return (
        "".join(letter if letter.isprintable() else "_" for letter in path.stem)[:MAX_NAME]
        or "unnamed"
    )


def with_location(error: ConfigError, file: str, key: str) -> ConfigError:
    """Return the same error with another file and key as its location."""
    where = ": ".join(part for part in (error.file, error.key) if part)
    message = error.message.removeprefix(f"{where}: ") if where else error.message
    return type(error)(message, error.hint, file=file, key=key)


@contextmanager
def errors_at(file: str, prefix: str = "") -> Iterator[None]:
    """In a `with` block, add a file and the key of a table to each ConfigError that names no file.

    Args:
        file: The file.
        prefix: The key of the table, which is put before the key in the error; empty for the whole file.
    """
    try:
        yield
    except ConfigError as error:
        if error.file:
            raise
        raise with_location(error, file, ".".join(filter(None, (prefix, error.key)))) from None


def read_file(path: Path, error: type[ConfigError]) -> Any:
    """Read a TOML or JSON file and return its data.

    Raises:
        ConfigError: of the class `error`: the file is missing, not a regular file, too large, not text, empty or not
            valid TOML or JSON.
    """
    shown_path = str(path)
    suffix = path.suffix.lower()
    if suffix not in FILE_SUFFIXES:
        raise error(
            "is neither a .toml nor a .json file", "the suffix selects the format", file=shown_path
        )
    text = _text(path, error)
    if not text.strip():
        raise error("is empty", file=shown_path)
    if suffix == ".json":
        return _json(text, shown_path, error)
    return parse_toml(text, shown_path, error)


def read_bytes(
    path: Path,
    most_bytes: int,
    error: type[ConfigError],
    missing: str = "there is no such file",
    folder: str = "is a folder, not a file",
    hint: str = "",
    neighbours: Callable[[Path], str] = lambda _: "",
) -> bytes:
    """Return the bytes of a regular file; of a file larger than `most_bytes`, only the first `most_bytes` + 1.

    Args:
        missing, folder: The message if there is no such file, or if it is a folder.
        hint: What is allowed instead of a folder or a device.
        neighbours: Returns the hint for a missing file.

    Raises:
        ConfigError: of the class `error`: the file is missing, not a regular file, or cannot be read.
    """
    file = str(path)
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise error(folder, hint, file=file)
        # Reading from a device or a pipe may never end.
        if not stat.S_ISREG(mode):
            raise error("is not a regular file", hint, file=file)
        with path.open("rb") as stream:
            return stream.read(most_bytes + 1)
    except (FileNotFoundError, NotADirectoryError):
        raise error(missing, neighbours(path), file=file) from None
    except (OSError, ValueError) as reason:
        raise error(
            f"cannot be read: {getattr(reason, 'strerror', None) or reason}", file=file
        ) from reason


def _text(path: Path, error: type[ConfigError]) -> str:
    file = str(path)
    data = read_bytes(
        path,
        MAX_FILE_BYTES,
        error,
        neighbours=lambda missing: did_you_mean(close_beside(missing, FILE_SUFFIXES)),
    )
    if len(data) > MAX_FILE_BYTES:
        raise error(
            "is too large", f"at most {MAX_FILE_BYTES:,} bytes".replace(",", " "), file=file
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        line = data.count(b"\n", 0, reason.start) + 1
        raise error(f"line {line} is not UTF-8 text", "save it as UTF-8", file=file) from None


def close_beside(path: Path, suffixes: Collection[str]) -> list[str]:
    """Return the names of files that are similar to the name of a missing file, and in the same folder.

    The names are compared without their suffixes.

    Args:
        path: The missing file.
        suffixes: Only files with one of these suffixes are returned.
    """
    try:
        beside = sorted(
            other for other in path.parent.iterdir() if other.suffix.lower() in suffixes
        )
    except (OSError, ValueError):
        return []
    close = closest(path.stem, [other.stem for other in beside])
    return [other.name for stem in close for other in beside if other.stem == stem]


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
    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        entries: dict[str, Any] = {}
        for key, value in pairs:
            if key in entries:
                raise error("is given twice", file=file, key=quote(key)[1:-1])
            entries[key] = value
        return entries

    try:
        return json.loads(text, object_pairs_hook=unique)
    except RecursionError:
        raise error("is nested too deeply", file=file) from None
    except ValueError as reason:
        raise error(f"is not JSON: {reason}", file=file) from None


def table(
    data: object, at: Location, keys: Iterable[str] | None = None, unlisted: Collection[str] = ()
) -> Any:
    """Return the data of a file as a dict, after checking that it is a table with allowed keys.

    Args:
        data: The data.
        at: Its location, for errors.
        keys: The keys that it may have; None for any.
        unlisted: Further keys, which hints omit.

    Raises:
        ConfigError: it is not a table, or has another key.
    """
    if not isinstance(data, dict):
        raise at.wrong(f"must be {_TABLE}, got {quote(data)}")
    if keys is not None:
        known = list(keys)
        for key in data:
            if key not in known and key not in unlisted:
                raise at.at(quote(key)[1:-1]).wrong("no such key", nearest(key[:MAX_NAME], known))
    return data


def required(data: Mapping[str, object], key: str, at: Location) -> object:
    """Return the value of a key in a table.

    Raises:
        ConfigError: the key is missing.
    """
    if key not in data:
        raise at.at(key).wrong("is missing")
    return data[key]


def entries(data: object, at: Location, most: int, what: str) -> list[tuple[object, Location]]:
    """Return the entries of a list, each with its location, such as `key[1]` for the first one.

    Args:
        data: The list, from a file.
        at: Its location.
        most: How many entries it may have.
        what: What the entries are, in the plural, for errors.

    Raises:
        ConfigError: the data is not a list, or has more than `most` entries.
    """
    if not isinstance(data, list):
        raise at.wrong(f"must be a list, got {quote(data)}")
    if len(data) > most:
        raise at.wrong(f"has {len(data)} {what}", f"at most {most}")
    return [(entry, at.at(f"[{number}]")) for number, entry in enumerate(data, start=1)]


def one_of(data: object, at: Location, allowed: Iterable[str]) -> str:
    """Return data that must be one of the texts `allowed`.

    Raises:
        ConfigError: it is another text, or not a text.
    """
    word = convert(data, str, at)
    words = list(allowed)
    if word not in words:
        raise at.wrong(f"no such value {quote(word)}", f"one of {', '.join(words)}")
    return word


def read_value(data: object, value: Value, at: Location) -> Any:
    """Return a value from the data of a file, after checking and converting it.

    Args:
        data: The data.
        value: The description of the value, which says what is allowed.
        at: The location of the data, for errors.

    Raises:
        ConfigError: the data is not allowed for this value.
    """
    try:
        return value.parse_data(data)
    except WrongValue as error:
        raise (at.at(error.part) if error.part else at).wrong(error.message, error.hint) from None


def read_part(data: object, base: _Spec | type[_Spec], at: Location, **given: object) -> _Spec:
    """Return a sensor, or another part of a run's specification, with the values in a table of a file.

    The table must not contain the name of the part.

    Args:
        data: The table.
        base: The part whose values are used where the table has none; or the class of the part, for its defaults.
        at: The location of the table, for errors.
        given: Values by name that come from the caller, not from the table.

    Raises:
        ConfigError: a key is unknown or missing, or a value is wrong.
    """
    kind = base if isinstance(base, type) else type(base)
    values = {
        key: value for key, value in list_values(kind).items() if key not in given and key != "name"
    }
    given_values = {
        key: read_value(part_value, values[key], at.at(key))
        for key, part_value in table(data, at, values).items()
    }
    if isinstance(base, type):
        for key in values:
            if kind.__dataclass_fields__[key].default is MISSING:
                required(given_values, key, at)
    return with_values(base, given_values | given, at)


def with_values(base: _Spec | type[_Spec], values: Mapping[str, Any], at: Location) -> _Spec:
    """Return a copy of a part of a run's specification, such as a sensor, with some values replaced.

    Args:
        base: The part. If it is a class, the result is a new part of this class.
        values: The values by name.
        at: The location of the values, for errors.

    Raises:
        ConfigError: the values break a rule.
    """
    try:
        return base(**values) if isinstance(base, type) else replace(base, **values)
    except ConfigError as error:
        # Keys in the errors of specs begin with the name of the part, with which `at.key` may already end.
        part = re.sub(r"\[\d+\]$", "", at.key).rpartition(".")[2]
        inner = at.at(error.key.removeprefix(f"{part}.")) if error.key else at
        raise inner.wrong(error.message.removeprefix(f"{error.key}: "), error.hint) from None


def convert(data: object, kind: type[_Kind], at: Location) -> _Kind:
    """Return data of a file as an object of a type: a dataclass, a `msgspec.Struct` or a simple type.

    Args:
        data: The data: tables as dicts, lists, texts, numbers and booleans.
        kind: The type. Numbers must be finite, texts one line.

    Raises:
        ConfigError: a key is missing or unknown, or a value is wrong.
    """
    import msgspec

    converted = dict(_walk(data, _type_info(kind), at))  # type: ignore[arg-type]  # a type is hashable
    try:
        return msgspec.convert(data, kind)
    except ConfigError as error:
        inner = at.at(error.key) if error.key else at
        raise inner.wrong(error.message.removeprefix(f"{error.key}: "), error.hint) from None
    except msgspec.ValidationError as error:
        message, _, path = str(error).partition(" - at `$")
        path = re.sub(
            r"(?<=\[)\d+", lambda index: str(int(index[0]) + 1), path.rstrip("`").lstrip(".")
        )
        where = at.at(path) if path else at
        if missing := re.fullmatch(r"Object missing required field `(\w+)`", message):
            raise where.at(missing[1]).wrong("is missing") from None
        value, info = converted[where.key]
        raise _mismatch(value, info, where) from None


@lru_cache
def _type_info(kind: Any) -> types.Type:
    from msgspec import inspect

    return inspect.type_info(kind)


def _walk(
    data: object, info: types.Type, at: Location
) -> Iterator[tuple[str, tuple[object, types.Type]]]:
    """Yield for each value in the data of a file its key, such as `obstacle[1].x_mm`, and a pair of value and type.

    Args:
        data: The data.
        info: The type that the data must have.
        at: The location of the data.

    Raises:
        ConfigError: a value is wrong in a way that the type cannot express, such as a text of two lines.
    """
    from msgspec import inspect as types

    match info, data:
        case types.UnionType(types=members), _:
            texts = [member for member in members if isinstance(member, types.StrType)]
            for member in texts if texts and isinstance(data, str) else members:
                yield from _walk(data, member, at)
        case types.StructType(fields=inner) | types.DataclassType(fields=inner), dict():
            table(data, at, [field.name for field in inner])
            for field in inner:
                if field.name in data:
                    yield from _walk(data[field.name], field.type, at.at(field.name))
        case types.TupleType(item_types=items), list():
            if len(data) != len(items):
                raise at.wrong(f"must be a list of {len(items)} values, got {quote(data)}")
            for number, (entry, item) in enumerate(zip(data, items, strict=True), start=1):
                yield from _walk(entry, item, at.at(f"[{number}]"))
        case types.ListType(item_type=item) | types.VarTupleType(item_type=item), list() | tuple():
            for number, entry in enumerate(data, start=1):
                yield from _walk(entry, item, at.at(f"[{number}]"))
        case types.StrType(), str() if (
            not data.strip() or len(data) > MAX_LINE or not data.isprintable()
        ):
            raise at.wrong(f"must be one line of text, got {quote(data)}")
        case types.FloatType(), float() if not math.isfinite(data):
            raise _mismatch(data, info, at)
        case types.IntType(), int() if not isinstance(data, bool) and abs(data) > MAX_WHOLE:
            raise _mismatch(data, info, at)
        case types.FloatType() | types.IntType() | types.BoolType(), str():
            # A text is no number. It is refused here, because msgspec fails for texts with half a surrogate pair.
            raise _mismatch(data, info, at)
    yield at.key, (data, info)


def _mismatch(value: object, info: types.Type, at: Location) -> ConfigError:
    from msgspec import inspect as types

    if isinstance(info, types.UnionType):
        kinds = [member for member in info.types if not isinstance(member, types.NoneType)]
        info = kinds[0] if len(kinds) == 1 else info
    if isinstance(info, types.EnumType):
        return at.wrong(
            f"no such value {quote(value)}", f"one of {', '.join(each.value for each in info.cls)}"
        )
    return at.wrong(f"must be {_expected(info)}, got {quote(value)}")


_TABLE = "a table of keys and values"


def _expected(info: types.Type) -> str:
    """Return in words the values that a type allows, such as `a whole number from 0 to 5`."""
    from msgspec import inspect as types

    match info:
        case types.IntType(ge=low, le=high) | types.FloatType(ge=low, le=high):
            whole = isinstance(info, types.IntType)
            what = "a whole number" if whole else "a number"
            if low is None or high is None:
                return what
            return f"{what} from {low} to {high}" if whole else f"{what} from {low:g} to {high:g}"
        case types.StrType():
            return "text"
        case types.BoolType():
            return "true or false"
        case types.ListType() | types.VarTupleType() | types.TupleType():
            return "a list"
        case types.UnionType(types=members):
            # TOML has no null: None stands for a missing key.
            return " or ".join(
                _expected(member) for member in members if not isinstance(member, types.NoneType)
            )
        case _:
            return _TABLE


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
        case _:
            return repr(value)


def toml_lines(
    values: Mapping[str, Scalar], comments: Mapping[str, str] = MappingProxyType({})
) -> list[str]:
    """Return the lines of one table, with aligned comments.

    Args:
        values: The values by key.
        comments: The comments by key; a key without one gets none.
    """
    pairs = [
        (f"{toml_key(key)} = {toml_value(value)}", comments.get(key, ""))
        for key, value in values.items()
    ]
    width = max((len(pair) for pair, comment in pairs if comment and len(pair) <= 36), default=0)
    return [f"{pair:<{width}}  # {comment}" if comment else pair for pair, comment in pairs]


def value_lines(part: Spec, keys: Iterable[str]) -> list[str]:
    """Return some values of a sensor, or of another part, as TOML lines, with the help of each value as a comment.

    Values that are None are left out.

    Args:
        part: The part.
        keys: The names of the values.
    """
    values = list_values(type(part))
    part_values = {key: getattr(part, key) for key in keys}
    shown_values = {
        key: toml_form(values[key], part_value)
        for key, part_value in part_values.items()
        if part_value is not None
    }
    return toml_lines(shown_values, {key: values[key].help for key in part_values})


def toml_form(value: Value, found: Any) -> Scalar:
    """Return a value in the form in which TOML files contain it.

    A value that has a name becomes its name, a tuple becomes a list, and any other value stays unchanged.

    Args:
        value: The description of the value.
        found: The value.
    """
    if isinstance(value, NamedNumber):
        return value.named(found)
    if isinstance(value, NamedPart):
        return value.format_text(found)
    scalar: Scalar = list(found) if isinstance(found, tuple) else found
    return scalar


def save_toml(
    path: Path,
    lines: Iterable[str],
    at: Location,
    read: Callable[[Any], object],
    expected: object,
    *,
    check: Callable[[Any], object] | None = None,
    kept: Collection[str] = (),
    owner_only: bool = False,
) -> None:
    """Write an object to a TOML file atomically. In an existing file the user's comments, layout and order stay.

    Args:
        path: The file.
        lines: The contents of a new file.
        at: The file, for errors.
        read: Returns the object that the data of a TOML file contains.
        expected: The object to write: `read` must return an equal one for the new contents.
        check: Called with the data of an existing file; raises ConfigError if the file may not be changed, because it
            is of another kind. By default, `read` is called.
        kept: Keys of an existing file that stay although `lines` does not have them.
        owner_only: Whether only the owner may read a new file.

    Raises:
        ConfigError: an existing file is of another kind, the file cannot be written, or TOML cannot represent the
            object. An existing file is then unchanged.
    """
    if path.suffix != ".toml":
        raise at.wrong("must end in .toml")
    new = text = "\n".join(lines) + "\n"
    if read(parse_toml(text, at.file, at.error)) != expected:
        raise at.wrong("a file cannot represent this")
    if os.path.isfile(path) and (old := _text(path, at.error)).strip():
        try:
            (check or read)(parse_toml(old, at.file, at.error))
        except ConfigError as error:
            hint = "; ".join(
                filter(None, (error.hint, "correct the file, or save under another name"))
            )
            raise type(error)(error.message, hint) from None
        for whole in (False, True):
            # The order of sensors may matter, so tables may have to be replaced as a whole.
            with suppress(ConfigError):
                text = _updated_text(old, new, kept, whole)
                if read(parse_toml(text, at.file, at.error)) == expected:
                    break
        else:
            raise at.wrong("cannot be updated", "save under another name")
    try:
        with replacing(path, owner_only=owner_only) as stream:
            stream.write(text.encode())
    except (OSError, ValueError) as reason:
        raise at.wrong(
            f"cannot be written: {getattr(reason, 'strerror', None) or reason}"
        ) from None


def _updated_text(old: str, new: str, kept: Collection[str], whole: bool) -> str:
    """Return the TOML text `old` with the values of `new`, but with the comments, layout and order of `old`.

    Args:
        old: The text of the existing file.
        new: The text with the new values.
        kept: Keys of `old` that stay although `new` lacks them.
        whole: Whether tables of `old` are replaced as a whole; otherwise only those of their keys that differ.

    Raises:
        ConfigError: the text cannot be updated.
    """
    import tomlkit
    from tomlkit.exceptions import TOMLKitError

    try:
        document = tomlkit.parse(old)
        _update(document, tomlkit.parse(new), kept, whole)
        return tomlkit.dumps(document)
    except (TOMLKitError, RecursionError, IndexError) as error:
        # tomlkit raises IndexError for a table whose parts are at several places in the file.
        raise ConfigError(f"cannot be updated: {error}") from None


def _update(old: Any, new: Any, kept: Collection[str] = (), whole: bool = False) -> None:
    from tomlkit.items import AoT, InlineTable

    for key in [key for key in old if key not in new and key not in kept]:
        del old[key]
    for key, value in new.items():
        before = old.get(key)
        if not whole and isinstance(before, Mapping) and isinstance(value, Mapping):
            _update(before, value)
        elif not whole and isinstance(before, AoT) and isinstance(value, AoT):
            for before_item, other in zip(before, value, strict=False):
                _update(before_item, other)
            del before[len(value) :]
            for other in value[len(before) :]:
                before.append(other)
        elif (
            before is None or isinstance(before, Mapping | AoT) or isinstance(value, Mapping | AoT)
        ):
            old.pop(key, None)
            # A value in an inline table has no room for a comment.
            old[key] = _plain(value) if isinstance(old, InlineTable) else value
        elif _plain(before) != _plain(value) or isinstance(before, bool) != isinstance(value, bool):
            old[key] = _plain(value)


def _plain(value: Any) -> Any:
    return value.unwrap() if hasattr(value, "unwrap") else value
