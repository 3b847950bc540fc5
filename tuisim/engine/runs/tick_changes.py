"""What the commands of a program change at once: values that the record of their tick, made before, does not have."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from tuisim.engine.core.commands.calls import Call, SimulationCommand, Values
from tuisim.engine.core.profile import DRIVEN_LAWS, MotorLaw
from tuisim.engine.core.servo.settings import COUNTS_PER_DEG
from tuisim.engine.core.servo.trajectory import MILLI
from tuisim.engine.core.state import Instant

IMMEDIATE_CALLS = (
    Call.RESET_GYRO,
    Call.SET_GYRO,
    Call.MOVE_PEN,
    Call.STOP,
    Call.SET_COUNT,
    Call.RENUMBER,
    Call.RESET_DRIVER,
    Call.SET_MILLI,
    Call.SET_UP,
)
"""The commands that change at once what the program reads."""


def apply_commands(
    instant: Instant,
    running: tuple[bool, bool],
    commands: Iterable[SimulationCommand],
    law: MotorLaw,
) -> Instant:
    """Return an instant with the changes that commands in its tick make immediately, such as a reset of the gyro.

    A program that reads a value after these commands gets it from this instant.

    Args:
        instant: The values that the record of the tick has.
        running: Whether the motors of the left and the right wheel were running when the record was made.
        commands: The commands in the tick, in order.
        law: How the motors of the run move.
    """
    positions_deg = [instant.left_position_deg, instant.right_position_deg]
    speeds_dps = [instant.left_speed_dps, instant.right_speed_dps]
    zero_deg = instant.gyro_zero_deg
    if law in DRIVEN_LAWS:
        # A motor without inertia that ended its move in this tick still has the mean speed of the tick there.
        speeds_dps = [dps * is_on for dps, is_on in zip(speeds_dps, running, strict=True)]
    for _, part, call, values in commands:
        if call in (Call.RESET_GYRO, Call.SET_GYRO) and math.isfinite(values[0]):
            zero_deg = instant.pose.heading_deg + values[0]
        elif call is Call.STOP and part < len(speeds_dps):
            speeds_dps[part] = 0.0
        elif part < len(positions_deg):
            position_deg = _find_position_deg(call, values, instant.get_scale(part))
            if position_deg is not None and math.isfinite(position_deg):
                positions_deg[part] = position_deg
    return replace(
        instant,
        left_position_deg=positions_deg[0],
        right_position_deg=positions_deg[1],
        left_speed_dps=speeds_dps[0],
        right_speed_dps=speeds_dps[1],
        gyro_zero_deg=zero_deg,
    )


def find_pen(commands: Iterable[SimulationCommand], *, is_down: bool) -> bool:
    """Return whether the pen is down after some commands; `is_down` says whether it was down before them."""
    moves = [bool(values[0]) for _, _, call, values in commands if call is Call.MOVE_PEN]
    return moves[-1] if moves else is_down


def _find_position_deg(call: Call, values: Values, scale: float) -> float | None:
    """Return the position in degrees that a command makes a motor report, without turning it; None for other commands.

    Args:
        call: The kind of command.
        values: Its values.
        scale: How many degrees the program counts while the motor turns by one degree.
    """
    match call:
        case Call.SET_COUNT | Call.RENUMBER:
            return values[0]
        case Call.SET_MILLI:
            return math.copysign(values[0] / (MILLI * COUNTS_PER_DEG), values[0] * scale)
        case Call.RESET_DRIVER:
            return 0.0
        case Call.SET_UP if not values[2]:
            return 0.0
        case _:
            return None
