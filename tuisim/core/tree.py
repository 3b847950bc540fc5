"""A run as a tree of values: each has a path, such as `world.noise.light` or `robot.color_sensors.left.x_mm`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from typing import Any, TypeVar

from tuisim.core.profile import ProfileSpec, profile_from_plain, profile_to_plain
from tuisim.core.spec import RunSpec
from tuisim.core.spec_fields import Spec
from tuisim.core.values import NamedPart, Part, Parts, Value, values_of

_Node = TypeVar("_Node")


def leaves(kind: type) -> Iterator[tuple[str, Value]]:
    """Yield path and value of all that every spec of a class has: not of sensors, which may be there or not.

    Values that are given together are one.
    """
    for name, value in values_of(kind).items():
        yield from _leaves(name, value)


def _leaves(path: str, value: Value) -> Iterator[tuple[str, Value]]:
    if not isinstance(value, Part) or isinstance(value, NamedPart):
        yield path, value
    elif not isinstance(value, Parts) and not value.optional:
        for name, inner in value.values.items():
            yield from _leaves(f"{path}.{name}", inner)


def at(node: object, path: str) -> Any:
    """Return the value at a path; several sensors of a field are told apart by name.

    Raises:
        LookupError: there is none.
    """
    for name in path.split("."):
        node = _inside(node, name)
    return node


def _inside(node: object, name: str) -> Any:
    for one in node if isinstance(node, tuple) else ():
        if _name_of(one) == name:
            return one
    if isinstance(node, tuple) or not hasattr(node, name):
        raise LookupError(name)
    return getattr(node, name)


def _name_of(part: object) -> str:
    return str(getattr(part, "name", "") or getattr(part, "port", ""))


def put(node: _Node, path: str, value: object) -> _Node:
    """Return a spec with another value at a path.

    Raises:
        ConfigError: the value is wrong, or breaks a rule.
        LookupError: there is no such path.
    """
    return put_all(node, {path: value})


def put_all(node: _Node, values: Mapping[str, object]) -> _Node:
    """Return a spec with other values at some paths; values of one part are checked together.

    Raises:
        As for `put`.
    """
    inside: dict[str, dict[str, object]] = {}
    for path, value in values.items():
        name, _, rest = path.partition(".")
        inside.setdefault(name, {})[rest] = value
    found = {
        name: rest[""] if "" in rest else put_all(_inside(node, name), rest)
        for name, rest in inside.items()
    }
    if isinstance(node, tuple):
        return tuple(found.get(_name_of(one), one) for one in node)  # type: ignore[return-value]  # of the same parts
    return replace(node, **found) if found else node  # type: ignore[type-var]  # a data class


def to_plain(spec: RunSpec) -> dict[str, Any]:
    """Return a run as data for JSON. What came later is left out at its default, so that exports do not change."""
    found: dict[str, Any] = _plain(spec)
    return found


def _plain(spec: Any) -> Any:
    if isinstance(spec, ProfileSpec):
        return profile_to_plain(spec)
    if isinstance(spec, tuple):
        return tuple(map(_plain, spec))
    if not isinstance(spec, Spec):
        return asdict(spec) if hasattr(spec, "__dataclass_fields__") else spec
    fields = spec.__dataclass_fields__
    found = ((name, value, getattr(spec, name)) for name, value in values_of(type(spec)).items())
    return {
        name: _plain(one)
        for name, value, one in found
        if not (value.later and one == fields[name].default)
    }


def from_plain(data: Mapping[str, Any]) -> RunSpec:
    """Return the run of which `to_plain` has returned the data.

    Raises:
        KeyError, TypeError, ValueError: `data` is not the output of `to_plain`.
        ConfigError: a value is wrong.
    """
    return _from_plain(RunSpec, data)


def _from_plain(kind: type[_Node], data: Any) -> _Node:
    if not isinstance(data, Mapping):
        raise TypeError(f"{kind.__name__} is {data!r:.60}")
    if kind is ProfileSpec:
        return profile_from_plain(data)  # type: ignore[return-value]
    if not issubclass(kind, Spec):
        # A pose: it does not check what it is made of.
        for name, one in data.items():
            if isinstance(one, bool) or not isinstance(one, int | float):
                raise TypeError(f"{name} is {one!r:.60}")
        return kind(**data)
    values = values_of(kind)
    return kind(**{name: _value(values.get(name), one) for name, one in data.items()})


def _value(value: Value | None, data: Any) -> Any:
    match value:
        case Parts():
            return tuple(_from_plain(value.of, one) for one in data)
        case Part():
            return None if data is None else _from_plain(value.of, data)
        case _:
            return tuple(data) if isinstance(data, list) else data
