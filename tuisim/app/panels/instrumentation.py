"""The instrumentation panel: readings of motors and sensors, pose and time."""

from __future__ import annotations

from collections.abc import Sequence

from rich.style import Style

from tuisim import palette
from tuisim.app.render.arrays import swatch_of
from tuisim.app.snapshot import RunPhase, Snapshot, end_label
from tuisim.core.geometry import shown_heading_deg
from tuisim.core.sensors.color import ColorReading
from tuisim.logs.units import unit_of
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import Line, Run, cut

_LABEL = Style(color=palette.LABEL)
_VALUE = Style(color=palette.WHITE, bold=True)
_UNIT = Style(color=palette.LABEL)
_WARNING = Style(color=palette.RED, bold=True)
_COLUMN = 12
"""Width of the labels if there is room."""
_GAP = 2
"""Columns between readings side by side."""
_CELL = 16
"""Columns of a further reading among them."""
_LONGEST_NAME = 7
"""So that readings do not move when a sensor sees another colour."""


class Instrumentation(LinesPanel):
    """The instrumentation panel. It has four forms, by height: 11 lines, 9 lines, 6 lines, and columns of cells."""

    def __init__(self) -> None:
        super().__init__()
        self._snapshot: Snapshot | None = None

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment."""
        self._snapshot = snapshot
        self._redraw()

    def _redraw(self) -> None:
        if self._snapshot is not None and self._text.size:
            self._text.set_lines(
                lines(self._snapshot, self._text.size.width, self._text.size.height)
            )


def lines(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return the text of a moment for a panel of that inner size.

    Args:
        now: The moment.
        width: Columns, 18 or more for whole words.
        height: Rows; with fewer than 6, the readings stand side by side.
    """
    wheels = [_wheel(now, "LeftMotor", "L", width), _wheel(now, "RightMotor", "R", width)]
    motors = wheels if now.spec.robot.has_wheels else []
    sensors = [
        (f"Sensor{at}", now.colors.get(s.name))
        for at, s in enumerate(now.spec.robot.color_sensors, 1)
    ]
    further = [
        *(
            _motor(
                f"Motor {motor.port[-1]}",
                motor.port[-1],
                round(position),
                _value(f"{round(dps):d}"),
                width,
            )
            for motor, (position, dps) in zip(now.spec.robot.extra_motors, now.turns, strict=False)
        ),
        *(_further(column, value, width) for column, value in now.further.items()),
    ]
    small = height < 7 + len(sensors) + len(further)
    if small:
        short = [_sensor_in_one(name, seen, width) for name, seen in sensors]
        whole = [*motors, *short, _distance_and_angle(now, width), _place_and_time(now, width)]
        whole += further
        return whole if len(whole) <= height else _side_by_side(now, width, max(height, 1))
    ranging = [_ultrasonic(now, width), _gyro(now, width), *further]
    rest = [*ranging, _pose(now, width), _clock(now, width), _state(now, width)]
    if height < 7 + 2 * len(sensors) + len(further):
        return [*motors, *(_sensor_in_one(name, seen, width) for name, seen in sensors), *rest]
    full = [line for name, seen in sensors for line in _sensor(name, seen, width)]
    if height < 10 + 2 * len(sensors) + len(further):
        return [*motors, *full, *rest]
    return [*motors, [], *full, [], *ranging, [], *rest[len(ranging) :]]


def _further(column: str, value: float, width: int) -> Line:
    """Return the line of a sensor that not every robot has, by its telemetry column."""
    name, _, what = column.rpartition("_")
    if what == "pressed":
        shown, unit = "pressed" if value else "released", ""
    else:
        sign = unit_of(column).sign
        shown, unit = f"{value:.0f}", sign if sign == "°" else f" {sign}".rstrip()
    label = name.capitalize()
    return _fit(
        width,
        (
            _label(cut(label, _COLUMN - 1)),
            _value(shown if what == "pressed" else f"{shown:>6}"),
            _unit(unit),
        ),
        (_label(cut(label, 8), 9), _value(shown), _unit(unit)),
    )


