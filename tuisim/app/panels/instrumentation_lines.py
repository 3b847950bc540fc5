"""Lines of the instrumentation panel, for colour sensors and motors: labels, values and units, as far as they fit."""

from __future__ import annotations

from collections.abc import Sequence

from rich.style import Style

from tuisim.app import design
from tuisim.app.render.arrays import build_swatch
from tuisim.app.snapshot import Snapshot
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.engine.core.motor_columns import STATE_BITS
from tuisim.engine.core.sensors.color import ColorReading, LightRead
from tuisim.engine.core.state import MotorValues
from tuisim.programs.facts import read_facts
from tuisim.terminal.text_runs import Line, Run, cut

WORDS = Style(color=palette.LABEL)
"""For labels, units and other words between values."""
VALUE = Style(color=palette.WHITE, bold=True)
WARNING = Style(color=design.RED, bold=True)
COLUMN = 12
"""Width of the labels if there is room."""


def fit_line(width: int, *variants: Sequence[str | Run]) -> Line:
    """Return the first variant of a line that fits a width in cells; if none fits, return the last variant.

    Args:
        width: The width.
        variants: The parts of each variant, as for `style_parts`.
    """
    for variant in variants:
        line = style_parts(*variant)
        if measure_line(line) <= width:
            return line
    return line


def measure_line(line: Line) -> int:
    """Return the width of a line in cells."""
    return sum(len(text) for text, _ in line)


def style_parts(*parts: str | Run) -> Line:
    """Return texts with the styles of the panel: words and values in turn, such as a label, a value and its unit.

    A part that has a style of its own keeps it.
    """
    return [
        part if isinstance(part, tuple) else (part, VALUE if index % 2 else WORDS)
        for index, part in enumerate(parts)
    ]


def pad(label: str, column: int = COLUMN) -> str:
    """Return a label, padded to `column` cells."""
    return label.ljust(column)


MAX_NAME_CELLS = 7
"""Cells for the name of a colour, so that readings do not move when a sensor sees another colour."""

_NAME_CELLS = 6
"""Cells for the name of a sensor, such as `right`, and the space after it."""
_MAX_SENSOR_CELLS = 8
"""Maximum cells for the name of a sensor."""


@dataclass(frozen=True, slots=True)
class LightSeen:
    """A reading of a colour sensor, and which of its numbers the program reads."""

    color: ColorReading
    read: LightRead
    reflected_max: int
    """Value of `reflected_light_intensity` on white."""

    @property
    def value(self) -> str:
        """The number that the program reads, as a text."""
        number = self.read.compute_value(self.color, self.reflected_max)
        if self.read is LightRead.REFLECTED:
            return f"{number:3.0f}"
        return f"{number:5.0f}" if self.read is LightRead.REFLECTION else f"{number:5.1f}"

    @property
    def word(self) -> str:
        """The name of the channels from which the number comes: `red`, or `mean` of all three."""
        return "mean" if self.read.uses_all_channels(self.color) else "red"

    @property
    def unit(self) -> str:
        """The unit of the number that the program reads."""
        return f"/{self.reflected_max}" if self.read is LightRead.REFLECTED else "%"


def list_seen(now: Snapshot) -> list[tuple[str, str, LightSeen | None]]:
    """Return the name, the port and the reading of each colour sensor; a reading is None while the mat is unknown."""
    robot = now.spec.robot
    reads = read_facts(now.program).find_light_reads(robot) if now.program else {}
    lines: list[tuple[str, str, LightSeen | None]] = []
    for sensor in robot.color_sensors:
        color = now.colors.get(sensor.name)
        read = reads.get(sensor.name, LightRead.PERCENT)
        seen = LightSeen(color, read, now.spec.profile.reflected_max) if color else None
        lines.append((cut(sensor.name, _MAX_SENSOR_CELLS), sensor.port, seen))
    return lines


