"""The effects of commands to the robot: to its gyro, its pen and its parts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from tuisim.engine.core.commands.calls import Values
from tuisim.engine.core.plugged import PART_CODES, PluggedPart, plug_parts

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation

_PLACES = {code: place for place, code in PART_CODES.items()}
"""The role, the port and the class of a part, by their code."""


def encode_parts(parts: Iterable[PluggedPart]) -> Values:
    """Return the values of a `PLUG` command for these parts: the number of each part in `PART_CODES`."""
    return tuple(float(PART_CODES[part.role, part.port, part.part]) for part in parts)


def reset_gyro(sim: Simulation, _time_ns: int, _values: Values) -> None:
    """Set the angle that the gyro shows at the current heading to 0."""
    sim.reset_gyro()


def set_gyro(sim: Simulation, _time_ns: int, values: Values) -> None:
    """Set the angle that the gyro shows at the current heading to `values[0]` degrees, clockwise."""
    sim.reset_gyro(values[0])


def move_pen(sim: Simulation, _time_ns: int, values: Values) -> None:
    """Lower the pen if the value is 1; lift it if the value is 0."""
    sim.pen_down = bool(values[0])


def plug_in(sim: Simulation, _time_ns: int, values: Values) -> None:
    """Plug the parts that the values stand for into the robot, all at the same time.

    Raises:
        ValueError: a value is not the number of a part.
        RobotError: the parts do not fit.
    """
    sim.change_robot(plug_parts(sim.spec.robot, decode_parts(values, sim.tick)))


def decode_parts(values: Iterable[float], tick: int) -> list[PluggedPart]:
    """Return the parts that the values of a `PLUG` command stand for.

    Args:
        values: Numbers of parts, as from `encode_parts`; NaN is ignored.
        tick: The tick after which the parts are plugged in.

    Raises:
        ValueError: a value is not the number of a part.
    """
    codes = [int(code) for code in values if code == code]
    if not _PLACES.keys() >= {*codes}:
        raise ValueError(f"{codes!r} are not all codes of parts")
    places = map(_PLACES.__getitem__, codes)
    return [PluggedPart(port, part, tick, 0, role) for role, port, part in places]
