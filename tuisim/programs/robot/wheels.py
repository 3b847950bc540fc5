"""Which motors of a program drive the wheels, which are medium, and what names say about the sizes of the wheels."""

from __future__ import annotations

import ast
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations

from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import HUB_PORTS
from tuisim.engine.core.profile import Library
from tuisim.engine.core.spec import NO_PORT, RobotSpec
from tuisim.programs.robot.library import DeviceKind
from tuisim.programs.robot.mentions import Mention, Mentions, Pair, Where
from tuisim.programs.robot.scopes import Bound, Parameter, Scope
from tuisim.programs.robot.words import (
    Side,
    means_diameter,
    means_girth,
    means_large,
    means_radius,
    means_spacing,
    means_tool,
    side_of,
    unit_mm,
)

_USUAL = (
    ("outB", "outC"),
    ("outA", "outD"),
    ("outA", "outB"),
    ("outC", "outD"),
    ("outA", "outC"),
    ("outB", "outD"),
    *combinations(HUB_PORTS, 2),
)
"""Pairs of ports, those that robots have most often first."""


@dataclass(frozen=True, slots=True)
class WheelMotors:
    """The motors that drive the wheels."""

    left: str
    right: str
    """Their ports; `NO_PORT` if there are no wheels."""
    where: Where | None = None
    """What says so; None if nothing does."""
    pair: Pair | None = None
    doubt: str = ""
    """Which other reading there is, in words; empty for none."""


def wheels_of(
    mentions: Mentions,
    kinds: Mapping[str, DeviceKind],
    usual: RobotSpec,
    tools: Collection[str] = (),
) -> WheelMotors:
    """Return the motors that drive the wheels; none if every port is taken by a motor that does something else.

    Args:
        kinds: The motors that the program names, by port.
        usual: The robot whose wheels stay where nothing says otherwise.
        tools: Ports of motors that drive no wheel, unless the program drives them as a pair.
    """
    devices = mentions.devices
    return (
        _of_pairs(mentions.pairs)
        or _of_single(devices, kinds, tools)
        or _left_over(devices, kinds, usual, tools)
    )


def _of_pairs(pairs: Sequence[Pair]) -> WheelMotors | None:
    if not pairs:
        return None
    likely = sorted(
        pairs, key=lambda pair: (means_tool(pair.names), -pair.rank, pair.kind is DeviceKind.MEDIUM)
    )
    chosen = likely[0]
    others = [pair for pair in likely if {pair.left, pair.right} != {chosen.left, chosen.right}]
    doubt = (
        f"{others[0].class_name} on {others[0].left} and {others[0].right} is not used for wheels"
        if others
        else ""
    )
    return WheelMotors(chosen.left, chosen.right, chosen.where, chosen, doubt)


def _of_single(
    devices: Sequence[Mention], kinds: Mapping[str, DeviceKind], tools: Collection[str]
) -> WheelMotors | None:
    """Return two motors that are made one by one, and that names, a class or their number show to be the wheels."""
    by_port: dict[str, Mention] = {}
    for device in devices:
        if device.kind.is_motor and device.port and device.port not in tools:
            by_port.setdefault(device.port, device)
    large = [one for port, one in by_port.items() if kinds[port] is not DeviceKind.MEDIUM]
    wheels = [one for one in large if not means_tool(one.names)]
    for motors in (wheels, [*by_port.values()] if not large else []):
        for of_class in (True, False):
            if found := _by_side(motors, of_class=of_class):
                return found
    owners = [
        [one for one in wheels if one.owner is owner]
        for owner in {one.owner for one in wheels}
        if owner
    ]
    for held in [*(held for held in owners if len(held) == 2), wheels]:
        if len(held) >= 2:
            return _in_order(held)
    return None


def _by_side(motors: Sequence[Mention], *, of_class: bool) -> WheelMotors | None:
    for one in motors:
        for other in motors:
            if of_class and one.owner is not other.owner:
                continue
            if side_of(one.names) is Side.LEFT and side_of(other.names) is Side.RIGHT:
                return WheelMotors(one.port, other.port, one.where)
    return None


