"""Calls that are about the robot: its gyro, its pen and its parts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from tuisim.engine.core.plugged import MOTOR_PARTS, ROLES, SENSOR_PARTS, PluggedPart, plug_parts
from tuisim.engine.core.spec import INPUT_PORTS, OUTPUT_PORTS

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation

_PARTS = (*MOTOR_PARTS, *SENSOR_PARTS)
_PORTS = (*OUTPUT_PORTS, *INPUT_PORTS)
PART_CODES = len(_PARTS) * len(_PORTS) * len(ROLES)
"""How many codes of parts there are."""


def encode_parts(parts: Iterable[PluggedPart]) -> tuple[float, ...]:
    """Return what `PLUG` takes for parts: a number for each."""
    return tuple(
        float(
            (ROLES.index(part.role) * len(_PORTS) + _PORTS.index(part.port)) * len(_PARTS)
            + _PARTS.index(part.part)
        )
        for part in parts
    )


def reset_gyro(sim: Simulation, _time_ns: int, _part: int, _values: tuple[float, ...]) -> None:
    """Make the current heading the gyro's 0."""
    sim.reset_gyro()


def move_pen(sim: Simulation, _time_ns: int, _part: int, values: tuple[float, ...]) -> None:
    """Lower the pen, or lift it."""
    sim.pen_down = bool(values[0])


def plug_in(sim: Simulation, _time_ns: int, _part: int, values: tuple[float, ...]) -> None:
    """Plug in parts, all at once.

    Raises:
        ValueError: they are no parts.
        RobotError: they do not fit.
    """
    sim.change_robot(plug_parts(sim.spec.robot, decode_parts(values, sim.tick)))


def decode_parts(values: Iterable[float], tick: int) -> list[PluggedPart]:
    """Return the parts that `PLUG` plugs in at a tick.

    Raises:
        ValueError, IndexError: they are no parts.
    """
    return [_decode_part(int(code), tick) for code in values if code == code]


def _decode_part(code: int, tick: int) -> PluggedPart:
    rest, part = divmod(code, len(_PARTS))
    role, port = divmod(rest, len(_PORTS))
    return PluggedPart(_PORTS[port], _PARTS[part], tick, 0, ROLES[role])
