"""Specs: frozen data whose fields are values; this module has a function for each kind of field."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, Field, dataclass, field
from typing import Any, ClassVar, NoReturn, Self, TypeVar, dataclass_transform

from tuisim.base.errors import ConfigError, RobotError
from tuisim.engine.core.values import (
    MAX_SEED,
    METADATA,
    Choice,
    Choices,
    Color,
    Flag,
    NamedNumber,
    NamedPart,
    Number,
    Numbers,
    Part,
    Parts,
    Seed,
    Text,
    Value,
    Whole,
    WrongValue,
    list_values,
)


def _field(value: Value, default: Any, *, optional: bool = False) -> Any:
    value.optional = optional or default is None
    return field(default=default, metadata={METADATA: value})


def flag(*, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for true or false; `about` are arguments of `values.Flag`."""
    return _field(Flag(**about), default)


def number(low: float, high: float, *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for a number from `low` to `high`; `about` are arguments of `values.Number`."""
    return _field(Number(low, high, **about), default)


def whole(low: int, high: int, *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for a whole number from `low` to `high`; `about` are arguments of `values.Whole`."""
    return _field(Whole(low, high, **about), default)


def seed(*, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for a seed; `about` are arguments of `values.Seed`."""
    return _field(Seed(0, MAX_SEED, **about), default)


def named_number(
    low: float, high: float, names: Mapping[str, float], *, default: Any = MISSING, **about: Any
) -> Any:
    """Return a data class field for a number or its name in `names`; `about` are arguments of `values.NamedNumber`."""
    return _field(NamedNumber(low, high, names, **about), default)


def numbers(low: float, high: float, most: int, *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for up to `most` numbers; `about` are arguments of `values.Numbers`."""
    return _field(Numbers(low, high, most, **about), default)


def text(*, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for one line of text; `about` are arguments of `values.Text`."""
    return _field(Text(**about), default)


def choice(choices: Iterable[Any], *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for one of `choices`; `about` are arguments of `values.Choice`."""
    return _field(Choice(choices, **about), default)


def some(choices: Iterable[str], *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for any number of texts out of `choices`; `about` are arguments of `values.Choices`."""
    return _field(Choices(choices, **about), default)


def color(*, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for a colour; `about` are arguments of `values.Color`."""
    return _field(Color(**about), default)


def part(of: type, *, default: Any = MISSING, optional: bool = False, **about: Any) -> Any:
    """Return a data class field for another spec of class `of`, or also for None if `optional` is True.

    `about` are arguments of `values.Part`.
    """
    value = Part(of, **about)
    return _field(value, default, optional=optional)


def named_part(of: type, *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for a spec that may be given by name; `about` are arguments of `values.NamedPart`."""
    return _field(NamedPart(of, **about), default)


def parts(of: type, *, default: Any = MISSING, **about: Any) -> Any:
    """Return a data class field for several other specs of class `of`; `about` are arguments of `values.Parts`."""
    return _field(Parts(of, **about), default)


_Spec = TypeVar("_Spec", bound="Spec")


class Spec:
    """Base class of frozen data whose values are checked when an object is created.

    All specs inherit their methods from this class. An ordinary data class would compile methods of its own for each
    class, at each start of tuisim.
    """

    __slots__ = ("_hash",)
    _hash: int
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    ERROR: ClassVar[type[ConfigError]] = RobotError
    """The error that is raised about values of the spec."""
    KEY: ClassVar[str] = ""
    """The prefix of the names of values in errors."""

    def __init__(self, *args: Any, **given: Any) -> None:
        names = self.__dataclass_fields__
        if len(args) > len(names):
            raise TypeError(f"{type(self).__name__} has {len(names)} values, got {len(args)}")
        for name, value in zip(names, args, strict=False):
            if name in given:
                raise TypeError(f"{type(self).__name__} got {name} twice")
            given[name] = value
        self._set_values(given)
        self._check_values()
        self.check()

    @classmethod
    def restore(cls, **values: Any) -> Self:
        """Return a spec with stored values, which are not checked again.

        Raises:
            TypeError: a value is missing or unknown.
        """
        spec = cls.__new__(cls)
        spec._set_values(values)
        return spec

    def _set_values(self, values: Mapping[str, Any]) -> None:
        for name, spec_field in self.__dataclass_fields__.items():
            value = values.get(name, spec_field.default)
            if value is MISSING:
                raise TypeError(f"{type(self).__name__} lacks {name}")
            object.__setattr__(self, name, value)
        if unknown := [name for name in values if name not in self.__dataclass_fields__]:
            raise TypeError(f"{type(self).__name__} has no {', '.join(unknown)}")

    def _check_values(self) -> None:
        for name, value in list_values(type(self)).items():
            data = getattr(self, name)
            if data is None and value.optional:
                continue
            try:
                value.check(data)
            except WrongValue as error:
                raise self.ERROR(
                    error.message, error.hint, key=self.name_key(name) + error.part
                ) from None

    def check(self) -> None:
        """Check the rules that involve several values of the spec.

        Raises:
            ConfigError: a rule is broken.
        """

    def name_key(self, name: str) -> str:
        """Return the name of a value for error messages: `noise.light` for `light`, if the key of the spec is `noise`.

        In a spec without a key, return the name unchanged.
        """
        return f"{self.KEY}.{name}" if self.KEY else name

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(
            f"{type(self).__name__} cannot be changed; make another with other values"
        )

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(
            f"{type(self).__name__} cannot be changed; make another with other values"
        )

    def _list_contents(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self.__dataclass_fields__)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Spec) or type(other) is not type(self):
            return NotImplemented
        return self._list_contents() == other._list_contents()

    def __hash__(self) -> int:
        try:
            return self._hash
        except AttributeError:
            object.__setattr__(self, "_hash", hash(self._list_contents()))
            return self._hash

    def __repr__(self) -> str:
        pairs = zip(self.__dataclass_fields__, self._list_contents(), strict=True)
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in pairs)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._list_contents()


@dataclass_transform(
    frozen_default=True,
    field_specifiers=(
        flag,
        number,
        whole,
        seed,
        named_number,
        numbers,
        text,
        choice,
        some,
        color,
        part,
        named_part,
        parts,
    ),
)
def spec(cls: type[_Spec]) -> type[_Spec]:
    """Decorate a subclass of `Spec`: make its annotated attributes the fields of a data class, and return the class.

    Each attribute is built with a function of this module, such as `whole` or `choice`, which says what is allowed.
    """
    return dataclass(init=False, repr=False, eq=False, slots=True)(cls)