def _in_order(motors: Sequence[Mention]) -> WheelMotors:
    """Return the usual two of some motors, the left one first unless a name says otherwise."""
    by_port = {one.port: one for one in motors}
    left, right = next(pair for pair in _USUAL if by_port.keys() >= set(pair))
    sides = side_of(by_port[left].names), side_of(by_port[right].names)
    # One name for both, such as that of a list of ports, says nothing.
    if sides[0] is not sides[1] and (sides[0] is Side.RIGHT or sides[1] is Side.LEFT):
        left, right = right, left
    rest = ", ".join(port for port in by_port if port not in (left, right))
    doubt = (
        f"of the large motors, those on {left} and {right} are taken for the wheels, not {rest}"
        if rest
        else ""
    )
    return WheelMotors(left, right, by_port[left].where, doubt=doubt)


def _left_over(
    devices: Sequence[Mention],
    kinds: Mapping[str, DeviceKind],
    usual: RobotSpec,
    other_tools: Collection[str],
) -> WheelMotors:
    """Return the usual wheels, on other ports if the program needs theirs."""
    ports = (usual.left_port, usual.right_port)
    if not other_tools and all(
        port in ports and kind is not DeviceKind.MEDIUM for port, kind in kinds.items()
    ):
        return WheelMotors(*ports)
    tools = {one.port for one in devices if one.kind.is_motor and means_tool(one.names)} | {
        *other_tools
    }
    stay = [
        port
        for port in ports
        if kinds.get(port, DeviceKind.LARGE) is not DeviceKind.MEDIUM and port not in tools
    ]
    free = [*stay, *(port for port in usual.output_ports if port not in kinds and port not in stay)]
    if len(free) >= 2:
        left = usual.left_port if usual.left_port in free else _other(free, usual.right_port)
        right = usual.right_port if usual.right_port in free else _other(free, left)
        return WheelMotors(left, right)
    loose = [port for port in kinds if port not in tools]
    alike = [pair for pair in _USUAL if {*pair} <= {*loose} and kinds[pair[0]] is kinds[pair[1]]]
    pairs = alike or [pair for pair in _USUAL if {*pair} <= {*loose}]
    if not pairs:
        return WheelMotors(NO_PORT, NO_PORT)
    left, right = pairs[0]
    return WheelMotors(
        left,
        right,
        doubt=f"no two ports are free for wheels: the motors on {left} and {right} drive them",
    )


def _other(ports: Iterable[str], taken: str) -> str:
    return next(port for port in ports if port != taken)


_MOST_MEDIUM = 2
"""As many medium motors as robots have beside two large ones."""


def with_tools(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of motors by port: also of those whose names say that they move a tool."""
    return _with_medium(
        kinds, mentions, [port for port in kinds if means_tool(_names(port, mentions))]
    )


def with_others(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of the motors that drive no wheel, by port."""
    return _with_medium(kinds, mentions, [*kinds])


def _with_medium(
    kinds: Mapping[str, DeviceKind], mentions: Mentions, others: list[str]
) -> dict[str, DeviceKind]:
    """Return kinds with one or two other motors than those of the wheels as medium ones, as in LEGO's sets."""
    if mentions.library is not Library.PYBRICKS or mentions.hub or len(others) > _MOST_MEDIUM:
        return dict(kinds)
    unsaid = [
        port
        for port in others
        if kinds[port] is DeviceKind.MOTOR and not means_large(_names(port, mentions))
    ]
    return {**kinds, **dict.fromkeys(unsaid, DeviceKind.MEDIUM)}


def _names(port: str, mentions: Mentions) -> list[str]:
    return [name for one in mentions.devices if one.port == port for name in one.names]


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
    wheels = [
        *((name, size) for name, size in named if means_diameter(name)),
        *((name, Size(2 * size.mm, size.where)) for name, size in named if means_radius(name)),
    ]
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


def _in_dict(node: ast.Dict, scope: Scope) -> Iterator[tuple[str, Size]]:
    where = Where(scope.module.file, node.lineno)
    for key, value in zip(node.keys, node.values, strict=True):
        match key, value:
            case ast.Constant(value=str(name)), ast.Constant(value=number):
                if _says_size(name) and (size := _number(number)):
                    yield name, Size(size, where)


def _says_size(name: str) -> bool:
    return means_diameter(name) or means_radius(name) or means_girth(name) or means_spacing(name)


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
