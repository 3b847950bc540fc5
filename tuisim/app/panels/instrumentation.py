"""The instrumentation panel: readings of motors and sensors, pose and time."""

from __future__ import annotations

import itertools

from tuisim.app.panels.instrumentation_lines import (
    COLUMN,
    MAX_NAME_CELLS,
    VALUE,
    WARNING,
    WORDS,
    add_states,
    build_color_cell,
    build_driver_line,
    build_extra_motor_lines,
    build_motor_cells,
    build_sensor_line,
    build_sensor_lines,
    build_wheel_lines,
    fit_line,
    list_seen,
    measure_line,
    pad,
    style_parts,
)
from tuisim.app.panels.titles import build_title, name_setup
from tuisim.app.snapshot import Snapshot
from tuisim.engine.core.geometry import shown_heading_deg
from tuisim.logs.units import parse_unit
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import Line, Run, cut

_GAP = 2
"""Columns between readings side by side."""
_CELL = 16
"""Columns of a further reading among them."""


class Instrumentation(LinesPanel, can_focus=True):
    """The instrumentation panel: the readings of motors and sensors, and the pose.

    The panel has four forms, by height: 11 lines, 9 lines, 6 lines, and columns of cells.
    """

    def __init__(self) -> None:
        super().__init__()
        self._snapshot: Snapshot | None = None

    def show(self, snapshot: Snapshot) -> None:
        """Show the readings at an instant of the run."""
        self._snapshot = snapshot
        self._redraw()

    def _redraw(self) -> None:
        if self._snapshot is not None and self._text.size:
            name = name_setup(self._snapshot, self.size.width)
            title = build_title(self.app, "instrumentation", name)
            if title != self.border_title:
                self.border_title = title
            width, height = self._text.size
            self.border_subtitle = build_subtitle(self._snapshot, height)
            self._text.set_lines(build_lines(self._snapshot, width, height))


def build_subtitle(now: Snapshot, height: int) -> str:
    """Return the time and the state of the run for the frame of a panel that has no room for lines about them.

    The text is empty for a panel that is high enough.
    """
    return f"{now.time_s:.2f} s {now.state_label}{now.turning}" if _is_small(now, height) else ""


def _is_small(now: Snapshot, height: int) -> bool:
    return height < _count_rows(now)


def _count_rows(now: Snapshot) -> int:
    """Return how many rows the readings need if each part of the robot, the pose, clock and state have one each."""
    robot = now.spec.robot
    ranging = (robot.ultrasonic is not None) + (robot.gyro is not None)
    return 5 + ranging + len(robot.color_sensors) + len(robot.extra_motors) + len(now.further)


