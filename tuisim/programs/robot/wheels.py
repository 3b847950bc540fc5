"""Which motors of a program drive the wheels, which are medium, and what names say about the sizes of the wheels."""

from __future__ import annotations

import ast
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import HUB_PORTS
from tuisim.engine.core.profile import Library
from tuisim.engine.core.spec import NO_PORT, RobotSpec
from tuisim.programs.robot.formulas import find_formula_size, read_girth
from tuisim.programs.robot.library import DeviceKind
from tuisim.programs.robot.mentions import Mention, Mentions, Pair, Where
from tuisim.programs.robot.scopes import Bound, Parameter, Scope
from tuisim.programs.robot.words import (
    Side,
    find_girth,
    find_side,
    is_diameter,
    is_girth,
    is_head,
    is_large,
    is_radius,
    is_spacing,
    is_steering,
    is_tool,
    parse_unit_mm,
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
    """The ports of the motors that drive the wheels."""

    left: str
    right: str
    """Their ports; `NO_PORT` if there are no wheels."""
    where: Where | None = None
    """The line that shows it; None if none does."""
    pair: Pair | None = None
    doubt: str = ""
    """Another way to read the program, or what a robot here cannot do, in words; empty for none."""


def find_wheels(
    mentions: Mentions,
    kinds: Mapping[str, DeviceKind],
    usual: RobotSpec,
    tools: Collection[str] = (),
) -> WheelMotors:
    """Return the motors that drive the wheels.

    Their ports are `NO_PORT` if every port is taken by a motor that does something else.

    Args:
        mentions: The devices that the program creates.
        kinds: The motors that the program names, by port.
        usual: The robot whose wheels are used if the program does not show other wheels.
        tools: Ports of motors that drive no wheel, unless the program drives them as a pair.
    """
    devices = mentions.devices
    if mentions.hub:
        # On a hub, motors with names of tools drive no wheel; on the EV3, `add_tools` makes them medium motors.
        named = [device for device in devices if device.kind.is_motor and is_tool(device.names)]
        tools = {*tools, *(device.port for device in named)}
    wheels = (
        _choose_pair(mentions.pairs)
        or _choose_single(devices, kinds, tools)
        or _choose_usual(devices, kinds, usual, tools)
    )
    ports = (wheels.left, wheels.right)
    doubts = (
        wheels.doubt,
        _CAR if kinds.keys().isdisjoint(ports) and _steers(devices) else "",
        _HEAD if _turns_sensor(devices, ports) else "",
    )
    return replace(wheels, doubt="; ".join(filter(None, doubts)))


_CAR = "a car that steers is not simulated: this robot stands, because two motors drive it"
_HEAD = "no motor turns a sensor here: each keeps its direction"


def _steers(devices: Sequence[Mention]) -> bool:
    return any(device.kind.is_motor and is_steering(device.names) for device in devices)


def _turns_sensor(devices: Sequence[Mention], wheels: Collection[str]) -> bool:
    """Return whether a program has a distance sensor, and a motor whose name says that it turns the sensor.

    Motors of the wheels do not count.
    """
    has_sensor = any(
        device.kind in (DeviceKind.ULTRASONIC, DeviceKind.INFRARED) for device in devices
    )
    others = [device for device in devices if device.kind.is_motor and device.port not in wheels]
    return has_sensor and any(is_head(device.names) for device in others)


def _choose_pair(pairs: Sequence[Pair]) -> WheelMotors | None:
    if not pairs:
        return None
    likely = sorted(
        pairs, key=lambda pair: (is_tool(pair.names), -pair.rank, pair.kind is DeviceKind.MEDIUM)
    )
    chosen = likely[0]
    others = [pair for pair in likely if {pair.left, pair.right} != {chosen.left, chosen.right}]
    doubt = (
        f"{others[0].class_name} on {others[0].left} and {others[0].right} is not used for wheels"
        if others
        else ""
    )
    return WheelMotors(chosen.left, chosen.right, chosen.where, chosen, doubt)


def _choose_single(
    devices: Sequence[Mention], kinds: Mapping[str, DeviceKind], tools: Collection[str]
) -> WheelMotors | None:
    """Return the two motors of the wheels in a program that creates its motors one by one.

    Their names or their class show them. They are also clear if only two motors are possible. The result is None if it
    is unclear which motors drive the wheels.
    """
    by_port: dict[str, Mention] = {}
    for device in devices:
        if device.kind.is_motor and device.port and device.port not in tools:
            by_port.setdefault(device.port, device)
    large = [motor for port, motor in by_port.items() if kinds[port] is not DeviceKind.MEDIUM]
    wheels = [motor for motor in large if not is_tool(motor.names)]
    for motors in (wheels, [*by_port.values()] if not large else []):
        for of_class in (True, False):
            if wheel_motors := _sort_sides(motors, of_class=of_class):
                return wheel_motors
    owners = [
        [motor for motor in wheels if motor.owner is owner]
        for owner in {motor.owner for motor in wheels}
        if owner
    ]
    for held in [*(held for held in owners if len(held) == 2), wheels]:
        if len(held) >= 2:
            return _order_motors(held)
    return None


def _sort_sides(motors: Sequence[Mention], *, of_class: bool) -> WheelMotors | None:
    for left in motors:
        for other in motors:
            if of_class and left.owner is not other.owner:
                continue
            if find_side(left.names) is Side.LEFT and find_side(other.names) is Side.RIGHT:
                return WheelMotors(left.port, other.port, left.where)
    return None


def _order_motors(motors: Sequence[Mention]) -> WheelMotors:
    """Return as the left and right wheel the two motors, of several, that are on the usual ports of wheels.

    The motor on the lower port is the left one unless the program's names for the motors say otherwise.
    """
    by_port = {motor.port: motor for motor in motors}
    left, right = next(pair for pair in _USUAL if by_port.keys() >= set(pair))
    sides = find_side(by_port[left].names), find_side(by_port[right].names)
    # If one name stands for both motors, such as a list `right = [A, B]`, both sides are equal: they are ignored.
    if sides[0] is not sides[1] and (sides[0] is Side.RIGHT or sides[1] is Side.LEFT):
        left, right = right, left
    rest = ", ".join(port for port in by_port if port not in (left, right))
    doubt = (
        f"of the large motors, those on {left} and {right} are taken for the wheels, not {rest}"
        if rest
        else ""
    )
    return WheelMotors(left, right, by_port[left].where, doubt=doubt)


def _choose_usual(
    devices: Sequence[Mention],
    kinds: Mapping[str, DeviceKind],
    usual: RobotSpec,
    other_tools: Collection[str],
) -> WheelMotors:
    """Return the usual ports of the wheels; if other parts of the program are on them, return other ports.

    Args:
        devices: The devices that the program creates.
        kinds: The kind of each motor, by port.
        usual: The usual robot.
        other_tools: Ports of further motors that drive no wheel.
    """
    ports = (usual.left_port, usual.right_port)
    sensors = {device.port for device in devices if not device.kind.is_motor}
    if (
        not other_tools
        and sensors.isdisjoint(ports)
        and all(port in ports and kind is not DeviceKind.MEDIUM for port, kind in kinds.items())
    ):
        return WheelMotors(*ports)
    tools = {device.port for device in devices if is_tool(device.names)} | sensors | {*other_tools}
    stay = [
        port
        for port in ports
        if kinds.get(port, DeviceKind.LARGE) is not DeviceKind.MEDIUM and port not in tools
    ]
    taken = {*kinds, *stay, *tools}
    free = [*stay, *(port for port in usual.output_ports if port not in taken)]
    if len(free) >= 2:
        left = usual.left_port if usual.left_port in free else _pick_other(free, usual.right_port)
        right = usual.right_port if usual.right_port in free else _pick_other(free, left)
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


def _pick_other(ports: Iterable[str], taken: str) -> str:
    return next(port for port in ports if port != taken)


_MAX_MEDIUM = 2
"""As many medium motors as robots have beside two large ones."""


def add_tools(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of motors by port; a motor whose name says that it moves a tool becomes a medium motor."""
    return _add_medium(
        kinds, mentions, [port for port in kinds if is_tool(_list_names(port, mentions))]
    )


def add_others(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of motors that drive no wheel, by port; motors of an unknown kind become medium motors."""
    return _add_medium(kinds, mentions, [*kinds])


def _add_medium(
    kinds: Mapping[str, DeviceKind], mentions: Mentions, others: list[str]
) -> dict[str, DeviceKind]:
    """Return the kinds of motors by port; motors of an unknown kind that drive no wheel become medium motors.

    Motors with a name that says large are unchanged. So are all motors if the program is not for Pybricks on an EV3, or
    if there are more than `_MAX_MEDIUM` others, as EV3 sets have few medium motors.

    Args:
        kinds: The kind of each motor, by port.
        mentions: The devices that the program creates.
        others: The ports of the motors that drive no wheel.
    """
    if mentions.library is not Library.PYBRICKS or mentions.hub or len(others) > _MAX_MEDIUM:
        return dict(kinds)
    unsaid = [
        port
        for port in others
        if kinds[port] is DeviceKind.MOTOR and not is_large(_list_names(port, mentions))
    ]
    return {**kinds, **dict.fromkeys(unsaid, DeviceKind.MEDIUM)}


def _list_names(port: str, mentions: Mentions) -> list[str]:
    return [name for device in mentions.devices if device.port == port for name in device.names]


_DIAMETERS_MM = (15.0, 120.0)
_SPACINGS_MM = (50.0, 350.0)
"""The least and the most that robots have."""


@dataclass(frozen=True, slots=True)
class Size:
    """A length of a wheel or axle in a program, in mm, with the line of the program."""

    mm: float
    where: Where | None = None


def find_sizes(mentions: Mentions) -> dict[str, Size | None]:
    """Return the diameter of the wheels and their distance, in mm, by field of `RobotSpec`.

    They are the numbers in the program whose names mean these sizes. A size is None if it is missing or unclear.
    """
    named = [*_find_named(mentions)]
    wheels = [pair for pair in named if not is_spacing(pair[0])]
    # Without sizes of wheels, a constant such as `track` is ignored, as it may be about music.
    spacings = [pair for pair in named if is_spacing(pair[0])]
    if not wheels:
        spacings = [pair for pair in spacings if pair[0].lower() != "track"]
        wheels = [*_find_in_formulas(mentions)]
    return {
        "wheel_diameter_mm": _pick_diameter(wheels),
        "wheel_spacing_mm": _pick_only(spacings, _SPACINGS_MM),
    }


def _pick_diameter(named: Sequence[tuple[str, Size]]) -> Size | None:
    wheels = [
        *((name, size) for name, size in named if is_diameter(name)),
        *((name, Size(2 * size.mm, size.where)) for name, size in named if is_radius(name)),
    ]
    girths = [
        (name, Size(round(girth / math.pi, 2), size.where))
        for name, size in named
        if (girth := size.mm if is_girth(name) else find_girth(name, size.mm))
    ]
    return _pick_only(wheels, _DIAMETERS_MM) or _pick_only(girths, _DIAMETERS_MM)


def _find_in_formulas(mentions: Mentions) -> Iterator[tuple[str, Size]]:
    """Yield the wheel sizes in a program's formulas, each after its name, such as `wheel_diameter`."""
    for scope in mentions.scopes:
        for node in scope.body:
            if (size := find_formula_size(node)) and isinstance(node, ast.expr):
                yield size[0], Size(size[1], Where(scope.module.file, node.lineno))


def _find_named(mentions: Mentions) -> Iterator[tuple[str, Size]]:
    """Yield the numbers to which a program gives the name of a wheel size, such as `WHEEL_CM`, each after this name.

    Each number is in the unit in which the program has it.
    """
    evaluation = mentions.evaluation
    if evaluation is None:
        return
    for scope in mentions.scopes:
        for name, bindings in (*scope.names.items(), *scope.attributes.items()):
            for binding in bindings if _is_size(name) else ():
                match binding:
                    case Bound(node=node, path=(), is_item=False):
                        values = evaluation.values(node, binding.scope)
                        where = Where(scope.module.file, node.lineno)
                        if is_girth(name) and (size := read_girth(node)):
                            yield size[0], Size(size[1], where)
                    case Parameter(function=function):
                        values = tuple(value for value, _ in evaluation.arguments(binding))
                        where = Where(scope.module.file, function.lineno)
                    case _:
                        continue
                yield from (
                    (name, Size(value, where)) for value in map(_read_number, values) if value
                )
        for inner in scope.body:
            if isinstance(inner, ast.Dict):
                yield from _read_dict(inner, scope)


def _read_dict(node: ast.Dict, scope: Scope) -> Iterator[tuple[str, Size]]:
    where = Where(scope.module.file, node.lineno)
    for key, value in zip(node.keys, node.values, strict=True):
        match key, value:
            case ast.Constant(value=str(name)), ast.Constant(value=number):
                if _is_size(name) and (size := _read_number(number)):
                    yield name, Size(size, where)


def _is_size(name: str) -> bool:
    is_girth_name = is_girth(name) or bool(find_girth(name, 1.0))
    return is_girth_name or is_diameter(name) or is_radius(name) or is_spacing(name)


def _read_number(value: object) -> float:
    """Return a value as a number; 0 if the value is not a number."""
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0


def _pick_only(named: list[tuple[str, Size]], limits: tuple[float, float]) -> Size | None:
    """Return a wheel size in mm if all numbers for it are about equal; None if they differ, or if none is possible.

    Args:
        named: The numbers for the size in the program's units, each after the program's name for it.
        limits: The least and the greatest possible size in mm.
    """
    low, high = limits
    sizes: list[Size] = []
    for name, size in named:
        # A number without a unit may be in mm, cm or m; the unit that gives a size within the limits is taken.
        units = [unit] if (unit := parse_unit_mm(name)) else [1.0, 10.0, 1000.0]
        sizes += [
            Size(round(size.mm * unit, 1), size.where)
            for unit in units
            if low <= size.mm * unit <= high
        ][:1]
    return (
        sizes[0]
        if sizes
        and all(math.isclose(other_size.mm, sizes[0].mm, rel_tol=0.02) for other_size in sizes)
        else None
    )
