"""Output of a cell: images and tables that are updated while the program runs, and then remain."""

from __future__ import annotations

import html
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from IPython.core.getipython import get_ipython
from IPython.display import DisplayHandle, display

from tuisim.base.data_class import dataclass
from tuisim.base.source import Program, source_lines
from tuisim.engine.core.end_stops import build_start_flags
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import shown_heading_deg
from tuisim.engine.core.sensors import measure_sensors
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.runs.command_events import CommandIndex
from tuisim.engine.runs.samples import Sample
from tuisim.engine.runs.views import TickRecord
from tuisim.pictures.charts.files import draw_image, encode_png
from tuisim.pictures.charts.sample_chart import build_sample_chart
from tuisim.pictures.movies.arrays import FACE_PX, draw_arrays
from tuisim.pictures.scene.discs import DiscFace, list_disc_faces
from tuisim.pictures.scene.pen import Piece
from tuisim.pictures.scene.pictures import draw_world
from tuisim.settings.options import Settings, list_chosen_values

if TYPE_CHECKING:
    from PIL.Image import Image

    from tuisim.engine.runs.run_folder import StoredRun

_LEFT_RIGHT = ("left", "right")

_UNITS = (("_mm", " ", "mm"), ("_dps", " ", "°/s"), ("_deg", "", "°"))
"""Suffix of a column's name, separator between number and unit, and unit."""

Row = tuple[str, str]


def bundle_picture(picture: Any, name: str) -> dict[str, Any]:
    """Return a Pillow image as MIME data for a display.

    Args:
        picture: The image.
        name: What it shows, for front ends that show only text.
    """
    return {
        "image/png": encode_png(picture),
        "text/plain": f"<{name}, {picture.width} × {picture.height} pixels>",
    }


def build_table(title: str, rows: Sequence[Row], *, keep_blanks: bool = False) -> dict[str, Any]:
    """Return rows of name and value as MIME data of a table.

    Args:
        title: The title above the rows.
        rows: Names and values.
        keep_blanks: Whether several blanks in a value are kept, which matter in a program; otherwise a browser shows
            one.
    """
    begin, end = (
        ('<td style="text-align: left"><pre>', "</pre></td>") if keep_blanks else ("<td>", "</td>")
    )
    wide = max((len(name) for name, _ in rows), default=0)
    plain = "\n".join([title, *(f"  {name:<{wide}}  {value}" for name, value in rows)])
    cells = "".join(
        f"<tr><th>{html.escape(name)}</th>{begin}{html.escape(value)}{end}</tr>"
        for name, value in rows
    )
    return {
        "text/plain": plain,
        "text/html": f"<table><caption>{html.escape(title)}</caption>{cells}</table>",
    }


def _format_light(face: DiscFace) -> str:
    """Return in words what a colour sensor sees; the reading that the program uses comes first."""
    seen = face.seen
    value = face.value_words.removeprefix("mean ")
    numbers = f"red {value}, mean {seen.mean_percent:.1f} %"
    if face.read.uses_all_channels(seen):
        numbers = f"mean {value}, red {seen.red_percent:.1f} %"
    return f"{numbers}, rgb {seen.rgb}, color {seen.name}"


def _format_reading(name: str, values: dict[str, float]) -> str:
    return ", ".join(
        f"{value:g}{_find_unit(column)}"
        for column, value in values.items()
        if column.startswith(name)
    )


def _find_unit(column: str) -> str:
    return next((f"{space}{unit}" for end, space, unit in _UNITS if column.endswith(end)), "")


@dataclass(frozen=True, slots=True)
class Scene:
    """The state that the panels of a cell show: a world, the robot at one tick, pen traces, samples and lines."""

    spec: RunSpec
    files: FieldFiles
    program: Program | None
    """None if there is none yet."""
    last: TickRecord
    """The tick to display."""
    traces: Sequence[Piece] = ()
    """Pen traces on the mat up to then."""
    samples: Sequence[Sample] = ()
    printed: Sequence[str] | None = None
    """The lines of the last run, unless they are in the cell already."""
    run: StoredRun | None = None
    """The run that is shown; None before any."""

    def open_field(self) -> Field:
        """Return the mat as the sensors see it."""
        return self.files.open_field(has_floor=self.spec.world.is_open)


def start_record(spec: RunSpec) -> TickRecord:
    """Return a record of telemetry with the robot at its start, as before any run."""
    start = spec.world.start
    flags = build_start_flags(spec.robot)
    still = (0.0, 0.0, 0.0, 0.0)
    heading_deg = start.heading_deg
    return TickRecord(0, 0, start.x_mm, start.y_mm, heading_deg, *still, heading_deg, flags, 0)


