"""The values of a run: for each, what is allowed, its unit, its help, and the options that set it, defined once.

The specs of a run consist of them, see `tuisim.engine.core.spec_fields`. Files, options, magic lines, forms and tables
use these definitions: `tuisim.engine.core.tree` finds a value by its path.

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
"""The key in the metadata of a dataclass field under which the field's `Value` is stored."""

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = 60

MAX_SEED = 2**63 - 1


class WrongValue(ValueError):  # noqa: N818  # the name says what it is
    """A value that is not allowed. Callers that know which file or option has it raise a `ConfigError` instead.

    Args:
        message: What is wrong.
        hint: What is allowed.
    """

    def __init__(self, message: str, hint: str = "", part: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint
        self.part = part
        """The part of the value that is wrong, such as `[2]`; empty if the whole value is wrong."""


def quote(value: object) -> str:
    """Return the `repr` of a value for messages, shortened."""
    return str(value).lower() if isinstance(value, bool) else _SHORT.repr(value)


def format_number(value: float) -> str:
    """Return a number as text for people: six digits, no exponent where none is needed, no -0."""
    text = f"{value:.6g}"
    return "0" if text == "-0" else text


class Value(ABC):
    """The description of one value of a spec: its meaning, its unit and what is allowed. Each kind is a subclass.

    Args:
        help: What the value means, in a phrase that begins in lower case: for files, options, forms and tables.
        unit: Its unit.
        label: Its name in a form, with the unit; empty for a value that no form shows.
        flags: The names of the option that sets it, if there is one.
        source: Where its numbers come from.
        later: Whether the value was added after runs had been stored without it. Runs then store it only if it differs
            from its default, so that their files stay the same.
        in_config: Whether the user's `config.toml` may set it, if there is an option.
    """

    stored_as: ClassVar[Any] = str
    """Type or types of the value in a stored run."""

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
        """Whether the value may be None, which a file expresses by leaving it out."""
        self.help = help
        self.unit = unit
        self.label = label
        self.flags = tuple(flags)
        self.source = source
        self.later = later
        self.in_config = in_config

    @property
    @abstractmethod
    def allowed(self) -> str:
        """The values that are allowed, described in words for an error or a help text."""

    @property
    def metavar(self) -> str:
        """The placeholder of the value in the help of its option; empty for a flag."""
        return {"mm": "MM", "°": "DEG"}.get(self.unit, "N")

    @property
    def choices(self) -> tuple[Any, ...]:
        """All allowed values if there are only a few; empty otherwise."""
        return ()

    def check(self, value: Any) -> None:
        """Check that a value from a Python program is allowed.

        Raises:
            WrongValue: it is not allowed.
        """
        self.parse_data(value)

    @abstractmethod
    def parse_data(self, data: object) -> Any:
        """Return the value from the data of a document: texts, numbers, booleans, lists.

        Raises:
            WrongValue: it is not allowed.
        """

    def parse_text(self, text: str) -> Any:
        """Return the value from the text of an option or a form.

        Raises:
            WrongValue: it is not allowed.
        """
        return self.parse_data(text)

    def format_text(self, value: Any) -> str:
        """Return a value as text for an option or a form."""
        return str(value)

    def build_error(self, value: object) -> WrongValue:
        """Return the error that says that a value is not allowed."""
        return WrongValue(f"must be {self.allowed}, got {quote(value)}")


class Flag(Value):
    """A value that is true or false.

    Args:
        off_flag: The option that sets it to false; needed if its default depends on another value.
        off_help: The help of that option.
    """

    ON = "on"
    OFF = "off"

    stored_as = bool
    allowed = "true or false"
    metavar = ""
    choices = (ON, OFF)

    def __init__(self, *, off_flag: str = "", off_help: str = "", **about: Any) -> None:
        super().__init__(**about)
        self.off_flag, self.off_help = off_flag, off_help

    def parse_data(self, data: object) -> bool:
        if not isinstance(data, bool):
            raise self.build_error(data)
        return data

    def parse_text(self, text: str) -> bool:
        if text not in self.choices:
            raise WrongValue(f"no such value {text!r}", f"one of {', '.join(self.choices)}")
        return text == Flag.ON

    def format_text(self, value: Any) -> str:
        return Flag.ON if value else Flag.OFF


class Number(Value):
    """A value that is a number from `low` to `high`, both included."""

    stored_as: ClassVar[Any] = int | float
    KIND: ClassVar[Any] = float
    """The type of the value in a spec."""

    def __init__(self, low: float, high: float, **about: Any) -> None:
        super().__init__(**about)
        self.low, self.high = low, high

    @property
    def allowed(self) -> str:
        return f"a number from {self.low:g} to {self.high:g}"

    def check(self, value: Any) -> None:
        if (
            isinstance(value, bool)
            or not isinstance(value, self.stored_as)
            or not self.low <= value <= self.high
        ):
            raise self.build_error(value)

    def parse_data(self, data: object) -> Any:
        self.check(data)
        return self.KIND(data)

    def parse_text(self, text: str) -> Any:
        try:
            return self.parse_data(self.KIND(text))
        except ValueError:
            raise self.build_error(text) from None

    def format_text(self, value: Any) -> str:
        return format_number(value)


class Whole(Number):
    """A value that is a whole number from `low` to `high`, both included."""

    stored_as = int
    KIND = int

    @property
    def allowed(self) -> str:
        return f"a whole number from {self.low} to {self.high}"

    def format_text(self, value: Any) -> str:
        return str(value)


class Seed(Whole):
    """A value that is a whole number for random draws. Users choose one from its range; a stored run may have any."""

    def check(self, value: Any) -> None:
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.build_error(value)

    def parse_data(self, data: object) -> Any:
        super().check(data)
        return data


class NamedNumber(Number):
    """A value that is a number; some numbers have names, by which users can give them.

    Args:
        names: Numbers by name.
    """

    def __init__(self, low: float, high: float, names: Mapping[str, float], **about: Any) -> None:
        super().__init__(low, high, **about)
        self.names = names

    @property
    def allowed(self) -> str:
        return f"{', '.join(self.names)}, or {super().allowed}"

    def parse_data(self, data: object) -> Any:
        if isinstance(data, str) and data in self.names:
            return self.names[data]
        return super().parse_data(data)

    def parse_text(self, text: str) -> Any:
        name = text.lower()
        return self.names[name] if name in self.names else super().parse_text(text)

    def named(self, value: float) -> str | float:
        """Return the name of a number, or the number if it has no name."""
        return next((name for name, number in self.names.items() if number == value), value)

    def format_text(self, value: Any) -> str:
        name = self.named(value)
        return name if isinstance(name, str) else format_number(name)


class Numbers(Number):
    """A value that consists of up to `most` numbers, each from `low` to `high`."""

    stored_as = (list, tuple)

    def __init__(self, low: float, high: float, most: int, **about: Any) -> None:
        super().__init__(low, high, **about)
        self.most = most

    @property
    def allowed(self) -> str:
        return f"1 to {self.most} numbers from {self.low:g} to {self.high:g}"

    def check(self, value: Any) -> None:
        if not isinstance(value, list | tuple):
            raise WrongValue(f"must be a list, got {quote(value)}")
        if not 1 <= len(value) <= self.most:
            raise WrongValue(f"must be {self.allowed}, got {len(value)}")
        number = Number(self.low, self.high)
        for place, each in enumerate(value, start=1):
            try:
                number.check(each)
            except WrongValue as error:
                raise WrongValue(error.message, error.hint, f"[{place}]") from None

    def parse_data(self, data: object) -> Any:
        self.check(data)
        return tuple(map(float, data))  # type: ignore[call-overload]  # checked

    def parse_text(self, text: str) -> Any:
        try:
            return self.parse_data([float(word) for word in text.replace(",", " ").split()])
        except ValueError:
            raise self.build_error(text) from None

    def format_text(self, value: Any) -> str:
        return " ".join(map(format_number, value))


class Text(Value):
    """A value that is one line of text.

    Args:
        what: What the text is, in errors.
        most: Maximum number of characters.
        pattern: Regular expression that the whole text must match.
    """

    allowed = "text"

    def __init__(
        self,
        what: str = "text",
        most: int = 1000,
        pattern: Pattern[str] | None = None,
        **about: Any,
    ) -> None:
        super().__init__(**about)
        self.what = what
        self.most = most
        self.pattern = pattern

    @property
    def metavar(self) -> str:
        return self.what.upper()

    def check(self, value: Any) -> None:
        if not isinstance(value, str):
            raise self.build_error(value)
        if self.pattern and not self.pattern.fullmatch(value):
            raise WrongValue(f"{quote(value)} is not a valid {self.what}")

    def parse_data(self, data: object) -> str:
        self.check(data)
        text = str(data)
        if not text.strip() or not text.isprintable() or len(text) > self.most:
            raise WrongValue(f"must be one line of 1 to {self.most} characters, got {quote(text)}")
        return text


class Choice(Value):
    """A value that is one of a few texts or numbers.

    Args:
        choices: All allowed texts or numbers, or an enumeration, whose members are then the choices.
        what: What the value is, for errors, such as `port`.
        metavar: The placeholder in the help; by default a list of all choices.
    """

    stored_as: ClassVar[Any] = str | int

    def __init__(
        self, choices: Iterable[Any], what: str = "value", metavar: str = "", **about: Any
    ) -> None:
        super().__init__(**about)
        self._choices = tuple(choices)
        self.what = what
        self._metavar = metavar

    @property
    def allowed(self) -> str:
        return f"one of {', '.join(str(choice) for choice in self._choices if choice != '')}"

    @property
    def metavar(self) -> str:
        return self._metavar or "|".join(map(str, self._choices))

    @property
    def choices(self) -> tuple[Any, ...]:
        return self._choices

    def parse_data(self, data: object) -> Any:
        for each in self._choices:
            # In Python True and 1.0 are equal to 1, but neither is allowed here.
            if each == data and not isinstance(data, bool | float):
                return each
        raise WrongValue(f"no such {self.what} {quote(data)}", self.allowed)

    def restore(self, data: Any) -> Any:
        """Return the choice that a stored run gives as a text or number, without checking it.

        Raises:
            ValueError: there is no such member of the enumeration.
        """
        kind = type(self._choices[0])
        return kind(data) if issubclass(kind, StrEnum) else data


class Choices(Choice):
    """A value that consists of any number of texts out of a few allowed ones."""

    stored_as = (list, tuple)
    allowed = "a list"
    choices = ()

    def check(self, value: Any) -> None:
        if not isinstance(value, list | tuple):
            raise self.build_error(value)
        for place, each in enumerate(value, start=1):
            if each not in self._choices:
                known = f"one of {', '.join(self._choices)}"
                raise WrongValue(f"no such {self.what} {quote(each)}", known, f"[{place}]")

    def parse_data(self, data: object) -> Any:
        self.check(data)
        return tuple(data)  # type: ignore[arg-type]  # checked


class Color(Value):
    """A value that is a colour, given by its CSS name or as `#rrggbb`."""

    allowed = "a CSS colour name, or #rrggbb"
    metavar = "COLOUR"

    def check(self, value: Any) -> None:
        if not isinstance(value, str):
            raise self.build_error(value)

    def parse_data(self, data: object) -> str:
        self.check(data)
        from tuisim.engine.core.css_colors import load_css_colors, parse_css_rgb

        word = str(data)
        if parse_css_rgb(word) is None:
            guess = did_you_mean(closest(word, load_css_colors()))
            raise WrongValue(
                f"no such colour {quote(word)}", f"{guess} any CSS colour name, or #rrggbb".lstrip()
            )
        return word.lower()


class Part(Value):
    """A value that is itself a spec, a part of the spec that contains it; it may be optional.

    Args:
        of: The class of the spec.
        values: The values in the part, by name, for a frozen class that is not a spec.
        key: The name of the part in a file, if it differs from the field's.
        standard: Whether the part is standard equipment of a robot, for which panels and files have a fixed place.
    """

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
        self.key = key
        self.standard = standard
        self.values = list_values(of) if values is None else values

    @property
    def allowed(self) -> str:
        return "a table of keys and values"

    def check(self, value: Any) -> None:
        if not isinstance(value, self.of):
            raise self.build_error(value)

    def parse_data(self, data: object) -> Any:
        # `tuisim.engine.files` reads a table of a file key by key, so no table arrives here.
        raise self.build_error(data)


class NamedPart(Part):
    """A value that is a spec of numbers, which users give by a name, number by number, or both.

    A name, such as `typical`, sets each number to its own value of that name; `none` sets all of them to their
    defaults. As text the spec is a name, followed by the numbers that differ, such as `typical gyro_dps=0`.
    """

    metavar = "SIZES"

    @property
    def allowed(self) -> str:
        return f"{' or '.join(self._sizes)}, then values such as {next(iter(self.values))}=1"

    @property
    def _sizes(self) -> dict[str, dict[str, float]]:
        numbers = {
            name: number for name, number in self.values.items() if isinstance(number, NamedNumber)
        }
        words = dict.fromkeys(word for number in numbers.values() for word in number.names)
        return {"none": {}} | {
            word: {name: number.names[word] for name, number in numbers.items()} for word in words
        }

    @property
    def choices(self) -> tuple[Any, ...]:
        return tuple(self._sizes)

    def parse_data(self, data: object) -> Any:
        if isinstance(data, self.of):
            return data
        if isinstance(data, dict):
            return self.replace_values(self.of(), data)
        if not isinstance(data, str) or not data.strip():
            raise self.build_error(data)
        values: dict[str, object] = {}
        for place, word in enumerate(data.replace(",", " ").split()):
            name, equals, text = word.partition("=")
            if equals:
                values[name] = _parse_number_or_text(text)
            elif place or name not in self._sizes:
                raise WrongValue(f"no such value {quote(word)}", self.allowed)
            else:
                values |= self._sizes[name]
        return self.replace_values(self.of(), values)

    def replace_values(self, base: Any, data: Mapping[str, object]) -> Any:
        """Return the spec `base` with the values that a document gives in place of its own.

        Raises:
            WrongValue: a value is unknown, or not allowed.
        """
        changes = {}
        for name, item in data.items():
            if name not in self.values:
                raise WrongValue("no such key", nearest(name, self.values), name)
            try:
                changes[name] = self.values[name].parse_data(item)
            except WrongValue as error:
                raise WrongValue(error.message, error.hint, name) from None
        return replace(base, **changes)

    def format_text(self, value: Any) -> str:
        usual = [(word, self.parse_data(word)) for word in self._sizes]
        (word, near), *_ = sorted(usual, key=lambda one: len(self._list_differences(value, one[1])))
        apart = [
            f"{name}={getattr(value, name)!r}".removesuffix(".0")
            for name in self._list_differences(value, near)
        ]
        return " ".join(apart if apart and near == self.of() else (word, *apart))

    def _list_differences(self, value: Any, other: Any) -> list[str]:
        return [name for name in self.values if getattr(value, name) != getattr(other, name)]


def _parse_number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


class Parts(Part):
    """A value that consists of several specs of one class, parts of the spec that contains them."""

    def check(self, value: Any) -> None:
        if not isinstance(value, tuple) or not all(isinstance(part, self.of) for part in value):
            raise self.build_error(value)


def list_values(kind: type) -> Mapping[str, Value]:
    """Return the descriptions of the values that a class of specs has, by the names of the values, in their order."""
    values = _VALUES.get(kind)
    if values is None:
        fields: Mapping[str, Field[Any]] = kind.__dataclass_fields__  # type: ignore[attr-defined]  # a data class
        values = _VALUES[kind] = {name: field.metadata[METADATA] for name, field in fields.items()}
    return values


_VALUES: dict[type, Mapping[str, Value]] = {}
