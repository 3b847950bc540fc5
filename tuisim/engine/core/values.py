"""Values of a run, each said once: what it may be, its unit, its help, the options that set it.

The specs of a run consist of them, see `tuisim.engine.core.spec_fields`. Files, options, magic lines, forms and tables
are views of them: `tuisim.engine.core.tree` finds a value by its path.

To add a kind of value: add its class, and its function to `tuisim.engine.core.spec_fields`.
"""

from __future__ import annotations

import reprlib
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import Field, replace
from enum import StrEnum
from re import Pattern
from typing import Any, ClassVar

from tuisim.base.errors import closest, did_you_mean, nearest

METADATA = "value"
"""Where a field has its value."""

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 60

ON, OFF = "on", "off"
MAX_SEED = 2**63 - 1


class WrongValue(ValueError):  # noqa: N818  # the name says what it is
    """A value is not one of those that are allowed; whoever knows where it stands raises a ConfigError.

    Args:
        message: What is wrong.
        hint: What is allowed.
    """

    def __init__(self, message: str, hint: str = "", part: str = "") -> None:
        super().__init__(message)
        self.message, self.hint = message, hint
        self.part = part
        """Which part of the value is wrong, such as `[2]`; empty for the whole of it."""


def shown(value: object) -> str:
    """Return the `repr` of a value for messages, shortened."""
    return str(value).lower() if isinstance(value, bool) else _SHORT.repr(value)


def number_text(value: float) -> str:
    """Return a number for people: six digits, no exponent where none is needed, no -0."""
    text = f"{value:.6g}"
    return "0" if text == "-0" else text


class Value(ABC):
    """What is true of one value, whatever spec has it. Each kind of value is a subclass.

    Args:
        help: What it says, in a phrase that begins in lower case: for files, options, forms and tables.
        unit: Its unit.
        label: Its name in a form, with the unit; empty for one that no form shows.
        flags: The names of the option that sets it, if there is one.
        source: Where its numbers come from.
        later: Whether stored runs may lack it. They leave it out at its default, so that they stay as they were.
        in_config: Whether the user's `config.toml` may set it, if there is an option.
    """

    __slots__ = ("flags", "help", "in_config", "label", "later", "optional", "source", "unit")
    stored_as: ClassVar[Any] = str
    """Of which types it is in a stored run."""

    def __init__(
        self,
        *,
        help: str = "",  # noqa: A002  # as argparse and Click call it
        unit: str = "",
        label: str = "",
        flags: Sequence[str] = (),
        source: str = "",
        later: bool = False,
        in_config: bool = True,
    ) -> None:
        self.optional = False
        """Whether it may be None: a file leaves it out then."""
        self.help, self.unit, self.label = help, unit, label
        self.flags, self.source = tuple(flags), source
        self.later, self.in_config = later, in_config

    @property
    @abstractmethod
    def allowed(self) -> str:
        """What it may be, in words."""

    @property
    def metavar(self) -> str:
        """What stands for it in the help of its option; empty for a flag."""
        return {"mm": "MM", "°": "DEG"}.get(self.unit, "N")

    @property
    def choices(self) -> tuple[Any, ...]:
        """All that it may be, if that is a short list."""
        return ()

    def check(self, value: Any) -> None:
        """Check a value of Python.

        Raises:
            WrongValue: it is not allowed.
        """
        self.from_data(value)

    @abstractmethod
    def from_data(self, data: object) -> Any:
        """Return the value that a document gives: texts, numbers, booleans, lists.

        Raises:
            WrongValue: it is not allowed.
        """

    def from_text(self, text: str) -> Any:
        """Return the value that an option or a form gives.

        Raises:
            WrongValue: it is not allowed.
        """
        return self.from_data(text)

    def to_text(self, value: Any) -> str:
        """Return a value as an option or a form has it."""
        return str(value)

    def wrong(self, value: object) -> WrongValue:
        """Return the error about a value, to be raised."""
        return WrongValue(f"must be {self.allowed}, got {shown(value)}")