def list_instruments(scene: Scene) -> list[Row]:
    """Return names and values of the motors, the sensors and the pose in a scene."""
    spec = scene.spec
    record = scene.last
    field = scene.open_field()
    instant = record.build_instant(spec, spec.world.noise)
    scales: dict[str, float] = {}
    if scene.run:
        index = CommandIndex(scene.run)
        index.read_scale_changes()
        scales = index.find_scales(record.tick)
    turns = (
        ("LeftMotor", record.left_position_deg, record.left_speed_dps),
        ("RightMotor", record.right_position_deg, record.right_speed_dps),
    )
    rows = []
    for motor, (name, position_deg, speed_dps) in zip(spec.robot.motors, turns, strict=False):
        scale = scales.get(motor.port, 1.0)
        # The sum is never -0.
        counts, dps = (round(value * scale) + 0 for value in (position_deg, speed_dps))
        rows.append((name, f"{counts} counts, {dps} °/s"))
    faces = {face.name: face for face in list_disc_faces(spec, instant, field, scene.program)}
    for sensor in spec.robot.sensors:
        values = measure_sensors([sensor], instant, spec, field)
        name = getattr(sensor, "name", "gyro")
        columns = (
            f"Sensor{_LEFT_RIGHT.index(name) + 1} ({name})"
            if name in _LEFT_RIGHT
            else name.capitalize()
        )
        text = _format_light(faces[name]) if name in faces else _format_reading(name, values)
        rows.append((columns, text))
    return [*rows, ("Clock", f"{record.tick / spec.profile.tick_hz:.2f} s")]


def _list_positions(scene: Scene) -> list[Row]:
    pose = scene.last.pose
    return [
        ("x", f"{pose.x_mm:.1f} mm"),
        ("y", f"{pose.y_mm:.1f} mm"),
        ("heading", f"{shown_heading_deg(pose.heading_deg):.1f}°"),
    ]


def _list_settings(scene: Scene) -> list[Row]:
    spec = scene.spec
    world = spec.world
    names = (spec.robot.name, spec.profile.name)
    what = ("robot", "profile", "mat", "obstacles", "values")
    values = ", ".join(list_chosen_values(spec))
    return list(
        zip(what, (*names, world.background, str(len(world.obstacles)), values), strict=True)
    )


_TABLES: Mapping[str, Callable[[Scene], list[Row]]] = {
    "instrumentation": list_instruments,
    "positioning": _list_positions,
    "noise": lambda scene: [
        (name, str(level)) for name, level in asdict(scene.spec.world.noise).items()
    ],
    "settings": _list_settings,
    "code": lambda scene: [
        (str(number), line)
        for number, line in enumerate(source_lines(scene.program.text if scene.program else ""), 1)
    ],
}
"""The rows of each panel's table."""


CHART_SIZE = (760, 300)
"""Width and height of the chart in pixels."""


def _draw_arrays(scene: Scene) -> Image:
    instant = scene.last.build_instant(scene.spec, scene.spec.world.noise)
    faces = list_disc_faces(scene.spec, instant, scene.open_field(), scene.program)
    return draw_image(draw_arrays(faces, FACE_PX[0] * max(len(faces), 1), FACE_PX[1]))


class Stage:
    """The panels of one cell, each of which is a display that is updated in place.

    Args:
        settings: The settings, which enable and disable panels.
        captions: Displays below the picture of the world, by name; they are not updated.
    """

    def __init__(
        self, settings: Settings, captions: Mapping[str, dict[str, Any]] = MappingProxyType({})
    ) -> None:
        self._settings = settings
        self._captions = captions
        self.redraws = hasattr(get_ipython(), "kernel")
        """Whether displays can be updated in place; a terminal would print them again."""
        self._handles: dict[str, DisplayHandle] = {}

    def _put(self, panel: str, bundle: dict[str, Any]) -> None:
        if panel in self._handles:
            self._handles[panel].update(bundle, raw=True)
        else:
            handle = display(bundle, raw=True, display_id=True)
            # A display hook that discards its input returns None.
            if handle is not None:
                self._handles[panel] = handle

    def is_enabled(self, panel: str) -> bool:
        """Return whether a panel is enabled in the cell."""
        return panel in self._settings["panels_on"]

    def show(self, scene: Scene, status: str) -> None:
        """Draw all panels with the state of a scene and a status line."""
        # A kernel sends printed text with a delay, but displays immediately.
        sys.stdout.flush()
        sys.stderr.flush()
        on = self._settings["panels_on"]
        off = self._settings["panels_off"]
        if "world" not in off:
            mat = scene.files.read_pixels()
            pose = scene.last.pose
            rays = self._settings["rays"]
            picture = draw_world(scene.spec, mat, pose, scene.traces, rays=rays)
            self._put("world", bundle_picture(picture, "world"))
        for name, caption in self._captions.items():
            if name not in self._handles:
                self._put(name, caption)
        if "arrays" in on:
            self._put("arrays", bundle_picture(_draw_arrays(scene), "sensor arrays"))
        if "chart" in on:
            drawing = build_sample_chart(scene.samples, CHART_SIZE[0]).lay_out(
                *CHART_SIZE, titled=False
            )
            self._put("chart", bundle_picture(draw_image(drawing), "chart"))
        if "output" in on and scene.printed is not None:
            self._put("output", {"text/plain": "\n".join(scene.printed) or "nothing was printed"})
        for panel, rows in _TABLES.items():
            if panel in on:
                self._put(
                    panel,
                    build_table(panel.capitalize(), rows(scene), keep_blanks=panel == "code"),
                )
        if "controls" not in off:
            # As plain text, JupyterLab breaks it anywhere, also in words.
            bundle = {"text/plain": status, "text/html": f"<div>{html.escape(status)}</div>"}
            self._put("controls", bundle)
