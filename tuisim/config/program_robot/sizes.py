"""What the constants of a program say about the sizes of its wheels, such as `WHEEL_DIAMETER_CM = 5.6`."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator

from tuisim.config.program_robot.mentions import Mentions, Where
from tuisim.config.program_robot.scopes import Bound, Parameter, Scope
from tuisim.config.program_robot.words import means_diameter, means_girth, means_spacing, unit_mm
from tuisim.data_class import dataclass

_DIAMETERS_MM = (15.0, 120.0)
_SPACINGS_MM = (50.0, 350.0)
"""The least and the most that robots have."""


@dataclass(frozen=True, slots=True)
class Size:
    """A length, and the line that says it."""

    mm: float
    where: Where | None = None


@dataclass(frozen=True, slots=True)
class Sizes:
    """The sizes that a program names; None for one that it does not, or not clearly."""

    wheel: Size | None = None
    spacing: Size | None = None


def sizes_in(mentions: Mentions) -> Sizes:
    """Return the diameter of the wheels and their distance, by the names of numbers in a program."""
    named = [*_named(mentions)]
    wheels = [(name, size) for name, size in named if means_diameter(name)]
    girths = [
        (name, Size(round(size.mm / math.pi, 2), size.where))
        for name, size in named
        if means_girth(name)
    ]
    # A track alone may be one of music.
    spacings = [
        one
        for one in named
        if means_spacing(one[0]) and (one[0].lower() != "track" or wheels or girths)
    ]
    return Sizes(
        _only(wheels, _DIAMETERS_MM) or _only(girths, _DIAMETERS_MM), _only(spacings, _SPACINGS_MM)
    )


def _named(mentions: Mentions) -> Iterator[tuple[str, Size]]:
    """Yield the numbers that have a name, as they are written."""
    evaluation = mentions.evaluation
    if evaluation is None:
        return
    for scope in mentions.scopes:
        for name, bindings in scope.names.items():
            for binding in bindings if _says_size(name) else ():
                match binding:
                    case Bound(node=node, path=(), is_item=False):
                        found = evaluation.values(node, binding.scope)
                        where = Where(scope.module.file, node.lineno)
                    case Parameter(function=function):
                        found = tuple(value for value, _ in evaluation.arguments(binding))
                        where = Where(scope.module.file, function.lineno)
                    case _:
                        continue
                yield from ((name, Size(value, where)) for value in map(_number, found) if value)
        for inner in scope.body:
            if isinstance(inner, ast.Dict):
                yield from _in_dict(inner, scope)
    for data in filter(None, evaluation.files.found.values()):
        yield from (
            one for part in ast.walk(data) if isinstance(part, ast.Dict) for one in _in_dict(part)
        )


def _in_dict(node: ast.Dict, scope: Scope | None = None) -> Iterator[tuple[str, Size]]:
    where = Where(scope.module.file, node.lineno) if scope else None
    for key, value in zip(node.keys, node.values, strict=True):
        match key, value:
            case ast.Constant(value=str(name)), ast.Constant(value=number):
                if _says_size(name) and (size := _number(number)):
                    yield name, Size(size, where)


def _says_size(name: str) -> bool:
    return means_diameter(name) or means_girth(name) or means_spacing(name)


def _number(value: object) -> float:
    """Return a value as a number; 0 if it is none."""
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0


def _only(named: list[tuple[str, Size]], limits: tuple[float, float]) -> Size | None:
    """Return the one size that all these names stand for; None if they differ, or if it is too small or too large."""
    low, high = limits
    found: list[Size] = []
    for name, size in named:
        # A name without a unit stands for whichever makes a robot.
        units = [unit] if (unit := unit_mm(name)) else [1.0, 10.0]
        found += [
            Size(round(size.mm * unit, 1), size.where)
            for unit in units
            if low <= size.mm * unit <= high
        ][:1]
    return (
        found[0]
        if found and all(math.isclose(one.mm, found[0].mm, rel_tol=0.02) for one in found)
        else None
    )