class Flag(Value):
    """True or false.

    Args:
        off_flag: The option that makes it false, where another value decides what it is by default.
        off_help: What it says then.
    """

    __slots__ = ("off_flag", "off_help")
    stored_as = bool

    def __init__(self, *, off_flag: str = "", off_help: str = "", **about: Any) -> None:
        super().__init__(**about)
        self.off_flag, self.off_help = off_flag, off_help

    @property
    def allowed(self) -> str:
        return "true or false"

    @property
    def metavar(self) -> str:
        return ""

    @property
    def choices(self) -> tuple[str, ...]:
        return ON, OFF

    def from_data(self, data: object) -> bool:
        if not isinstance(data, bool):
            raise self.wrong(data)
        return data

    def from_text(self, text: str) -> bool:
        if text not in (ON, OFF):
            raise WrongValue(f"no such value {text!r}", f"one of {ON}, {OFF}")
        return text == ON

    def to_text(self, value: Any) -> str:
        return ON if value else OFF


class Number(Value):
    """A number from `low` to `high`, which are allowed."""

    __slots__ = ("high", "low")
    stored_as: ClassVar[Any] = int | float

    def __init__(self, low: float, high: float, **about: Any) -> None:
        super().__init__(**about)
        self.low, self.high = low, high

    @property
    def allowed(self) -> str:
        return f"a number from {self.low:g} to {self.high:g}"

    def check(self, value: Any) -> None:
        self._check(value, int | float)

    def _check(self, value: Any, kind: Any) -> None:
        if (
            isinstance(value, bool)
            or not isinstance(value, kind)
            or not self.low <= value <= self.high
        ):
            raise self.wrong(value)

    def from_data(self, data: object) -> float:
        self.check(data)
        return float(data)  # type: ignore[arg-type]  # checked

    def from_text(self, text: str) -> float:
        found: float = self._parsed(text, float)
        return found

    def _parsed(self, text: str, kind: type) -> Any:
        try:
            return self.from_data(kind(text))
        except ValueError:
            raise self.wrong(text) from None

    def to_text(self, value: Any) -> str:
        return number_text(value)


class Whole(Number):
    """A whole number from `low` to `high`, which are allowed."""

    __slots__ = ()
    stored_as = int

    @property
    def allowed(self) -> str:
        return f"a whole number from {self.low} to {self.high}"

    def check(self, value: Any) -> None:
        self._check(value, int)

    def from_data(self, data: object) -> int:
        self.check(data)
        return data  # type: ignore[return-value]  # checked

    def from_text(self, text: str) -> int:
        found: int = self._parsed(text, int)
        return found

    def to_text(self, value: Any) -> str:
        return str(value)


class Seed(Whole):
    """A whole number for users to choose in its range; a stored run may have any."""

    __slots__ = ()

    def check(self, value: Any) -> None:
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.wrong(value)

    def from_data(self, data: object) -> int:
        self._check(data, int)
        return super().from_data(data)


class NamedNumber(Number):
    """A number, or the name of one.

    Args:
        names: Numbers by name.
    """

    __slots__ = ("names",)

    def __init__(self, low: float, high: float, names: Mapping[str, float], **about: Any) -> None:
        super().__init__(low, high, **about)
        self.names = names

    @property
    def allowed(self) -> str:
        return f"{', '.join(self.names)}, or {super().allowed}"

    def from_data(self, data: object) -> float:
        if isinstance(data, str) and data in self.names:
            return self.names[data]
        return super().from_data(data)

    def from_text(self, text: str) -> float:
        name = text.lower()
        return self.names[name] if name in self.names else super().from_text(text)

    def named(self, value: float) -> str | float:
        """Return the name of a number that has one, else the number."""
        return next((name for name, number in self.names.items() if number == value), value)

    def to_text(self, value: Any) -> str:
        found = self.named(value)
        return found if isinstance(found, str) else number_text(found)


class Numbers(Number):
    """Some numbers, at most `most`, each from `low` to `high`."""

    __slots__ = ("most",)
    stored_as = (list, tuple)

    def __init__(self, low: float, high: float, most: int, **about: Any) -> None:
        super().__init__(low, high, **about)
        self.most = most

    @property
    def allowed(self) -> str:
        return f"1 to {self.most} numbers from {self.low:g} to {self.high:g}"

    def check(self, value: Any) -> None:
        if not isinstance(value, list | tuple):
            raise WrongValue(f"must be a list, got {shown(value)}")
        if not 1 <= len(value) <= self.most:
            raise WrongValue(f"must be {self.allowed}, got {len(value)}")
        one = Number(self.low, self.high)
        for at, each in enumerate(value, start=1):
            try:
                one.check(each)
            except WrongValue as error:
                raise WrongValue(error.message, error.hint, f"[{at}]") from None

    def from_data(self, data: object) -> Any:
        self.check(data)
        return tuple(map(float, data))  # type: ignore[call-overload]  # checked

    def from_text(self, text: str) -> Any:
        try:
            return self.from_data([float(word) for word in text.replace(",", " ").split()])
        except ValueError:
            raise self.wrong(text) from None

    def to_text(self, value: Any) -> str:
        return " ".join(map(number_text, value))


