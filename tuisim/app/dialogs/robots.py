"""Choosing a robot: the list, and beside it the robot from above with its parts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rich.color import Color
from rich.style import Style
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical

from tuisim.app.dialogs.chooser import MAX_NAME_COLUMNS, TABLES, ChoiceGroup, Chooser, list_files
from tuisim.app.dialogs.dialog import WIDTHS
from tuisim.base import palette
from tuisim.base.errors import TuisimError
from tuisim.engine.core.spec import ColorSensorSpec, RobotSpec, SensorSpec
from tuisim.pictures.scene.portrait import draw_portrait, find_part_rgb
from tuisim.settings.robots import ROBOTS, RobotChoice
from tuisim.terminal import cells
from tuisim.terminal.cell_view import LinesPanel, PixelView
from tuisim.terminal.pixels import Rgb
from tuisim.terminal.text_runs import Line

if TYPE_CHECKING:
    from tuisim.app.setup.next_run import NextRun

PROGRAM_ROBOT = "*program"
"""What the dialog returns for the robot that was built from the program's text; it is no name or path."""

_LABEL, _VALUE = Style(color=palette.SOFT), Style(color=palette.WHITE)
_OTHER_ROWS = 12
"""Rows of the dialog that neither the picture of the robot nor the list of its parts takes."""
_MIN_ROWS, _MAX_ROWS = 6, 16


def build_robot_picker(plan: NextRun) -> RobotPicker:
    """Return the dialog with the robots to choose from: the program's own, those known by name, and those in files."""
    built = plan.program_robot
    files = list_files([".toml", ".json"], lambda path: RobotChoice.load(str(path)).spec)
    groups = [
        ChoiceGroup(
            "Built from the program", [(PROGRAM_ROBOT, built.spec.name, "")] if built else []
        ),
        ChoiceGroup("By name" if built else "", [(name, name, "") for name in ROBOTS]),
        files,
    ]
    robots = {**ROBOTS, **({PROGRAM_ROBOT: built.spec} if built else {})}
    current = (
        PROGRAM_ROBOT if built is not None and plan.robot == built else plan.words.get("robot", "")
    )
    return RobotPicker(groups, current, robots)


class RobotPicker(Chooser):
    """The dialog that returns the name or the path of a robot, or `PROGRAM_ROBOT`.

    Args:
        groups: The list.
        current: The current value, selected at first.
        robots: The robots of the list that are not in files, by the value of their entry.
    """

    HORIZONTAL_BREAKPOINTS: list[tuple[int, str]] | None = WIDTHS

    def __init__(
        self, groups: Sequence[ChoiceGroup], current: str, robots: Mapping[str, RobotSpec]
    ) -> None:
        super().__init__(
            "Robots",
            groups,
            current,
            "path of a robot's .toml or .json file",
            RobotChoice.load,
            TABLES,
        )
        self._robots = dict(robots)

    def compose_content(self) -> ComposeResult:
        yield from self.compose_field()
        listed = self.build_list()
        names = (len(name) for group in self._groups for _, name, _ in group.entries)
        listed.styles.width = min(max(names, default=0) + 5, MAX_NAME_COLUMNS)
        with Horizontal(classes="mats"):
            yield listed
            with Vertical():
                yield RobotPicture()
                yield RobotParts()

    def preview(self, value: str) -> None:
        """Show the picture and the parts of a robot; if there is no such robot, show nothing."""
        robot = self._find_robot(value)
        lines = list(describe_parts(robot)) if robot else []
        parts = self.query_one(RobotParts)
        parts.show(lines)
        rows = self.app.size.height - _OTHER_ROWS - parts.rows
        picture = self.query_one(RobotPicture)
        picture.styles.height = min(max(rows, _MIN_ROWS), _MAX_ROWS)
        picture.show(robot)

    def _find_robot(self, name: str) -> RobotSpec | None:
        """Return the robot with a name or a path; None for a file that has changed since it was listed."""
        if name and name not in self._robots:
            try:
                self._robots[name] = RobotChoice.load(name).spec
            except TuisimError:
                return None
        return self._robots.get(name)


class RobotPicture(PixelView):
    """The picture of a robot from above, with its front at the top."""

    def __init__(self) -> None:
        super().__init__()
        self._find_robot: RobotSpec | None = None

    def show(self, robot: RobotSpec | None) -> None:
        """Show a robot; None clears the picture."""
        self._find_robot = robot
        self.draw_picture()

    def draw_picture(self) -> None:
        """Draw the robot again for the present size of the widget."""
        if self._find_robot is None:
            self.clear_picture()
        elif self.size:
            graphics = self.graphics
            mode = self.color_mode
            cell = self.choose_cell(graphics)
            width_px, height_px = cell.cols * self.size.width, cell.rows * self.size.height
            picture = draw_portrait(
                self._find_robot,
                (width_px, height_px),
                cell,
                mono=mode.depth == cells.MONO,
                grey=mode.grey,
            )
            self.set_fine_picture(picture, graphics)


class RobotParts(LinesPanel):
    """A list of the parts of a robot, one per line."""

    def __init__(self) -> None:
        super().__init__()
        self._lines: list[Line] = []

    def show(self, lines: list[Line]) -> None:
        """Show the lines of a robot in the list, one for each part."""
        self._lines = lines
        self.styles.height = self.rows
        self._redraw()

    @property
    def rows(self) -> int:
        """The height in rows that the list of parts needs; at least 1."""
        return max(len(self._lines), 1)

    def _redraw(self) -> None:
        self._text.set_lines(self._lines)


def describe_parts(robot: RobotSpec) -> Iterator[Line]:
    """Yield a line each for the wheels, every further motor and every sensor, with its port and its position."""
    if robot.has_wheels:
        yield _build_line(
            None,
            f"{robot.left_port[-1]} {robot.right_port[-1]}",
            f"wheels ⌀ {robot.wheel_diameter_mm:g}, {robot.wheel_spacing_mm:g} mm apart",
        )
    for motor in robot.extra_motors:
        yield _build_line(None, motor.port[-1], f"{motor.kind} motor")
    for sensor in sorted(robot.sensors, key=lambda other: other.port):
        yield _build_line(
            find_part_rgb(sensor), sensor.port[-1], f"{sensor.name}{_describe_place(sensor)}"
        )


def _build_line(rgb: Rgb | None, port: str, words: str) -> Line:
    dot = ("■ ", Style(color=Color.from_rgb(*rgb))) if rgb else ("  ", _LABEL)
    return [dot, (f"{port:<4}", _LABEL), (words, _VALUE)]


def _describe_place(sensor: SensorSpec) -> str:
    """Return a sensor's position in mm from the robot's centre, and its size, such as `: 10 left, 65 ahead, ⌀ 20`.

    The result is empty for a sensor without a position.
    """
    x_mm, y_mm = getattr(sensor, "x_mm", math.nan), getattr(sensor, "y_mm", math.nan)
    if math.isnan(x_mm):
        return ""
    words = [f"{abs(x_mm):g} {'right' if x_mm > 0 else 'left'}"] if x_mm else []
    words.append(f"{abs(y_mm):g} {'ahead' if y_mm >= 0 else 'behind'}")
    if isinstance(sensor, ColorSensorSpec):
        words.append(f"⌀ {sensor.diameter_mm}")
    return ": " + ", ".join(words)