def build_color_cell(name: str, seen: LightSeen | None, with_color: bool) -> Line:
    """Return the reading of a colour sensor as a cell of a column.

    Args:
        name: The name of the sensor.
        seen: Its reading; None while the mat is unknown.
        with_color: Whether to add the name of the colour.
    """
    label = pad(f"{name} ", _NAME_CELLS)
    if seen is None:
        return style_parts(f"{label}–")
    cell = style_parts(label, seen.value, seen.unit, build_swatch(seen.color))
    return [*cell, (f" {seen.color.name:<{MAX_NAME_CELLS}}", VALUE)] if with_color else cell


def build_sensor_lines(
    name: str, port: str, seen: LightSeen | None, width: int
) -> tuple[Line, Line]:
    """Return the reading of a colour sensor in two lines; the second line has the channels and the colour."""
    if seen is None:
        return style_parts(f"{pad(f'{name} {port}')}–"), []
    color = seen.color
    value = seen.value
    unit = seen.unit if seen.read is LightRead.REFLECTED else " %"
    words = seen.word, "red" if seen.word == "mean" else "mean"
    other = f"{color.red_percent if seen.word == 'mean' else color.mean_percent:5.1f}"
    # `100.0` loses its decimal, so that a space is left between it and the word before it.
    short_value, short_other = (
        f"{text[:3]:>5}" if text == "100.0" else f"{text:>5}" for text in (value, other)
    )
    first = fit_line(
        width,
        (pad(f"{name} {port} ") + f"{words[0]} ", value, f"{unit}  {words[1]} ", other, " %"),
        (pad(f"{name} ", _NAME_CELLS) + words[0], short_value, f" {words[1]}", short_other),
        (pad(name, 8), short_value, f" {words[1]}", short_other),
        (pad(name, _NAME_CELLS - 1), short_value, "%"),
    )
    rgb = f"{color.rgb}"
    short_rgb = rgb.replace(" ", "")
    swatch = build_swatch(color)
    second = fit_line(
        width,
        (pad("  color"), rgb.ljust(16), swatch, f" {color.name}"),
        ("  ", short_rgb.ljust(14), swatch, f" {color.name}"),
        (swatch, f" {short_rgb}"),
    )
    return first, second


def build_sensor_line(name: str, port: str, seen: LightSeen | None, width: int) -> Line:
    """Return the reading of a colour sensor in one line."""
    label = pad(f"{name} ", _NAME_CELLS)
    if seen is None:
        return style_parts(f"{label}–")
    color_name = (f" {seen.color.name}", VALUE)
    after = (build_swatch(seen.color), color_name)
    return fit_line(
        width,
        (pad(f"{name} {port} ") + f"{seen.word} ", seen.value, f"{seen.unit:>2}  ", *after),
        (label, seen.value, f"{seen.unit} ", *after),
        (label, seen.value, seen.unit),
    )


_MAX_STATE_CELLS = 10


def build_wheel_lines(now: Snapshot, width: int) -> list[Line]:
    """Return a line for each wheel motor; none for a robot without wheels."""
    if not now.spec.robot.has_wheels:
        return []
    return [
        _build_wheel_line(now, "LeftMotor", "L", width),
        _build_wheel_line(now, "RightMotor", "R", width),
    ]


def build_extra_motor_lines(now: Snapshot, width: int) -> list[Line]:
    """Return a line for each motor that drives no wheel."""
    return [
        _build_motor_line(
            f"Motor {motor.port[-1]}",
            motor.port[-1],
            round(position_deg),
            (f"{round(dps)}", VALUE),
            width,
        )
        for motor, (position_deg, dps) in zip(
            now.spec.robot.extra_motors, now.list_turns()[2:], strict=False
        )
    ]


def build_driver_line(values: MotorValues, scale: float, width: int) -> Line:
    """Return a line with the values of a motor's driver: the commanded speed, the duty cycle and the state.

    Args:
        values: The values.
        scale: How many degrees the program counts for one degree of the motor.
        width: Cells of the line.
    """
    asked_dps, _, duty_pc, state = values
    asked_text = f"{round(asked_dps * scale):5d}"
    duty = f"{round(duty_pc * scale):4d}"
    word = _describe_motor_state(state)
    return fit_line(
        width,
        (pad("") + "asked ", asked_text, " °/s  duty ", duty, " %  ", word),
        ("asked ", asked_text, " °/s  duty ", duty, " %  ", word),
        ("asked ", asked_text, "°/s ", duty, "% ", word),
        ("", asked_text, "°/s ", word),
        (word,),
    )