class Text(Value):
    """One line of text.

    Args:
        what: What it is, in errors.
        most: Most characters.
        pattern: What it must be as a whole.
    """

    __slots__ = ("most", "pattern", "what")

    def __init__(
        self,
        what: str = "text",
        most: int = 1000,
        pattern: Pattern[str] | None = None,
        **about: Any,
    ) -> None:
        super().__init__(**about)
        self.what, self.most, self.pattern = what, most, pattern

    @property
    def allowed(self) -> str:
        return "text"

    @property
    def metavar(self) -> str:
        return self.what.upper()

    def check(self, value: Any) -> None:
        if not isinstance(value, str):
            raise self.wrong(value)
        if self.pattern and not self.pattern.fullmatch(value):
            raise WrongValue(f"{shown(value)} is not a valid {self.what}")

    def from_data(self, data: object) -> str:
        self.check(data)
        text = str(data)
        if not text.strip() or not text.isprintable() or len(text) > self.most:
            raise WrongValue(f"must be one line of 1 to {self.most} characters, got {shown(text)}")
        return text


class Choice(Value):
    """One of a few texts or numbers.

    Args:
        choices: All of them; an enumeration for its members.
        what: What one of them is, in errors.
        metavar: What stands for it in the help; by default all of them.
    """

    __slots__ = ("_choices", "_metavar", "what")
    stored_as: ClassVar[Any] = str | int

    def __init__(
        self, choices: Iterable[Any], what: str = "value", metavar: str = "", **about: Any
    ) -> None:
        super().__init__(**about)
        self._choices, self.what = tuple(choices), what
        self._metavar = metavar

    @property
    def allowed(self) -> str:
        return f"one of {', '.join(str(one) for one in self._choices if one != '')}"

    @property
    def metavar(self) -> str:
        return self._metavar or "|".join(map(str, self._choices))

    @property
    def choices(self) -> tuple[Any, ...]:
        return self._choices

    def from_data(self, data: object) -> Any:
        for each in self._choices:
            # True and 1.0 equal 1.
            if each == data and not isinstance(data, bool | float):
                return each
        raise WrongValue(f"no such {self.what} {shown(data)}", self.allowed)

    def restore(self, data: Any) -> Any:
        """Return the choice that a stored run gives as a text or number, without checking it.

        Raises:
            ValueError: there is no such member of the enumeration.
        """
        kind = type(self._choices[0])
        return kind(data) if issubclass(kind, StrEnum) else data


class Choices(Choice):
    """Some of a few texts."""

    __slots__ = ()
    stored_as = (list, tuple)

    @property
    def allowed(self) -> str:
        return "a list"

    @property
    def choices(self) -> tuple[Any, ...]:
        return ()

    def check(self, value: Any) -> None:
        if not isinstance(value, list | tuple):
            raise self.wrong(value)
        for at, each in enumerate(value, start=1):
            if each not in self._choices:
                known = f"one of {', '.join(self._choices)}"
                raise WrongValue(f"no such {self.what} {shown(each)}", known, f"[{at}]")

    def from_data(self, data: object) -> Any:
        self.check(data)
        return tuple(data)  # type: ignore[arg-type]  # checked


class Color(Value):
    """A colour of CSS."""

    __slots__ = ()

    @property
    def allowed(self) -> str:
        return "a CSS colour name, or #rrggbb"

    @property
    def metavar(self) -> str:
        return "COLOUR"

    def check(self, value: Any) -> None:
        if not isinstance(value, str):
            raise self.wrong(value)

    def from_data(self, data: object) -> str:
        self.check(data)
        from tuisim.engine.core.css_colors import css_names, css_rgb

        word = str(data)
        if css_rgb(word) is None:
            guess = did_you_mean(closest(word, css_names()))
            raise WrongValue(
                f"no such colour {shown(word)}", f"{guess} any CSS colour name, or #rrggbb".lstrip()
            )
        return word.lower()