def _side_by_side(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return the readings in columns: with speeds and colour names if all fit, then as many as there are.

    The pose goes before names of colours, speeds go before the pose.
    """
    for detail, with_pose in ((2, True), (1, True), (2, False), (1, False), (0, False)):
        columns, sensing = _columns(now, height, detail)
        widths = [max(_length(cell) for cell in column) for column in columns]
        needed = widths if with_pose else widths[:sensing]
        if sum(needed) + _GAP * (len(needed) - 1) <= width:
            break
    lines: list[Line] = [[] for _ in range(height)]
    used = 0
    for column, cells in zip(widths, columns, strict=True):
        if used and used + _GAP + column > width:
            break
        for row, line in enumerate(lines):
            cell = cells[row] if row < len(cells) else []
            line += [_unit(" " * _GAP * bool(used)), *cell, _unit(" " * (column - _length(cell)))]
        used += column + _GAP * bool(used)
    if detail < 2 and (below := max(map(len, columns))) < height:
        lines[below] = _names_of_colors(now, width)
    return lines


def _names_of_colors(now: Snapshot, width: int) -> Line:
    """Return the names of colours in a line, as many as fit."""
    line: Line = []
    for at, sensor in enumerate(now.spec.robot.color_sensors, 1):
        seen = now.colors.get(sensor.name)
        more = [
            _label(f"S{at}", 3),
            _value(f"{seen.name if seen else '–':<{_LONGEST_NAME}}"),
            _unit(" " * _GAP),
        ]
        if _length(line) + _length(more) - _GAP <= width:
            line += more
    return line


def _columns(now: Snapshot, height: int, detail: int) -> tuple[list[list[Line]], int]:
    """Return cells in columns of that height, and how many columns motors and sensors take.

    Args:
        now: The moment.
        height: Cells a column has at most.
        detail: 2 with speeds and names of colours, 1 without names, 0 without both.
    """
    robot, instant = now.spec.robot, now.instant
    wheels = [
        ("L", instant.left_position_deg, instant.left_speed_dps, now.stalled[0]),
        ("R", instant.right_position_deg, instant.right_speed_dps, now.stalled[1]),
    ]
    turns = zip(robot.extra_motors, now.turns, strict=False)
    extra = [(motor.port[-1], position, dps, False) for motor, (position, dps) in turns]
    motors = [
        _motor_cell(*motor, detail > 0) for motor in (wheels if robot.has_wheels else []) + extra
    ]
    colors = [
        (f"S{at}", now.colors.get(sensor.name)) for at, sensor in enumerate(robot.color_sensors, 1)
    ]
    sensors = [_color_cell(name, seen, detail > 1) for name, seen in colors]
    ranging: list[Line] = []
    if now.ultrasonic_mm is not None:
        ranging.append([_label("US", 3), *_values(f"{now.ultrasonic_mm / 10:5.1f}", "cm")])
    if robot.gyro is not None:
        ranging.append([_label("Gyro", 5), *_values(f"{now.gyro_deg:4d}", "°")])
    ranging += [_further(column, value, _CELL) for column, value in now.further.items()]
    pose = now.instant.pose
    heading = [_unit("h"), *_values(f"{shown_heading_deg(pose.heading_deg):4.0f}", "°")]
    places: list[Line] = [
        [_unit("x "), _value(f"{pose.x_mm:4.0f}")],
        [_unit("y "), _value(f"{pose.y_mm:4.0f}")],
    ]
    groups = [motors + ranging[:1], sensors + ranging[1:]]
    if not motors or not sensors or max(map(len, groups)) > height:
        cells = motors + sensors + ranging
        groups = [cells[at : at + height] for at in range(0, len(cells), height)]
    last = [*places, heading]
    return [group for group in groups if group] + [
        last[at : at + height] for at in range(0, 3, height)
    ], len(groups)


def _motor_cell(name: str, counts: float, dps: float, has_stalled: bool, with_speed: bool) -> Line:
    cell: Line = [_label(name, 2), _value(f"{round(counts):5d}")]
    if has_stalled:
        return [*cell, (" stalled" if with_speed else "!", _WARNING)]
    return [*cell, *_values(f"{round(dps):6d}", "°/s")] if with_speed else cell


def _color_cell(name: str, seen: ColorReading | None, with_name: bool) -> Line:
    if seen is None:
        return [_label(name, 3), _unit("–")]
    cell: Line = [_label(name, 3), *_values(f"{seen.red_percent:5.1f}", "% "), swatch_of(seen)]
    return [*cell, _value(f" {seen.name:<{_LONGEST_NAME}}")] if with_name else cell


def _length(line: Line) -> int:
    return sum(len(text) for text, _ in line)


def _fit(width: int, *variants: Sequence[Run]) -> Line:
    """Return the first variant that fits, or the last one."""
    for variant in variants:
        if sum(len(text) for text, _ in variant) <= width:
            return list(variant)
    return list(variants[-1])


def _label(text: str, column: int = _COLUMN) -> Run:
    return text.ljust(column), _LABEL


def _value(text: str) -> Run:
    return text, _VALUE


def _unit(text: str) -> Run:
    return text, _UNIT


def _values(*texts: str) -> list[Run]:
    """Return values, each with the unit after it."""
    return [_unit(text) if at % 2 else _value(text) for at, text in enumerate(texts)]


def _wheel(now: Snapshot, name: str, short: str, width: int) -> Line:
    left = short == "L"
    instant = now.instant
    counts = round(instant.left_position_deg if left else instant.right_position_deg)
    dps = round(instant.left_speed_dps if left else instant.right_speed_dps)
    if now.stalled[0 if left else 1]:
        return _motor(name, short, counts, ("stalled", _WARNING), width)
    return _motor(name, short, counts, _value(f"{dps:d}"), width)


def _motor(name: str, short: str, counts: int, speed: Run, width: int) -> Line:
    """Return the line of a motor's counts and speed, or a warning instead."""
    warns = speed[1] is _WARNING
    unit, close = (_unit(""), _unit("")) if warns else (_unit(" °/s"), _unit("°/s"))
    return _fit(
        width,
        (_label(name), _unit("tacho"), _value(f"{counts:8d}"), _right(speed, 7 + 4 * warns), unit),
        (_label(name, 11), _value(f"{counts:6d}"), _right(speed, 6 + 3 * warns), close),
        (_label(name, 11), _value(f"{counts:d} "), speed, close),
        (_label(short, 2), _value(f"{counts:7d}"), _right(speed, 6 + 3 * warns), close),
    )


def _right(run: Run, width: int) -> Run:
    return run[0].rjust(width), run[1]


def _sensor(name: str, seen: ColorReading | None, width: int) -> tuple[Line, Line]:
    if seen is None:
        return [_label(name), _unit("–")], []
    red, mean = f"{seen.red_percent:5.1f}", f"{seen.mean_percent:5.1f}"
    # 100 without a decimal leaves a space after the word before it.
    short_red, short_mean = (
        f"{value[:3]:>5}" if value == "100.0" else value for value in (red, mean)
    )
    first = _fit(
        width,
        (_label(name), _unit("red "), _value(red), _unit(" %  mean "), _value(mean), _unit(" %")),
        (_label(name, 8), _unit("red"), _value(short_red), _unit(" mean"), _value(short_mean)),
        (_label(name, 8), _value(short_red), _unit(" mean"), _value(short_mean)),
        (_label(name[:1] + name[-1:], 3), _value(short_red), _unit(" mean"), _value(short_mean)),
    )
    channels = [f"{channel}" for channel in seen.rgb]
    wide, narrow = f"({', '.join(channels)})", f"({','.join(channels)})"
    second = _fit(
        width,
        (_label(""), _value(wide.ljust(16)), swatch_of(seen), _value(f" {seen.name}")),
        (_label("", 2), _value(narrow.ljust(14)), swatch_of(seen), _value(f" {seen.name}")),
        (swatch_of(seen), _value(f" {narrow}")),
    )
    return first, second


def _sensor_in_one(name: str, seen: ColorReading | None, width: int) -> Line:
    short = name[:1] + name[-1:]
    if seen is None:
        return _fit(width, (_label(name, 9), _unit("–")), (_label(short, 3), _unit("–")))
    red = f"{seen.red_percent:5.1f}"
    return _fit(
        width,
        (
            _label(name),
            _unit("red "),
            _value(red),
            _unit(" %  "),
            swatch_of(seen),
            _value(f" {seen.name}"),
        ),
        (_label(name, 9), _value(red), _unit("% "), swatch_of(seen), _value(f" {seen.name}")),
        (_label(short, 3), _value(red), _unit("% "), swatch_of(seen), _value(f" {seen.name}")),
    )


def _ultrasonic(now: Snapshot, width: int) -> Line:
    if now.ultrasonic_mm is None:
        return [_label("Ultrasonic"), _unit("none")]
    centimetres = f"{now.ultrasonic_mm / 10:.1f}"
    return _fit(
        width,
        (
            _label("Ultrasonic"),
            *_values(f"{centimetres:>6}", " cm", f"{now.ultrasonic_mm:8d}", " mm"),
        ),
        (
            _label("Ultrasonic", 11),
            *_values(f"{centimetres:>5}", "cm", f"{now.ultrasonic_mm:5d}", "mm"),
        ),
        (_label("Ultrasonic", 11), _value(centimetres), _unit("cm")),
    )


def _gyro(now: Snapshot, width: int) -> Line:
    if now.spec.robot.gyro is None:
        return [_label("Gyro"), _unit("none")]
    return _fit(
        width,
        (
            _label("Gyro"),
            *_values(f"{now.gyro_deg:6d}", "°   rate", f"{now.gyro_rate_dps:6d}", " °/s"),
        ),
        (_label("Gyro", 7), *_values(f"{now.gyro_deg}", "° rate ", f"{now.gyro_rate_dps}", "°/s")),
        (_label("Gyro", 5), *_values(f"{now.gyro_deg}", "° ", f"{now.gyro_rate_dps}", "°/s")),
    )


def _pose(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    shown_deg = shown_heading_deg(pose.heading_deg)
    x, y, heading = f"{pose.x_mm:.1f}", f"{pose.y_mm:.1f}", f"{shown_deg:.1f}"
    return _fit(
        width,
        (
            _label("Pose"),
            _unit("x"),
            *_values(f"{x:>7}", "  y", f"{y:>7}", "  heading", f"{heading:>7}", "°"),
        ),
        (
            _label("Pose"),
            _unit("x"),
            *_values(f"{x:>7}", " y", f"{y:>7}", " h", f"{heading:>7}", "°"),
        ),
        (_unit("x "), *_values(x, " y ", y, " ", heading, "°")),
        (*_values(f"{pose.x_mm:.0f}", ",", f"{pose.y_mm:.0f}"), *_values(f" {shown_deg:.0f}", "°")),
    )


def _speed(now: Snapshot) -> str:
    return f"{now.speed:g}×" if now.speed else "max"


def _clock(now: Snapshot, width: int) -> Line:
    time_s = f"{now.time_s:.2f}"
    return _fit(
        width,
        (_label("Clock"), _value(f"{time_s:>8}"), _unit(" s   speed "), _value(_speed(now))),
        (_label("Clock", 6), _value(time_s), _unit(" s  speed "), _value(_speed(now))),
        (_label("Clock", 6), _value(time_s), _unit("s "), _value(_speed(now))),
    )


def _state_word(now: Snapshot) -> Run:
    if now.past:
        return "past", _VALUE
    if now.placed:
        return "moved", _VALUE
    word = end_label(now.end) if now.state == RunPhase.ENDED and now.end else now.state
    return word, _WARNING if now.failed else _VALUE


def _state(now: Snapshot, width: int) -> Line:
    state, profile, pen = (
        _state_word(now),
        now.spec.profile.name,
        "pen down" if now.pen_down else "pen up",
    )
    return _fit(
        width,
        (
            _label("State"),
            (f"{state[0]:<9}", state[1]),
            _unit(" "),
            _value(pen.ljust(9)),
            _unit(" "),
            _value(profile),
        ),
        (_label("State", 6), state, _unit(" · "), _value(pen), _unit(" · "), _value(profile)),
        (_label("State"), state, _unit(" · "), _value(profile)),
        (_label("State", 6), state, _unit(" · "), _value(profile)),
        (state, _unit("·"), _value(profile)),
        (state,),
    )


def _distance_and_angle(now: Snapshot, width: int) -> Line:
    centimetres = "–" if now.ultrasonic_mm is None else f"{now.ultrasonic_mm / 10:.1f}"
    angle = "–" if now.spec.robot.gyro is None else f"{now.gyro_deg}"
    far = _value(f"{centimetres:>6}")
    return _fit(
        width,
        (_label("Ultrasonic"), far, _unit(" cm   Gyro"), _value(f"{angle:>5}"), _unit("°")),
        (_label("Ultrasonic", 10), far, _unit("cm Gyro "), _value(angle), _unit("°")),
        (_label("Ultrasonic", 10), far, _unit("cm G "), _value(angle), _unit("°")),
        (_label("US", 2), far, _unit("cm G "), _value(angle), _unit("°")),
        (_label("US", 2), far, _unit("cm")),
    )


def _place_and_time(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    x, y, heading = (
        f"{pose.x_mm:.0f}",
        f"{pose.y_mm:.0f}",
        f"{shown_heading_deg(pose.heading_deg):.0f}",
    )
    at = _unit("x "), _value(x), _unit(" y "), _value(y)
    where, named = (
        (*at, _unit(" "), _value(heading), _unit("°")),
        (*at, _unit(" h "), _value(heading), _unit("°")),
    )
    return _fit(
        width,
        (*named, _value(f"  {now.time_s:.2f}"), _unit(" s  "), _state_word(now)),
        (*where, _value(f"  {now.time_s:.2f}"), _unit(" s  "), _state_word(now)),
        (*where, _value(f" {now.time_s:.2f}"), _unit("s")),
        (
            _value(x),
            _unit(","),
            _value(y),
            _value(f" {heading}"),
            _unit("° "),
            _value(f"{now.time_s:.1f}"),
            _unit("s"),
        ),
        (_value(f"{now.time_s:.2f}"), _unit(" s")),
    )