def add_states(lines: list[Line], now: Snapshot, width: int) -> list[Line]:
    """Return the lines of the wheel motors, each with the state of its driver behind it if that fits."""
    states = [_describe_motor_state(values[3]) for values in now.instant.motors]
    return [
        fit_line(width, (*line, ("  ", WORDS), state), line)
        for line, state in zip(lines, states, strict=False)
    ] or lines


def _describe_motor_state(state: int) -> Run:
    """Return the most important state of a motor, padded; blanks if the motor has no state.

    Args:
        state: The states as flags.
    """
    for word in ("stalled", "overloaded", "holding", "ramping", "running"):
        if state & STATE_BITS[word]:
            return word.ljust(_MAX_STATE_CELLS), WARNING if word == "stalled" else VALUE
    return " " * _MAX_STATE_CELLS, VALUE


def _build_wheel_line(now: Snapshot, name: str, short: str, width: int) -> Line:
    number = "LR".index(short)
    position_deg, dps = now.list_turns()[number]
    if now.instant.motors:
        dps = now.instant.motors[number][1] * now.instant.get_scale(number)
    speed = ("stalled", WARNING) if now.stalled[number] else (f"{round(dps)}", VALUE)
    return _build_motor_line(name, short, round(position_deg), speed, width)


def _build_motor_line(name: str, short: str, counts: int, speed: Run, width: int) -> Line:
    """Return a line with the position of a motor in degrees, and its speed or a warning.

    Args:
        name: The name of the motor.
        short: A shorter name, for a narrow panel.
        counts: The position in degrees.
        speed: The speed in degrees/s, or the warning, as styled text.
        width: Columns inside the border.
    """
    warns = speed[1] is WARNING
    unit, short_unit = ("", "") if warns else (" °/s", "°/s")
    end = (short_unit, WORDS)
    short_speed = _align_right(speed, 6 + 3 * warns)
    return fit_line(
        width,
        (
            pad(name) + "tacho",
            f"{counts:8d}",
            _align_right(speed, 7 + 4 * warns),
            (unit, WORDS),
        ),
        (pad(name, 11), f"{counts:6d}", short_speed, end),
        (pad(name, 11), f"{counts} ", speed, end),
        (pad(short, 2), f"{counts:7d}", short_speed, end),
    )


def build_motor_cells(now: Snapshot, *, with_speed: bool) -> list[Line]:
    """Return a cell for each motor: its position in degrees; if `with_speed`, also its speed or its state."""
    robot = now.spec.robot
    names = ("L", "R", *(motor.port[-1] for motor in robot.extra_motors))
    known = now.instant.motors
    cells = [
        _build_motor_cell(
            name,
            *turn,
            has_stalled=number < len(now.stalled) and now.stalled[number],
            is_held=number < len(known) and bool(known[number][3] & STATE_BITS["holding"]),
            with_speed=with_speed,
        )
        for number, (name, turn) in enumerate(zip(names, now.list_turns(), strict=False))
    ]
    return cells if robot.has_wheels else cells[2:]


def _build_motor_cell(
    name: str, counts: float, dps: float, *, has_stalled: bool, is_held: bool, with_speed: bool
) -> Line:
    cell = style_parts(pad(name, 2), f"{round(counts):5d}")
    if has_stalled:
        return [*cell, (" stalled" if with_speed else "!", WARNING)]
    if is_held and with_speed:
        return [*cell, (" holding", VALUE)]
    return [*cell, (f"{round(dps):6d}", VALUE), ("°/s", WORDS)] if with_speed else cell


def _align_right(run: Run, width: int) -> Run:
    return run[0].rjust(width), run[1]
