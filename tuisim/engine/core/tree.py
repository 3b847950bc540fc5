"""A run as a tree of values: each has a path, such as `world.noise.light` or `robot.color_sensors.left.x_mm`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.spec_fields import Spec
from tuisim.engine.core.values import Choice, NamedPart, Part, Parts, Value, values_of

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


_RUN = Part(RunSpec)


def to_plain(spec: RunSpec) -> dict[str, Any]:
    """Return a run as data for JSON. What came later is left out at its default, so that exports do not change."""
    return _part_to_plain(_RUN, spec)


def _part_to_plain(part: Part, node: Any) -> dict[str, Any]:
    inside = ((name, value, getattr(node, name)) for name, value in part.values.items())
    return {
        name: _to_plain(value, one)
        for name, value, one in inside
        if not (value.later and one == part.of.__dataclass_fields__[name].default)
    }


def _to_plain(value: Value, data: Any) -> Any:
    if isinstance(value, Parts):
        return tuple(_part_to_plain(value, one) for one in data)
    return _part_to_plain(value, data) if isinstance(value, Part) and data is not None else data


def from_plain(data: Mapping[str, Any]) -> RunSpec:
    """Return the run of which `to_plain` has returned the data, which may have been changed since.

    Raises:
        KeyError, TypeError, ValueError: `data` is not the output of `to_plain`.
        ConfigError: a value is wrong.
    """
    spec: RunSpec = _part_from_plain(_RUN, data, is_checked=True)
    return spec


def restore(data: Mapping[str, Any]) -> RunSpec:
    """Return the run of which tuisim itself has stored the data: they are of the right types, and not checked again.

    Raises:
        KeyError, TypeError, ValueError: `data` is not the output of `to_plain`.
    """
    spec: RunSpec = _part_from_plain(_RUN, data, is_checked=False)
    return spec


def _part_from_plain(part: Part, data: Any, is_checked: bool) -> Any:
    if not isinstance(data, Mapping):
        raise TypeError(f"{part.of.__name__} is {data!r:.60}")
    make = part.of if is_checked or not issubclass(part.of, Spec) else part.of.restore
    inside = ((name, part.values.get(name), one) for name, one in data.items())
    return make(**{name: _from_plain(name, value, one, is_checked) for name, value, one in inside})


def _from_plain(name: str, value: Value | None, data: Any, is_checked: bool) -> Any:
    if value is None or (data is None and value.optional):
        return data
    if isinstance(value, Parts):
        return tuple(_part_from_plain(value, one, is_checked) for one in data)
    if isinstance(value, Part):
        return _part_from_plain(value, data, is_checked)
    is_flag = value.stored_as is bool
    is_nested = isinstance(data, list) and any(isinstance(item, list | dict) for item in data)
    if (
        not isinstance(data, value.stored_as)
        or (isinstance(data, bool) and not is_flag)
        or is_nested
    ):
        raise TypeError(f"{name} is {data!r:.60}")
    if isinstance(data, list):
        return tuple(data)
    return value.restore(data) if isinstance(value, Choice) else data
