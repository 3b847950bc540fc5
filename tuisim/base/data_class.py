"""Data classes that cost a start little: Python's own compile six methods for each class, each time it is imported.

Here one function serves all classes where that is as fast, and only `__init__` is compiled, when the first object is
made. Otherwise they are as Python's own: `fields`, `replace` and `asdict` take them, and type checkers see no
difference.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from dataclasses import dataclass as standard_dataclass
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

__all__ = ["dataclass", "prepare"]

_Class = TypeVar("_Class", bound=type)


class _Factory:
    """The placeholder `<factory>`, which a signature shows as the default of a field with a `default_factory`."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


@recursive_repr()
def _repr(self: Any) -> str:
    pairs = ", ".join(f"{one.name}={getattr(self, one.name)!r}" for one in fields(self) if one.repr)
    return f"{type(self).__qualname__}({pairs})"


def _refuse_to_set(_self: object, name: str, _value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_to_delete(_self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    return [getattr(self, one.name) for one in fields(self)]


def _set_state(self: Any, state: list[Any]) -> None:
    for one, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, one.name, value)


def _init(cls: type, frozen: bool) -> Any:
    """Return a new `__init__` that sets the fields of a class, as that of a data class does.

    Args:
        cls: The class.
        frozen: Whether objects of the class refuse assignments, so that `__init__` must bypass that.
    """
    names: dict[str, Any] = {"_set": object.__setattr__, "_FACTORY": _FACTORY}
    annotations: dict[str, Any] = {}
    parameters = ["self"]
    body: list[str] = []
    for one in fields(cls):
        name = one.name
        value = one.name
        if one.default_factory is not MISSING:
            names[f"_make_{name}"] = one.default_factory
            default = "=_FACTORY"
            value = (
                f"_make_{name}() if {name} is _FACTORY else {name}"
                if one.init
                else f"_make_{name}()"
            )
        elif one.default is not MISSING:
            names[f"_default_{name}"] = one.default
            default = f"=_default_{name}"
            value = name if one.init else f"_default_{name}"
        else:
            default = ""
        if one.init:
            parameters.append(name + default)
            annotations[name] = one.type
        elif not default:
            continue
        body.append(f"_set(self, {name!r}, {value})" if frozen else f"self.{name} = {value}")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    exec(f"def __init__({', '.join(parameters)}):\n " + "\n ".join(body or ["pass"]), names)
    init = names["__init__"]
    init.__qualname__ = f"{cls.__qualname__}.__init__"
    init.__annotations__ = {**annotations, "return": None}
    return init


class _LateInit:
    """A descriptor in place of the `__init__` of a class, which compiles the real one at its first use.

    Args:
        cls: The class.
        frozen: Whether its objects are frozen.
    """

    def __init__(self, cls: type, frozen: bool) -> None:
        self._cls = cls
        self._frozen = frozen
        _LATE.append(self)

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        init = self.write()
        return init if instance is None else init.__get__(instance)

    def write(self) -> Any:
        """Compile the `__init__`, set it in the class and return it."""
        init = _init(self._cls, self._frozen)
        type.__setattr__(self._cls, "__init__", init)
        return init


_LATE: list[_LateInit] = []


def prepare() -> None:
    """Compile the `__init__` of all data classes that have no object yet.

    Processes forked from this one then need not compile them.
    """
    while _LATE:
        _LATE.pop().write()


def _contents(all_fields: tuple[Field[Any], ...]) -> Callable[[Any], tuple[Any, ...]]:
    """Return a function that takes an object, and returns a tuple of the fields that `==` compares."""
    names = [one.name for one in all_fields if one.compare]
    if len(names) > 1:
        return attrgetter(*names)
    return lambda self: tuple(getattr(self, name) for name in names)


def _decorated(cls: _Class, frozen: bool, slots: bool, eq: bool, order: bool) -> _Class:
    written = set(vars(cls))
    decorate = standard_dataclass(init=False, repr=False, eq=order, order=order, slots=slots)
    made: _Class = decorate(cls)  # type: ignore[assignment]
    methods: dict[str, Any] = {"__init__": _LateInit(made, frozen), "__repr__": _repr}
    if eq:
        contents = _contents(fields(made))

        def equal(self: Any, other: object) -> Any:
            if other.__class__ is not self.__class__:
                return NotImplemented
            return contents(self) == contents(other)

        def hash_of(self: Any) -> int:
            return hash(contents(self))

        methods |= {"__eq__": equal, "__hash__": hash_of if frozen else None}
    if frozen:
        methods |= {"__setattr__": _refuse_to_set, "__delattr__": _refuse_to_delete}
        if slots:
            methods |= {"__getstate__": _state, "__setstate__": _set_state}
    for name, method in methods.items():
        if name not in written:
            setattr(made, name, method)
    return made


if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, slots=False, eq=True, order=False):
        """Make a class a data class, and return it; the options are those of Python's own decorator.

        Without a class, return a decorator with these options.
        """
        if cls is None:
            return lambda cls: _decorated(cls, frozen, slots, eq, order)
        return _decorated(cls, frozen, slots, eq, order)
