"""The lines and cells of motors in the instrumentation panel."""

from __future__ import annotations

from tuisim.app.panels.reading_runs import (
    VALUE,
    WARNING,
    fit_line,
    label_run,
    unit_run,
    value_run,
    value_runs,
)
from tuisim.app.snapshot import Snapshot
from tuisim.engine.core.motor_columns import STATE_BITS
from tuisim.engine.core.state import MotorValues
from tuisim.terminal.text_runs import Line, Run

_LONGEST_STATE = 10


def build_wheel_lines(now: Snapshot, width: int) -> list[Line]:
    """Return the lines of the motors of the wheels; none without wheels."""
    if not now.spec.robot.has_wheels:
        return []
    return [_wheel(now, "LeftMotor", "L", width), _wheel(now, "RightMotor", "R", width)]


def build_extra_motor_lines(now: Snapshot, width: int) -> list[Line]:
    """Return the lines of the motors that drive no wheel."""
    return [
        _motor(
            f"Motor {motor.port[-1]}",
            motor.port[-1],
            round(position),
            value_run(f"{round(dps):d}"),
            width,
        )
        for motor, (position, dps) in zip(now.spec.robot.extra_motors, now.turns, strict=False)
    ]


def build_driver_line(values: MotorValues, width: int) -> Line:
    """Return the line of what the driver of a motor knows."""
    asked_dps, _, duty_pc, state = values
    asked, duty, word = f"{asked_dps:5d}", f"{duty_pc:4d}", _state_of_motor(state)
    return fit_line(
        width,
        (label_run(""), unit_run("asked "), *value_runs(asked, " °/s  duty ", duty, " %  "), word),
        (unit_run("asked "), *value_runs(asked, " °/s  duty ", duty, " %  "), word),
        (unit_run("asked "), *value_runs(asked, "°/s ", duty, "% "), word),
        (*value_runs(asked, "°/s "), word),
        (word,),
    )


def add_states(lines: list[Line], now: Snapshot, width: int) -> list[Line]:
    """Return the lines of wheel motors with the states that their drivers know, where there is room."""
    states = [(*value_runs("", "  "), _state_of_motor(values[3])) for values in now.instant.motors]
    return [
        fit_line(width, (*line, *state), line) for line, state in zip(lines, states, strict=False)
    ] or lines


def _state_of_motor(state: int) -> Run:
    """Return the state of a motor that tells most."""
    for word in ("stalled", "overloaded", "holding", "ramping", "running"):
        if state & STATE_BITS[word]:
            return word.ljust(_LONGEST_STATE), WARNING if word == "stalled" else VALUE
    return " " * _LONGEST_STATE, VALUE


def _wheel(now: Snapshot, name: str, short: str, width: int) -> Line:
    left = short == "L"
    instant = now.instant
    counts = round(instant.left_position_deg if left else instant.right_position_deg)
    dps = round(instant.left_speed_dps if left else instant.right_speed_dps)
    if instant.motors:
        dps = instant.motors[0 if left else 1][1]
    if now.stalled[0 if left else 1]:
        return _motor(name, short, counts, ("stalled", WARNING), width)
    return _motor(name, short, counts, value_run(f"{dps:d}"), width)


def _motor(name: str, short: str, counts: int, speed: Run, width: int) -> Line:
    """Return the line of a motor's counts and speed, or a warning instead."""
    warns = speed[1] is WARNING
    unit, close = (unit_run(""), unit_run("")) if warns else (unit_run(" °/s"), unit_run("°/s"))
    return fit_line(
        width,
        (
            label_run(name),
            unit_run("tacho"),
            value_run(f"{counts:8d}"),
            _right(speed, 7 + 4 * warns),
            unit,
        ),
        (label_run(name, 11), value_run(f"{counts:6d}"), _right(speed, 6 + 3 * warns), close),
        (label_run(name, 11), value_run(f"{counts:d} "), speed, close),
        (label_run(short, 2), value_run(f"{counts:7d}"), _right(speed, 6 + 3 * warns), close),
    )


def build_motor_cells(now: Snapshot, *, with_speed: bool) -> list[Line]:
    """Return a cell for each motor: counts, and with speed also speed or state."""
    instant, robot = now.instant, now.spec.robot
    wheels = (
        ("L", instant.left_position_deg, instant.left_speed_dps),
        ("R", instant.right_position_deg, instant.right_speed_dps),
    )
    turns = zip(robot.extra_motors, now.turns, strict=False)
    extra = ((motor.port[-1], position, dps) for motor, (position, dps) in turns)
    known = instant.motors
    cells = [
        _motor_cell(
            *motor,
            has_stalled=number < len(now.stalled) and now.stalled[number],
            is_held=number < len(known) and bool(known[number][3] & STATE_BITS["holding"]),
            with_speed=with_speed,
        )
        for number, motor in enumerate((*wheels, *extra))
    ]
    return cells if robot.has_wheels else cells[2:]


def _motor_cell(
    name: str, counts: float, dps: float, *, has_stalled: bool, is_held: bool, with_speed: bool
) -> Line:
    cell: Line = [label_run(name, 2), value_run(f"{round(counts):5d}")]
    if has_stalled:
        return [*cell, (" stalled" if with_speed else "!", WARNING)]
    if is_held and with_speed:
        return [*cell, value_run(" holding")]
    return [*cell, *value_runs(f"{round(dps):6d}", "°/s")] if with_speed else cell


def _right(run: Run, width: int) -> Run:
    return run[0].rjust(width), run[1]
