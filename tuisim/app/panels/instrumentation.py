"""The instrumentation panel: readings of motors and sensors, pose and time."""

from __future__ import annotations

from tuisim.app.panels.light_lines import (
    LONGEST_NAME,
    build_color_cell,
    build_sensor_line,
    build_sensor_lines,
    list_seen,
)
from tuisim.app.panels.motor_lines import (
    add_states,
    build_driver_line,
    build_extra_motor_lines,
    build_motor_cells,
    build_wheel_lines,
)
from tuisim.app.panels.reading_runs import (
    COLUMN,
    VALUE,
    WARNING,
    fit_line,
    label_run,
    unit_run,
    value_run,
    value_runs,
)
from tuisim.app.panels.titles import build_title, name_setup
from tuisim.app.snapshot import RunPhase, Snapshot, end_label
from tuisim.engine.core.geometry import shown_heading_deg
from tuisim.logs.units import parse_unit
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import Line, Run, cut

_GAP = 2
"""Columns between readings side by side."""
_CELL = 16
"""Columns of a further reading among them."""


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
            name = name_setup(self._snapshot, self.size.width)
            title = build_title(self.app, "instrumentation", name)
            if title != self.border_title:
                self.border_title = title
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
    if tall := _lines_with_drivers(now, width, height):
        return tall
    motors = add_states(build_wheel_lines(now, width), now, width)
    sensors = list_seen(now, "Sensor")
    further = [*build_extra_motor_lines(now, width), *_further_sensors(now, width)]
    small = height < 7 + len(sensors) + len(further)
    if small:
        short = [build_sensor_line(name, seen, width) for name, seen in sensors]
        whole = [*motors, *short, _distance_and_angle(now, width), _place_and_time(now, width)]
        whole += further
        return whole if len(whole) <= height else _side_by_side(now, width, max(height, 1))
    ranging = [_ultrasonic(now, width), _gyro(now, width), *further]
    rest = [*ranging, _pose(now, width), _clock(now, width), _state(now, width)]
    if height < 7 + 2 * len(sensors) + len(further):
        return [*motors, *(build_sensor_line(name, seen, width) for name, seen in sensors), *rest]
    full = [line for name, seen in sensors for line in build_sensor_lines(name, seen, width)]
    if height < 10 + 2 * len(sensors) + len(further):
        return [*motors, *full, *rest]
    return [*motors, [], *full, [], *ranging, [], *rest[len(ranging) :]]


def _further_sensors(now: Snapshot, width: int) -> list[Line]:
    return [_further(column, value, width) for column, value in now.further.items()]