class Part(Value):
    """A spec inside another one, perhaps none.

    Args:
        of: Its class.
        values: Its values by name, for another frozen class than a spec.
        key: Its name in a file, if it differs from the field's.
        standard: Whether it is standard equipment of a robot: panels and files have a place of its own for it.
    """

    __slots__ = ("key", "of", "standard", "values")

    def __init__(
        self,
        of: type,
        *,
        values: Mapping[str, Value] | None = None,
        key: str = "",
        standard: bool = False,
        **about: Any,
    ) -> None:
        super().__init__(**about)
        self.of: Any = of
        self.key, self.standard = key, standard
        self.values = values_of(of) if values is None else values

    @property
    def allowed(self) -> str:
        return "a table of keys and values"

    def check(self, value: Any) -> None:
        if not isinstance(value, self.of):
            raise self.wrong(value)

    def from_data(self, data: object) -> Any:
        # A table of a file is read key by key, by `tuisim.engine.files`.
        raise self.wrong(data)


class NamedPart(Part):
    """A spec of numbers inside another one, all given together: by the name of their sizes, or one by one.

    The names are those that its numbers have, and `none` for their defaults. As text it is a name and what differs from
    it, such as `typical gyro_dps=0`.
    """

    __slots__ = ()

    @property
    def allowed(self) -> str:
        return f"{' or '.join(self._sizes)}, then values such as {self._example}"

    @property
    def _example(self) -> str:
        return next(f"{name}=1" for name in self.values)

    @property
    def _sizes(self) -> dict[str, dict[str, float]]:
        numbers = {name: one for name, one in self.values.items() if isinstance(one, NamedNumber)}
        words = dict.fromkeys(word for one in numbers.values() for word in one.names)
        return {"none": {}} | {
            word: {name: one.names[word] for name, one in numbers.items()} for word in words
        }

    @property
    def metavar(self) -> str:
        return "SIZES"

    @property
    def choices(self) -> tuple[Any, ...]:
        return tuple(self._sizes)

    def from_data(self, data: object) -> Any:
        if isinstance(data, self.of):
            return data
        if isinstance(data, dict):
            return self.changed(self.of(), data)
        if not isinstance(data, str) or not data.strip():
            raise self.wrong(data)
        found: dict[str, object] = {}
        for place, word in enumerate(data.replace(",", " ").split()):
            name, equals, text = word.partition("=")
            if equals:
                found[name] = _number_or_text(text)
            elif place or name not in self._sizes:
                raise WrongValue(f"no such value {shown(word)}", self.allowed)
            else:
                found |= self._sizes[name]
        return self.changed(self.of(), found)

    def changed(self, base: Any, data: Mapping[str, object]) -> Any:
        """Return the spec with some of its values replaced by those that a document gives.

        Raises:
            WrongValue: one is unknown, or not allowed.
        """
        found = {}
        for name, one in data.items():
            if name not in self.values:
                raise WrongValue("no such key", nearest(name, self.values), name)
            try:
                found[name] = self.values[name].from_data(one)
            except WrongValue as error:
                raise WrongValue(error.message, error.hint, name) from None
        return replace(base, **found)

    def to_text(self, value: Any) -> str:
        usual = [(word, self.from_data(word)) for word in self._sizes]
        (word, near), *_ = sorted(usual, key=lambda one: len(self._apart(value, one[1])))
        apart = [
            f"{name}={getattr(value, name)!r}".removesuffix(".0")
            for name in self._apart(value, near)
        ]
        return " ".join(apart if apart and near == self.of() else (word, *apart))

    def _apart(self, value: Any, other: Any) -> list[str]:
        return [name for name in self.values if getattr(value, name) != getattr(other, name)]


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


class Parts(Part):
    """Several specs of one class inside another one."""

    __slots__ = ()

    def check(self, value: Any) -> None:
        if not isinstance(value, tuple) or not all(isinstance(one, self.of) for one in value):
            raise self.wrong(value)


def values_of(kind: type) -> Mapping[str, Value]:
    """Return the values of a spec by name, in their order."""
    found = _VALUES.get(kind)
    if found is None:
        fields: Mapping[str, Field[Any]] = kind.__dataclass_fields__  # type: ignore[attr-defined]  # a data class
        found = _VALUES[kind] = {name: one.metadata[METADATA] for name, one in fields.items()}
    return found


_VALUES: dict[type, Mapping[str, Value]] = {}