def build_lines(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return the readings at an instant as lines of the instrumentation panel.

    Args:
        now: The instant.
        width: Columns inside the border; 18 or more for whole words.
        height: Rows inside the border; with fewer than 6, the readings stand side by side.
    """
    if tall := _build_tall_lines(now, width, height):
        return tall
    motors = add_states(build_wheel_lines(now, width), now, width)
    sensors = list_seen(now)
    further = [*build_extra_motor_lines(now, width), *_build_sensor_lines(now, width)]
    if _is_small(now, height):
        short = [build_sensor_line(*sensor, width) for sensor in sensors]
        whole = [*motors, *short, *_build_ranging_line(now, width), _place_and_time(now, width)]
        whole += further
        return whole if len(whole) <= height else _build_columns_text(now, width, max(height, 1))
    ranging = [*_build_ranging_lines(now, width), *further]
    rest = [
        *ranging,
        _build_pose_line(now, width),
        _build_clock_line(now, width),
        _build_state_line(now, width),
    ]
    rows = _count_rows(now) + len(sensors)
    if height < rows:
        return [*motors, *(build_sensor_line(*sensor, width) for sensor in sensors), *rest]
    full = [line for sensor in sensors for line in build_sensor_lines(*sensor, width)]
    if height < rows + 3:
        return [*motors, *full, *rest]
    return [*motors, [], *full, [], *ranging, [], *rest[len(ranging) :]]


def _build_sensor_lines(now: Snapshot, width: int) -> list[Line]:
    return [_build_further_line(column, value, width) for column, value in now.further.items()]


def _build_tall_lines(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return the readings with a further line for each motor: the values of its driver.

    The result is empty if no motor has these values, or if there would be more lines than `height`.
    """
    drivers = [
        build_driver_line(values, now.instant.get_scale(number), width)
        for number, values in enumerate(now.instant.motors)
    ]
    if not drivers:
        return []
    wheels = build_wheel_lines(now, width)
    extra = build_extra_motor_lines(now, width)
    groups = [
        [line for pair in zip(wheels, drivers, strict=False) for line in pair],
        [line for sensor in list_seen(now) for line in build_sensor_lines(*sensor, width)],
        [
            *_build_ranging_lines(now, width),
            *(line for pair in zip(extra, drivers[2:], strict=False) for line in pair),
            *_build_sensor_lines(now, width),
        ],
        [
            _build_pose_line(now, width),
            _build_clock_line(now, width),
            _build_state_line(now, width),
        ],
    ]
    free = height - sum(map(len, groups))
    if free < 0:
        return []
    for group in groups[:-1][:free]:
        group.append([])
    return [line for group in groups for line in group]


def _build_further_line(column: str, value: float, width: int) -> Line:
    """Return the line with the reading of a sensor that most robots do not have.

    Args:
        column: The telemetry column of the reading, such as `bumper_pressed`.
        value: The reading.
        width: Columns inside the border.
    """
    name, _, what = column.rpartition("_")
    if what == "pressed":
        value_text = "pressed" if value else "released"
        unit = ""
    else:
        sign = parse_unit(column).sign
        value_text = f"{value:.0f}"
        unit = sign if sign == "°" else f" {sign}".rstrip()
    label = name.capitalize()
    shown_text = value_text if what == "pressed" else f"{value_text:>6}"
    return fit_line(
        width,
        (pad(cut(label, COLUMN - 1)), shown_text, unit),
        (pad(cut(label, 8), 9), value_text, unit),
    )


def _build_columns_text(now: Snapshot, width: int, height: int) -> list[Line]:
    """Return the readings in columns, with as much detail as the width allows.

    If not everything fits, the first of these steps that is enough is taken: leave out the names of the colours; leave
    out the pose; leave out both; leave out the speeds as well; leave out whole columns.
    """
    for detail, with_pose in ((2, True), (1, True), (2, False), (1, False), (0, False)):
        columns, sensing = _arrange_cells(now, height, detail)
        widths = [max(measure_line(cell) for cell in column) for column in columns]
        needed = widths if with_pose else widths[:sensing]
        gap = _GAP if _measure_columns(needed, _GAP) <= width else 1
        if _measure_columns(needed, gap) <= width:
            break
    lines: list[Line] = [[] for _ in range(height)]
    used = 0
    for column, cells in zip(widths, columns, strict=True):
        if used and used + gap + column > width:
            break
        for row, line in enumerate(lines):
            cell = cells[row] if row < len(cells) else []
            line += [
                (" " * gap * bool(used), WORDS),
                *cell,
                (" " * (column - measure_line(cell)), WORDS),
            ]
        used += column + gap * bool(used)
    if detail < 2 and (below := max(map(len, columns))) < height:
        lines[below] = _build_color_names(now, width)
    if used < _measure_columns(widths, gap):
        _add_pose(lines, columns[:sensing], columns[sensing:], width)
    return lines


def _add_pose(
    lines: list[Line], columns: list[list[Line]], places: list[list[Line]], width: int
) -> None:
    """Write the pose behind a reading; if there is room for it in no row, leave it out.

    The pose goes to the last row that has exactly one reading and enough room.

    Args:
        lines: The rows of the panel; the row with the pose is replaced.
        columns: The columns of readings.
        places: The cells of the pose, in columns.
        width: Columns inside the border.
    """
    pose: Line = []
    for place in itertools.chain.from_iterable(places):
        pose += [(" " * (_GAP if not pose else 1), WORDS), *place]
    for row in reversed(range(len(lines))):
        readings = [cells[row] for cells in columns if row < len(cells)]
        is_single = len(readings) == 1 and row < len(columns[0])
        if is_single and measure_line(readings[0]) + measure_line(pose) <= width:
            lines[row] = [*readings[0], *pose]
            return


def _measure_columns(widths: list[int], gap: int) -> int:
    return sum(widths) + gap * (len(widths) - 1)


def _build_color_names(now: Snapshot, width: int) -> Line:
    """Return one line with the names of the colours that the sensors see, as many as fit."""
    line: Line = []
    for name, _, seen in list_seen(now):
        gap = " " * _GAP * bool(line)
        more = style_parts(f"{gap}{name} ", f"{seen.color.name if seen else '–':<{MAX_NAME_CELLS}}")
        if measure_line(line) + measure_line(more) <= width:
            line += more
    return line


def _arrange_cells(now: Snapshot, height: int, detail: int) -> tuple[list[list[Line]], int]:
    """Return the readings as columns of cells, and how many of these columns the motors and sensors fill.

    Args:
        now: The instant.
        height: The largest number of cells in a column.
        detail: 2 for speeds and names of colours, 1 for speeds only, 0 for neither.
    """
    robot = now.spec.robot
    motors = build_motor_cells(now, with_speed=detail > 0)
    sensors = [build_color_cell(name, seen, detail > 1) for name, _, seen in list_seen(now)]
    ranging: list[Line] = []
    if now.ultrasonic_mm is not None:
        ranging.append(style_parts("US ", f"{now.ultrasonic_mm / 10:5.1f}", "cm"))
    if robot.gyro is not None:
        ranging.append(style_parts("Gyro ", f"{now.gyro_deg:4d}", "°"))
    ranging += [_build_further_line(column, value, _CELL) for column, value in now.further.items()]
    pose = now.instant.pose
    heading = f"{shown_heading_deg(pose.heading_deg):z4.0f}"
    places = [
        style_parts("x ", f"{pose.x_mm:z4.0f}"),
        style_parts("y ", f"{pose.y_mm:z4.0f}"),
        style_parts("h ", heading),
    ]
    groups = [motors + ranging[:1], sensors + ranging[1:]]
    if not motors or not sensors or max(map(len, groups)) > height:
        cells = motors + sensors + ranging
        groups = [cells[start : start + height] for start in range(0, len(cells), height)]
    return [group for group in groups if group] + [
        places[start : start + height] for start in range(0, 3, height)
    ], len(groups)


def _build_ranging_lines(now: Snapshot, width: int) -> list[Line]:
    """Return a line for the ultrasonic sensor and one for the gyro, if the robot has them."""
    lines = []
    if now.ultrasonic_mm is not None:
        lines.append(_build_ultrasonic_line(now.ultrasonic_mm, width))
    if now.spec.robot.gyro is not None:
        lines.append(_build_gyro_line(now, width))
    return lines


def _build_ultrasonic_line(far_mm: int, width: int) -> Line:
    centimetres = f"{far_mm / 10:.1f}"
    return fit_line(
        width,
        (pad("Ultrasonic"), f"{centimetres:>6}", " cm", f"{far_mm:8d}", " mm"),
        (pad("Ultrasonic", 11), f"{centimetres:>5}", "cm", f"{far_mm:5d}", "mm"),
        (pad("Ultrasonic", 11), centimetres, "cm"),
    )


def _build_gyro_line(now: Snapshot, width: int) -> Line:
    angle = f"{now.gyro_deg}"
    rate = f"{now.gyro_rate_dps}"
    return fit_line(
        width,
        (pad("Gyro"), f"{angle:>6}", "°   rate", f"{rate:>6}", " °/s"),
        (pad("Gyro", 7), angle, "° rate ", rate, "°/s"),
        (pad("Gyro", 5), angle, "° ", rate, "°/s"),
    )


def _build_pose_line(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    shown_deg = shown_heading_deg(pose.heading_deg)
    x = f"{pose.x_mm:z.1f}"
    y = f"{pose.y_mm:z.1f}"
    heading = f"{shown_deg:z.1f}"
    return fit_line(
        width,
        (pad("Pose") + "x", f"{x:>7}", "  y", f"{y:>7}", "  heading", f"{heading:>7}", "°"),
        (pad("Pose") + "x", f"{x:>7}", " y", f"{y:>7}", " h", f"{heading:>7}", "°"),
        ("x ", x, " y ", y, " ", heading, "°"),
        ("", f"{pose.x_mm:z.0f}", ",", f"{pose.y_mm:z.0f} {shown_deg:z.0f}", "°"),
    )


def _build_clock_line(now: Snapshot, width: int) -> Line:
    time_s = f"{now.time_s:.2f}"
    speed = f"{now.speed:g}×" if now.speed else "max"
    return fit_line(
        width,
        (pad("Clock"), f"{time_s:>8}", " s   speed ", speed),
        (pad("Clock", 6), time_s, " s  speed ", speed),
        (pad("Clock", 6), time_s, "s ", speed),
    )


def _format_state(now: Snapshot) -> Run:
    return now.state_label, WARNING if now.failed else VALUE


def _build_state_line(now: Snapshot, width: int) -> Line:
    state = _format_state(now)
    profile = now.spec.profile.name
    pen = "pen down" if now.pen_down else "pen up"
    turning = [(pad("State"), state, now.turning)] * bool(now.turning)
    return fit_line(
        width,
        *turning,
        (pad("State"), (f"{state[0]:<9}", state[1]), " ", pen.ljust(9), " ", profile),
        (pad("State", 6), state, " · ", pen, " · ", profile),
        (pad("State"), state, " · ", profile),
        (pad("State", 6), state, " · ", profile),
        ("", state, "·", profile),
        (state,),
    )


def _build_ranging_line(now: Snapshot, width: int) -> list[Line]:
    """Return one line for the ultrasonic sensor and the gyro, or none if the robot has neither."""
    if now.ultrasonic_mm is None or now.spec.robot.gyro is None:
        return _build_ranging_lines(now, width)
    centimetres = f"{now.ultrasonic_mm / 10:.1f}"
    angle = f"{now.gyro_deg}"
    far = f"{centimetres:>6}"
    line = fit_line(
        width,
        (pad("Ultrasonic"), far, " cm   Gyro", f"{angle:>5}", "°"),
        (pad("Ultrasonic", 10), far, "cm Gyro ", angle, "°"),
        (pad("Ultrasonic", 10), far, "cm G ", angle, "°"),
        ("US", far, "cm G ", angle, "°"),
        ("US", far, "cm"),
    )
    return [line]


def _place_and_time(now: Snapshot, width: int) -> Line:
    pose = now.instant.pose
    x = f"{pose.x_mm:z.0f}"
    y = f"{pose.y_mm:z.0f}"
    heading = f"{shown_heading_deg(pose.heading_deg):z.0f}"
    time_s = f"{now.time_s:.2f}"
    state = _format_state(now)
    return fit_line(
        width,
        ("x ", x, " y ", y, " h ", heading, "°", f"  {time_s}", " s  ", state),
        ("x ", x, " y ", y, " ", heading, "°", f"  {time_s}", " s  ", state),
        ("x ", x, " y ", y, " ", heading, "°", f" {time_s}", "s"),
        ("", x, ",", f"{y} {heading}", "° ", f"{now.time_s:.1f}", "s"),
        ("", time_s, " s"),
    )
