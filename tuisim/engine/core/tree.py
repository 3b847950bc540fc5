"""A run as a tree of values: each has a path, such as `world.noise.light` or `robot.color_sensors.left.x_mm`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.spec_fields import Spec
from tuisim.engine.core.values import Choice, NamedPart, Part, Parts, Value, WrongValue, list_values

_Node = TypeVar("_Node")


def list_leaves(kind: type) -> Iterator[tuple[str, Value]]:
    """Yield the path and the description of each value that all specs of the class `kind` have.

    Values of sensors are left out, because a robot may lack the sensor. Values that are given together, such as those
    of a `NamedPart`, are one value.
    """
    for name, value in list_values(kind).items():
        yield from _list_leaves(name, value)


def _list_leaves(path: str, value: Value) -> Iterator[tuple[str, Value]]:
    if not isinstance(value, Part) or isinstance(value, NamedPart):
        yield path, value
    elif not isinstance(value, Parts) and not value.optional:
        for name, inner in value.values.items():
            yield from _list_leaves(f"{path}.{name}", inner)


def get_value(node: object, path: str) -> Any:
    """Return the value of a spec at a path such as `robot.wheel_diameter_mm` or `robot.color_sensors.left.x_mm`.

    Raises:
        LookupError: there is no such path.
    """
    for name in path.split("."):
        node = _find_part(node, name)
    return node


def _find_part(node: object, name: str) -> Any:
    for part in node if isinstance(node, tuple) else ():
        if _find_name(part) == name:
            return part
    if isinstance(node, tuple) or not hasattr(node, name):
        raise LookupError(name)
    return getattr(node, name)


def _find_name(part: object) -> str:
    return str(getattr(part, "name", "") or getattr(part, "port", ""))


def put(node: _Node, path: str, value: object) -> _Node:
    """Return a copy of a spec with another value at a path.

    Raises:
        ConfigError: the value is wrong, or breaks a rule.
        LookupError: there is no such path.
    """
    return put_all(node, {path: value})


def put_all(node: _Node, values: Mapping[str, object]) -> _Node:
    """Return a copy of a spec with other values at some paths; values of one part are checked together.

    Args:
        node: The spec.
        values: The new values by path.

    Raises:
        ConfigError: a value is wrong, or breaks a rule.
        LookupError: there is no such path.
    """
    inside: dict[str, dict[str, object]] = {}
    for path, value in values.items():
        name, _, rest = path.partition(".")
        inside.setdefault(name, {})[rest] = value
    changes = {
        name: rest[""] if "" in rest else put_all(_find_part(node, name), rest)
        for name, rest in inside.items()
    }
    if isinstance(node, tuple):
        return tuple(changes.get(_find_name(part), part) for part in node)  # type: ignore[return-value]  # of the same parts
    return replace(node, **changes) if changes else node  # type: ignore[type-var]  # a data class


_RUN = Part(RunSpec)


def dump_run(spec: RunSpec) -> dict[str, Any]:
    """Return a run as data for JSON.

    Values that later versions added are left out while they have their default, so that exports stay the same.
    """
    return _dump_part(_RUN, spec)


def _dump_part(part: Part, node: Any) -> dict[str, Any]:
    inside = ((name, value, getattr(node, name)) for name, value in part.values.items())
    return {
        name: _dump_value(value, data)
        for name, value, data in inside
        if not (value.later and data == part.of.__dataclass_fields__[name].default)
    }


def _dump_value(value: Value, data: Any) -> Any:
    if isinstance(value, Parts):
        return tuple(_dump_part(value, item) for item in data)
    return _dump_part(value, data) if isinstance(value, Part) and data is not None else data


def load_run(data: Mapping[str, Any]) -> RunSpec:
    """Return the run from the output of `dump_run`, which may have been edited.

    Raises:
        KeyError, TypeError, ValueError: `data` is not the output of `dump_run`.
        ConfigError: a value is wrong.
    """
    spec: RunSpec = _load_part(_RUN, data, is_checked=True)
    return spec


def restore(data: Mapping[str, Any]) -> RunSpec:
    """Return the run from data that tuisim itself has stored, whose values are not checked again.

    Raises:
        KeyError, TypeError, ValueError: `data` is not the output of `dump_run`.
    """
    spec: RunSpec = _load_part(_RUN, data, is_checked=False)
    return spec


def _load_part(part: Part, data: Any, is_checked: bool) -> Any:
    if not isinstance(data, Mapping):
        raise TypeError(f"{part.of.__name__} must be a table, got {data!r:.60}")
    make = part.of if is_checked or not issubclass(part.of, Spec) else part.of.restore
    inside = ((name, part.values.get(name), node) for name, node in data.items())
    return make(
        **{name: _load_value(name, value, node, is_checked) for name, value, node in inside}
    )


def _load_value(name: str, value: Value | None, data: Any, is_checked: bool) -> Any:
    if value is None or (data is None and value.optional):
        return data
    if isinstance(value, Parts):
        return tuple(_load_part(value, node, is_checked) for node in data)
    if isinstance(value, Part):
        return _load_part(value, data, is_checked)
    is_flag = value.stored_as is bool
    if not isinstance(data, value.stored_as) or (isinstance(data, bool) and not is_flag):
        raise TypeError(f"{name} is {data!r:.60}")
    if isinstance(data, list):
        try:
            # That the data is a list says nothing about the types of its items: these are checked here.
            value.check(data)
        except WrongValue:
            if not is_checked:
                raise TypeError(f"{name} is {data!r:.60}") from None
        return tuple(data)
    return value.restore(data) if isinstance(value, Choice) else data