def _lines_with_drivers(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return all lines, those of motors with what their drivers know; none if that is nothing, or they do not fit."""
    drivers = [build_driver_line(values, width) for values in now.instant.motors]
    if not drivers:
        return []
    wheels, extra = build_wheel_lines(now, width), build_extra_motor_lines(now, width)
    groups = [
        [line for pair in zip(wheels, drivers, strict=False) for line in pair],
        [
            line
            for name, seen in list_seen(now, "Sensor")
            for line in build_sensor_lines(name, seen, width)
        ],
        [
            _ultrasonic(now, width),
            _gyro(now, width),
            *(line for pair in zip(extra, drivers[2:], strict=False) for line in pair),
            *_further_sensors(now, width),
        ],
        [_pose(now, width), _clock(now, width), _state(now, width)],
    ]
    free = height - sum(map(len, groups))
    if free < 0:
        return []
    for group in groups[:-1][:free]:
        group.append([])
    return [line for group in groups for line in group]


def _further(column: str, value: float, width: int) -> Line:
    """Return the line of a sensor that not every robot has, by its telemetry column."""
    name, _, what = column.rpartition("_")
    if what == "pressed":
        shown, unit = "pressed" if value else "released", ""
    else:
        sign = parse_unit(column).sign
        shown, unit = f"{value:.0f}", sign if sign == "°" else f" {sign}".rstrip()
    label = name.capitalize()
    return fit_line(
        width,
        (
            label_run(cut(label, COLUMN - 1)),
            value_run(shown if what == "pressed" else f"{shown:>6}"),
            unit_run(unit),
        ),
        (label_run(cut(label, 8), 9), value_run(shown), unit_run(unit)),
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
            line += [
                unit_run(" " * _GAP * bool(used)),
                *cell,
                unit_run(" " * (column - _length(cell))),
            ]
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
            label_run(f"S{at}", 3),
            value_run(f"{seen.name if seen else '–':<{LONGEST_NAME}}"),
            unit_run(" " * _GAP),
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
    robot = now.spec.robot
    motors = build_motor_cells(now, with_speed=detail > 0)
    sensors = [build_color_cell(name, seen, detail > 1) for name, seen in list_seen(now, "S")]
    ranging: list[Line] = []
    if now.ultrasonic_mm is not None:
        ranging.append([label_run("US", 3), *value_runs(f"{now.ultrasonic_mm / 10:5.1f}", "cm")])
    if robot.gyro is not None:
        ranging.append([label_run("Gyro", 5), *value_runs(f"{now.gyro_deg:4d}", "°")])
    ranging += [_further(column, value, _CELL) for column, value in now.further.items()]
    pose = now.instant.pose
    heading = [unit_run("h"), *value_runs(f"{shown_heading_deg(pose.heading_deg):4.0f}", "°")]
    places: list[Line] = [
        [unit_run("x "), value_run(f"{pose.x_mm:4.0f}")],
        [unit_run("y "), value_run(f"{pose.y_mm:4.0f}")],
    ]
    groups = [motors + ranging[:1], sensors + ranging[1:]]
    if not motors or not sensors or max(map(len, groups)) > height:
        cells = motors + sensors + ranging
        groups = [cells[at : at + height] for at in range(0, len(cells), height)]
    last = [*places, heading]
    return [group for group in groups if group] + [
        last[at : at + height] for at in range(0, 3, height)
    ], len(groups)


def _length(line: Line) -> int:
    return sum(len(text) for text, _ in line)


def _ultrasonic(now: Snapshot, width: int) -> Line:
    if now.ultrasonic_mm is None:
        return [label_run("Ultrasonic"), unit_run("none")]
    centimetres = f"{now.ultrasonic_mm / 10:.1f}"
    return fit_line(
        width,
        (
            label_run("Ultrasonic"),
            *value_runs(f"{centimetres:>6}", " cm", f"{now.ultrasonic_mm:8d}", " mm"),
        ),
        (
            label_run("Ultrasonic", 11),
            *value_runs(f"{centimetres:>5}", "cm", f"{now.ultrasonic_mm:5d}", "mm"),
        ),
        (label_run("Ultrasonic", 11), value_run(centimetres), unit_run("cm")),
    )


def _gyro(now: Snapshot, width: int) -> Line:
    if now.spec.robot.gyro is None:
        return [label_run("Gyro"), unit_run("none")]
    return fit_line(
        width,
        (
            label_run("Gyro"),
            *value_runs(f"{now.gyro_deg:6d}", "°   rate", f"{now.gyro_rate_dps:6d}", " °/s"),
        ),
        (
            label_run("Gyro", 7),
            *value_runs(f"{now.gyro_deg}", "° rate ", f"{now.gyro_rate_dps}", "°/s"),
        ),
        (label_run("Gyro", 5), *value_runs(f"{now.gyro_deg}", "° ", f"{now.gyro_rate_dps}", "°/s")),
    )


def _pose(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    shown_deg = shown_heading_deg(pose.heading_deg)
    x, y, heading = f"{pose.x_mm:.1f}", f"{pose.y_mm:.1f}", f"{shown_deg:.1f}"
    return fit_line(
        width,
        (
            label_run("Pose"),
            unit_run("x"),
            *value_runs(f"{x:>7}", "  y", f"{y:>7}", "  heading", f"{heading:>7}", "°"),
        ),
        (
            label_run("Pose"),
            unit_run("x"),
            *value_runs(f"{x:>7}", " y", f"{y:>7}", " h", f"{heading:>7}", "°"),
        ),
        (unit_run("x "), *value_runs(x, " y ", y, " ", heading, "°")),
        (
            *value_runs(f"{pose.x_mm:.0f}", ",", f"{pose.y_mm:.0f}"),
            *value_runs(f" {shown_deg:.0f}", "°"),
        ),
    )


def _speed(now: Snapshot) -> str:
    return f"{now.speed:g}×" if now.speed else "max"


def _clock(now: Snapshot, width: int) -> Line:
    time_s = f"{now.time_s:.2f}"
    return fit_line(
        width,
        (
            label_run("Clock"),
            value_run(f"{time_s:>8}"),
            unit_run(" s   speed "),
            value_run(_speed(now)),
        ),
        (label_run("Clock", 6), value_run(time_s), unit_run(" s  speed "), value_run(_speed(now))),
        (label_run("Clock", 6), value_run(time_s), unit_run("s "), value_run(_speed(now))),
    )


def _state_word(now: Snapshot) -> Run:
    if now.past:
        return "past", VALUE
    if now.placed:
        return "moved", VALUE
    word = end_label(now.end) if now.state == RunPhase.ENDED and now.end else now.state
    return word, WARNING if now.failed else VALUE


def _state(now: Snapshot, width: int) -> Line:
    state, profile, pen = (
        _state_word(now),
        now.spec.profile.name,
        "pen down" if now.pen_down else "pen up",
    )
    return fit_line(
        width,
        (
            label_run("State"),
            (f"{state[0]:<9}", state[1]),
            unit_run(" "),
            value_run(pen.ljust(9)),
            unit_run(" "),
            value_run(profile),
        ),
        (
            label_run("State", 6),
            state,
            unit_run(" · "),
            value_run(pen),
            unit_run(" · "),
            value_run(profile),
        ),
        (label_run("State"), state, unit_run(" · "), value_run(profile)),
        (label_run("State", 6), state, unit_run(" · "), value_run(profile)),
        (state, unit_run("·"), value_run(profile)),
        (state,),
    )


def _distance_and_angle(now: Snapshot, width: int) -> Line:
    centimetres = "–" if now.ultrasonic_mm is None else f"{now.ultrasonic_mm / 10:.1f}"
    angle = "–" if now.spec.robot.gyro is None else f"{now.gyro_deg}"
    far = value_run(f"{centimetres:>6}")
    return fit_line(
        width,
        (
            label_run("Ultrasonic"),
            far,
            unit_run(" cm   Gyro"),
            value_run(f"{angle:>5}"),
            unit_run("°"),
        ),
        (label_run("Ultrasonic", 10), far, unit_run("cm Gyro "), value_run(angle), unit_run("°")),
        (label_run("Ultrasonic", 10), far, unit_run("cm G "), value_run(angle), unit_run("°")),
        (label_run("US", 2), far, unit_run("cm G "), value_run(angle), unit_run("°")),
        (label_run("US", 2), far, unit_run("cm")),
    )


def _place_and_time(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    x, y, heading = (
        f"{pose.x_mm:.0f}",
        f"{pose.y_mm:.0f}",
        f"{shown_heading_deg(pose.heading_deg):.0f}",
    )
    at = unit_run("x "), value_run(x), unit_run(" y "), value_run(y)
    where, named = (
        (*at, unit_run(" "), value_run(heading), unit_run("°")),
        (*at, unit_run(" h "), value_run(heading), unit_run("°")),
    )
    return fit_line(
        width,
        (*named, value_run(f"  {now.time_s:.2f}"), unit_run(" s  "), _state_word(now)),
        (*where, value_run(f"  {now.time_s:.2f}"), unit_run(" s  "), _state_word(now)),
        (*where, value_run(f" {now.time_s:.2f}"), unit_run("s")),
        (
            value_run(x),
            unit_run(","),
            value_run(y),
            value_run(f" {heading}"),
            unit_run("° "),
            value_run(f"{now.time_s:.1f}"),
            unit_run("s"),
        ),
        (value_run(f"{now.time_s:.2f}"), unit_run(" s")),
    )
