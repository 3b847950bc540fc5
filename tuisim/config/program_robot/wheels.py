"""Which motors of a program drive the wheels."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

from tuisim.config.program_robot.library import DeviceKind
from tuisim.config.program_robot.mentions import Mention, Mentions, Pair, Where
from tuisim.config.program_robot.words import Side, means_tool, side_of
from tuisim.core.spec import NO_PORT, OUTPUT_PORTS, RobotSpec
from tuisim.data_class import dataclass

_USUAL = (
    ("outB", "outC"),
    ("outA", "outD"),
    ("outA", "outB"),
    ("outC", "outD"),
    ("outA", "outC"),
    ("outB", "outD"),
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
        f"{others[0].class_name} on {others[0].left} and {others[0].right} is taken for no wheels"
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
    free = [*stay, *(port for port in OUTPUT_PORTS if port not in kinds and port not in stay)]
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
