"""One frame of a movie in pixels: the world, the chart, the sensor arrays, and a line with time and values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, printable
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.runs.recorded_run import Recording
from tuisim.pictures.charts.files import draw_image
from tuisim.pictures.charts.layout import (
    LETTER_PX,
    LINE_PX,
    PAD,
    ChartData,
    Drawing,
    Raster,
    Shape,
    Words,
    cut_drawing,
    move_shapes,
)
from tuisim.pictures.charts.sample_chart import build_sample_chart
from tuisim.pictures.movies.arrays import draw_arrays
from tuisim.pictures.movies.clip import ClipMoment, ClipPanel, ClipRun
from tuisim.pictures.scene.discs import DiscFace, list_disc_faces
from tuisim.pictures.scene.pen import Piece
from tuisim.pictures.scene.pictures import (
    build_painter,
    build_scene,
    find_area,
    fit_view,
    read_pose,
)
from tuisim.pictures.scene.view import Area, Viewport

if TYPE_CHECKING:
    from PIL.Image import Image

Size = tuple[int, int]

WIDTH_PX = 600
"""Default width of a frame."""
LEAST = (160, 120)
MOST = (3840, 2160)
"""Smallest and largest size of a frame."""

_STRIP_PX = 190
"""Default height of chart and arrays below the world."""
_STRIP_SHARE = 0.34
"""Share of chart and arrays in a given height."""
_CAPTION_PX = LINE_PX + 8
_LABELS_PX = 5 * LINE_PX
_FACE_PX = 130
"""Width of a disc with its words."""
_ARRAYS_SHARE = 0.45
"""Largest share of the width that the arrays take beside a chart."""


@dataclass(frozen=True, slots=True)
class PictureBox:
    """The position and the size of a part of a frame, in pixels."""

    left: int
    top: int
    width: int
    height: int


def _fit_size(panels: Sequence[ClipPanel], robot: RobotSpec, area: Area) -> Size:
    height_px = _CAPTION_PX
    if ClipPanel.WORLD in panels:
        height_px += fit_view(robot, WIDTH_PX - 2 * PAD, MOST[1], area).height_px
    if ClipPanel.CHART in panels or ClipPanel.ARRAYS in panels:
        height_px += _STRIP_PX
    return WIDTH_PX, height_px + PAD


def find_frame_view(
    recorded: ClipRun, panels: Sequence[ClipPanel], size: Size | None = None
) -> Viewport:
    """Return a view as large as a whole frame, in which the world is exactly where the frame's world panel shows it.

    A picture drawn in this view, such as one of a path, can therefore be laid over the frame.

    Args:
        recorded: The run.
        panels: The panels of the frame, among them the world.
        size: Width and height in pixels; None for the size that fits the panels.
    """
    robot = recorded.run.spec.robot
    area = find_area(recorded.telemetry)
    size = size or _fit_size(panels, robot, area)
    room = _place_boxes(panels, size, len(robot.color_sensors))[ClipPanel.WORLD]
    fitted = fit_view(robot, room.width, room.height, area)
    box = _center_box(room, (fitted.width_px, fitted.height_px))
    left_mm, top_mm = fitted.to_mm(-box.left, -box.top)
    return Viewport(*size, fitted.mm_per_px, left_mm, top_mm)


class FramePainter:
    """Draws the frames of a movie of a recorded run, one after the other.

    Args:
        recorded: The run.
        panels: The panels of each frame, at least one.
        span_s: Range of simulated time of the chart.
        size: Width and height in pixels; None for the size that fits the panels.

    Raises:
        ConfigError: the panels do not fit the size.
        LogError: the mat no longer exists.
    """

    def __init__(
        self,
        recorded: ClipRun,
        panels: Sequence[ClipPanel],
        span_s: tuple[float, float],
        size: Size | None = None,
    ) -> None:
        run = recorded.run
        self._recorded = recorded
        self._panels = panels
        area = find_area(recorded.telemetry)
        self.size = size or _fit_size(panels, run.spec.robot, area)
        boxes = self._boxes = _place_boxes(panels, self.size, len(run.spec.robot.color_sensors))
        if ClipPanel.WORLD in boxes:
            box = boxes[ClipPanel.WORLD]
            view = fit_view(run.spec.robot, box.width, box.height, area)
            self._world = MovingWorld(recorded, view)
        if ClipPanel.CHART in boxes:
            box = boxes[ClipPanel.CHART]
            self._chart = _build_chart(recorded, box.width, span_s).lay_out(
                box.width, box.height, titled=False
            )
        if ClipPanel.ARRAYS in boxes:
            self._arrays = SensorArrays(recorded)

    def image(self, moment: ClipMoment) -> Image:
        """Return a frame as a Pillow image; frames must be drawn in order of time."""
        from PIL import Image

        image = Image.new("RGB", self.size, "white")
        for box, part in self._iterate_parts(moment):
            image.paste(
                draw_image(part) if isinstance(part, Drawing) else part, (box.left, box.top)
            )
        return image

    def draw(self, moment: ClipMoment) -> Drawing:
        """Return the frame as a drawing, with text and curves as shapes."""
        shapes: list[Shape] = []
        for box, part in self._iterate_parts(moment):
            if isinstance(part, Drawing):
                shapes += move_shapes(part, box.left, box.top)
            else:
                shapes.append(Raster(box.left, box.top, part.width, part.height, np.asarray(part)))
        return Drawing(printable(self._recorded.run.program.name), *self.size, tuple(shapes))

    def _iterate_parts(self, moment: ClipMoment) -> Iterable[tuple[PictureBox, Drawing | Image]]:
        """Yield each part of a frame, with its position in the frame."""
        caption = PictureBox(0, 0, self.size[0], _CAPTION_PX)
        yield caption, _draw_caption(moment, caption)
        if box := self._boxes.get(ClipPanel.WORLD):
            picture = self._world.draw_moment(moment)
            yield _center_box(box, picture.size), picture
        if box := self._boxes.get(ClipPanel.ARRAYS):
            yield box, draw_arrays(self._arrays.list_faces(moment), box.width, box.height)
        if box := self._boxes.get(ClipPanel.CHART):
            yield box, cut_drawing(self._chart, moment.time_s)


def _place_boxes(
    panels: Sequence[ClipPanel], size: Size, sensors: int
) -> dict[ClipPanel, PictureBox]:
    """Return the position of each panel in a frame: the world is above, arrays and chart are below it.

    Raises:
        ConfigError: a panel would be too small.
    """
    width, height = size[0] - 2 * PAD, size[1] - _CAPTION_PX - PAD
    below = [panel for panel in (ClipPanel.ARRAYS, ClipPanel.CHART) if panel in panels]
    strip = 0
    if below:
        strip = height
        if ClipPanel.WORLD in panels:
            strip = min(
                max(round(size[1] * _STRIP_SHARE), 100),
                max(_STRIP_PX, round(size[1] * _STRIP_SHARE)),
            )
    boxes: dict[ClipPanel, PictureBox] = {}
    if ClipPanel.WORLD in panels:
        boxes[ClipPanel.WORLD] = PictureBox(PAD, _CAPTION_PX, width, height - strip)
    left = PAD
    top = size[1] - PAD - strip
    if ClipPanel.ARRAYS in below:
        arrays_width = sensors * max(strip - _LABELS_PX + PAD, _FACE_PX)
        taken = (
            min(arrays_width, round(width * _ARRAYS_SHARE)) if ClipPanel.CHART in below else width
        )
        boxes[ClipPanel.ARRAYS] = PictureBox(left, top, taken, strip)
        left = left + taken
        width = width - taken
    if ClipPanel.CHART in below:
        boxes[ClipPanel.CHART] = PictureBox(left, top, width, strip)
    for panel, box in boxes.items():
        if box.width < 60 or box.height < 50:
            raise ConfigError(
                f"{size[0]}x{size[1]} is too small", f"no room for the panel {panel}", key="--size"
            )
    return boxes


def _center_box(box: PictureBox, size: Size) -> PictureBox:
    return PictureBox(
        box.left + (box.width - size[0]) // 2, box.top + (box.height - size[1]) // 2, *size
    )


def _build_chart(recorded: ClipRun, columns: int, span_s: tuple[float, float]) -> ChartData:
    """Return the chart of the samples that a run has printed, at the times of printing."""
    low, high = span_s
    return build_sample_chart(
        recorded.samples, columns, span_s if high > low else (low - 0.5, low + 0.5)
    )


def _draw_caption(moment: ClipMoment, box: PictureBox) -> Drawing:
    """Return the caption of a frame: one line with the time and as many values as fit."""
    words: list[Shape] = []
    x = float(PAD)
    for number, text in enumerate(
        [f"{moment.time_s:.2f} s", *(f"{name}: {value:.5g}" for name, value in moment.values)]
    ):
        text = printable(text)
        if number and x + len(text) * LETTER_PX > box.width - PAD:
            break
        words.append(Words(x, box.height / 2, text, strong=not number))
        x += len(text) * LETTER_PX + 2 * PAD
    return Drawing("", box.width, box.height, tuple(words))


class MovingWorld:
    """Draws the world of a recorded run at successive instants: the mat, the robot, and what its pen has drawn.

    Args:
        recorded: The run.
        view: Scale and size.

    Raises:
        LogError: the mat no longer exists.
    """

    def __init__(self, recorded: ClipRun, view: Viewport) -> None:
        self._recorded = recorded
        self._spec = recorded.run.spec
        self._view = view
        mat = recorded.run.find_mat_files().read_pixels()
        self._painter = build_painter(mat, has_floor=self._spec.world.is_open)
        self._traced = 0
        """Number of records whose pen traces are drawn."""

    def draw_moment(self, moment: ClipMoment) -> Image:
        """Return the picture of the world at an instant; instants must be drawn in order of time."""
        from PIL import Image

        self._painter.trace.add(
            Piece.from_run(self._spec, self._recorded.telemetry[self._traced : moment.tick + 1])
        )
        self._traced = moment.tick + 1
        return Image.fromarray(
            self._painter.paint(self._view, build_scene(self._spec, read_pose(moment.record)))
        )


class SensorArrays:
    """Computes what the colour sensors see at any instant of a recorded run.

    Args:
        recorded: The run.

    Raises:
        LogError: the mat no longer exists.
    """

    def __init__(self, recorded: ClipRun) -> None:
        self._run = recorded.run
        self._mat, self._recording = recorded.run.open_mat(), Recording(recorded.run)

    def list_faces(self, moment: ClipMoment) -> list[DiscFace]:
        """Return what each colour sensor sees at an instant; empty if the record of that instant is damaged."""
        if read_pose(moment.record) is None:
            return []
        run = self._run
        instant = moment.record.build_instant(run.spec, run.find_noise(moment.record))
        return list_disc_faces(
            run.spec, instant, self._recording.find_field(moment.tick, self._mat), run.program
        )
