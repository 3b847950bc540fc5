"""Specs: frozen data whose fields are values; this module has a function for each kind of field."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, Field, dataclass, field
from functools import partial
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


def _build_field(
    kind: Callable[..., Value],
    *allowed: Any,
    default: Any = MISSING,
    optional: bool = False,
    **about: Any,
) -> Any:
    """Return a data class field for a value.

    Args:
        kind: Its class, of `engine.core.values`.
        allowed, about: The arguments of that class.
        default: The value if none is given; without it, the value is required.
        optional: Whether the value may be None; it always may if that is the default.
    """
    value = kind(*allowed, **about)
    value.optional = optional or default is None
    return field(default=default, metadata={METADATA: value})


flag = partial(_build_field, Flag)
number = partial(_build_field, Number)
whole = partial(_build_field, Whole)
seed = partial(_build_field, Seed, 0, MAX_SEED)
named_number = partial(_build_field, NamedNumber)
numbers = partial(_build_field, Numbers)
text = partial(_build_field, Text)
choice = partial(_build_field, Choice)
some = partial(_build_field, Choices)
color = partial(_build_field, Color)
part = partial(_build_field, Part)
named_part = partial(_build_field, NamedPart)
parts = partial(_build_field, Parts)
"""Each builds a field for a value of its class: it takes the arguments of the class, `default` and `optional`."""


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
