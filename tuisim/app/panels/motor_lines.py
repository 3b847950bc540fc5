"""The lines and cells of motors in the instrumentation panel."""

from __future__ import annotations

from tuisim.app.panels.reading_runs import (
    VALUE,
    WARNING,
    fit_line,
    format_label,
    format_unit,
    format_value,
    format_values,
)
from tuisim.app.snapshot import Snapshot
from tuisim.engine.core.motor_columns import STATE_BITS
from tuisim.engine.core.state import MotorValues
from tuisim.terminal.text_runs import Line, Run

_MAX_STATE_CELLS = 10


def build_wheel_lines(now: Snapshot, width: int) -> list[Line]:
    """Return the lines of the motors of the wheels; none without wheels."""
    if not now.spec.robot.has_wheels:
        return []
    return [
        _build_wheel_line(now, "LeftMotor", "L", width),
        _build_wheel_line(now, "RightMotor", "R", width),
    ]


def build_extra_motor_lines(now: Snapshot, width: int) -> list[Line]:
    """Return the lines of the motors that drive no wheel."""
    return [
        _build_motor_line(
            f"Motor {motor.port[-1]}",
            motor.port[-1],
            round(position),
            format_value(f"{round(dps):d}"),
            width,
        )
        for motor, (position, dps) in zip(now.spec.robot.extra_motors, now.turns, strict=False)
    ]


def build_driver_line(values: MotorValues, width: int) -> Line:
    """Return the line with the values of a motor's driver: the speed asked for, the duty and the state."""
    asked_dps, _, duty_pc, state = values
    asked_text = f"{asked_dps:5d}"
    duty = f"{duty_pc:4d}"
    word = _describe_motor_state(state)
    return fit_line(
        width,
        (
            format_label(""),
            format_unit("asked "),
            *format_values(asked_text, " °/s  duty ", duty, " %  "),
            word,
        ),
        (format_unit("asked "), *format_values(asked_text, " °/s  duty ", duty, " %  "), word),
        (format_unit("asked "), *format_values(asked_text, "°/s ", duty, "% "), word),
        (*format_values(asked_text, "°/s "), word),
        (word,),
    )


def add_states(lines: list[Line], now: Snapshot, width: int) -> list[Line]:
    """Return the lines of wheel motors with the states that their drivers know, where there is room."""
    states = [
        (*format_values("", "  "), _describe_motor_state(values[3]))
        for values in now.instant.motors
    ]
    return [
        fit_line(width, (*line, *state), line) for line, state in zip(lines, states, strict=False)
    ] or lines


def _describe_motor_state(state: int) -> Run:
    """Return the most important state of a motor, padded; blanks if it has none."""
    for word in ("stalled", "overloaded", "holding", "ramping", "running"):
        if state & STATE_BITS[word]:
            return word.ljust(_MAX_STATE_CELLS), WARNING if word == "stalled" else VALUE
    return " " * _MAX_STATE_CELLS, VALUE


def _build_wheel_line(now: Snapshot, name: str, short: str, width: int) -> Line:
    left = short == "L"
    instant = now.instant
    counts = round(instant.left_position_deg if left else instant.right_position_deg)
    dps = round(instant.left_speed_dps if left else instant.right_speed_dps)
    if instant.motors:
        dps = instant.motors[0 if left else 1][1]
    if now.stalled[0 if left else 1]:
        return _build_motor_line(name, short, counts, ("stalled", WARNING), width)
    return _build_motor_line(name, short, counts, format_value(f"{dps:d}"), width)


def _build_motor_line(name: str, short: str, counts: int, speed: Run, width: int) -> Line:
    """Return the line of a motor's counts and speed, or a warning instead."""
    warns = speed[1] is WARNING
    unit, close = (
        (format_unit(""), format_unit("")) if warns else (format_unit(" °/s"), format_unit("°/s"))
    )
    return fit_line(
        width,
        (
            format_label(name),
            format_unit("tacho"),
            format_value(f"{counts:8d}"),
            _align_right(speed, 7 + 4 * warns),
            unit,
        ),
        (
            format_label(name, 11),
            format_value(f"{counts:6d}"),
            _align_right(speed, 6 + 3 * warns),
            close,
        ),
        (format_label(name, 11), format_value(f"{counts:d} "), speed, close),
        (
            format_label(short, 2),
            format_value(f"{counts:7d}"),
            _align_right(speed, 6 + 3 * warns),
            close,
        ),
    )


def build_motor_cells(now: Snapshot, *, with_speed: bool) -> list[Line]:
    """Return a cell for each motor: counts, and with speed also speed or state."""
    instant = now.instant
    robot = now.spec.robot
    wheels = (
        ("L", instant.left_position_deg, instant.left_speed_dps),
        ("R", instant.right_position_deg, instant.right_speed_dps),
    )
    turns = zip(robot.extra_motors, now.turns, strict=False)
    extra = ((motor.port[-1], position, dps) for motor, (position, dps) in turns)
    known = instant.motors
    cells = [
        _build_motor_cell(
            *motor,
            has_stalled=number < len(now.stalled) and now.stalled[number],
            is_held=number < len(known) and bool(known[number][3] & STATE_BITS["holding"]),
            with_speed=with_speed,
        )
        for number, motor in enumerate((*wheels, *extra))
    ]
    return cells if robot.has_wheels else cells[2:]


def _build_motor_cell(
    name: str, counts: float, dps: float, *, has_stalled: bool, is_held: bool, with_speed: bool
) -> Line:
    cell: Line = [format_label(name, 2), format_value(f"{round(counts):5d}")]
    if has_stalled:
        return [*cell, (" stalled" if with_speed else "!", WARNING)]
    if is_held and with_speed:
        return [*cell, format_value(" holding")]
    return [*cell, *format_values(f"{round(dps):6d}", "°/s")] if with_speed else cell


def _align_right(run: Run, width: int) -> Run:
    return run[0].rjust(width), run[1]
