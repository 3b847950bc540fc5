"""The sensor arrays panel: the discs of pixels that the colour sensors see, and what the program makes of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from textual.app import ComposeResult
from textual.widget import Widget

from tuisim.app.panels.titles import name_sensors
from tuisim.app.render.arrays import (
    Arrangement,
    arrange_discs,
    build_face_lines,
    find_asked_lines,
    list_border_names,
)
from tuisim.pictures.scene.discs import RIM_RGB, DiscFace, draw_disc, list_disc_faces
from tuisim.terminal.cell_view import LinesView, PixelView
from tuisim.terminal.text_runs import Line

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

RIM_16_RGB = (0, 0, 135)
"""Colour of a disc's rim in place of `RIM_RGB` for 8 or 16 colours without grey: a pattern would outshine the disc."""


class _DiscPicture(PixelView):
    """The picture of what one colour sensor sees, drawn as finely as the terminal can."""

    def __init__(self) -> None:
        super().__init__()
        self._face: DiscFace | None = None

    def show(self, face: DiscFace | None) -> None:
        """Show what a sensor sees; None clears the picture."""
        self._face = face
        self.draw_picture()

    def draw_picture(self) -> None:
        """Draw the picture again for the present size of the widget."""
        if self._face is None:
            self.clear_picture()
        elif self.size:
            graphics = self.graphics
            mode = self.color_mode
            cell = self.choose_cell(graphics)
            rim_rgb = RIM_16_RGB if mode.dithers and not mode.grey else RIM_RGB
            width_px, height_px = cell.cols * self.size.width, cell.rows * self.size.height
            picture = draw_disc(
                self._face.box, width_px, height_px, self.ground_rgb, rim_rgb, cell.tall
            )
            self.set_fine_picture(picture, graphics)


class _Disc(Widget):
    """The picture of what one colour sensor sees, and the lines with its values."""

    def __init__(self) -> None:
        super().__init__()
        self._picture = _DiscPicture()
        self._text = LinesView()
        self._face: DiscFace | None = None
        self._where: Arrangement | None = None

    def compose(self) -> ComposeResult:
        yield self._picture
        yield self._text

    def place(self, where: Arrangement) -> None:
        """Put the lines with the values below the picture or beside it, as the arrangement `where` says."""
        self._where = where
        self.styles.layout = "vertical" if where.below else "horizontal"
        self._picture.styles.width = "1fr" if where.below else where.disc_cols
        self._picture.styles.height = max(where.disc_cols // 2, 1)
        self._text.styles.width, self._text.styles.height = where.text_cols, max(where.text_rows, 1)
        self._text.display = where.text_rows > 0

    def show(self, face: DiscFace | None, *, has_limits: bool = False) -> None:
        """Show the picture and the values of a sensor.

        Args:
            face: What the sensor sees; None clears picture and lines.
            has_limits: Whether to reserve a line for thresholds.
        """
        self._picture.show(face)
        lines: list[Line] = []
        if face is not None and (where := self._where) is not None:
            width = min(where.text_cols - where.below, self._text.size.width or where.text_cols)
            lines = build_face_lines(face, width, where.text_rows, has_limits=has_limits)
        self._text.set_lines(lines)


class Arrays(Widget, can_focus=True):
    """The sensor arrays panel: what each colour sensor sees, as discs with values."""

    DEFAULT_CSS = """
    Arrays > _Disc { width: 1fr; height: 1fr; align-horizontal: center; }
    Arrays > _Disc > LinesView { margin-left: 1; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._discs: list[_Disc] = []
        self._where: Arrangement | None = None
        self._snapshot: Snapshot | None = None
        self._drawn: object = None
        self._asked = frozenset[int]()
        """Numbers of the program's lines whose thresholds the discs show."""

    def on_resize(self) -> None:
        """Arrange the discs for the new size of the panel."""
        self._drawn = None
        self.call_after_refresh(self._draw)

    def render(self) -> str:
        """Return the text that the panel shows in place of the discs; empty while there are discs."""
        if self._snapshot is not None and not self._snapshot.spec.robot.color_sensors:
            return "The robot has no colour sensor"
        return "" if self._discs else "Preparing the mat"

    def show(self, snapshot: Snapshot) -> None:
        """Show the sensors at an instant of the run."""
        shown = self._snapshot
        self._snapshot = snapshot
        if shown is None or shown.spec.robot is not snapshot.spec.robot:
            self.refresh()
        self._draw()

    def _draw(self) -> None:
        now = self._snapshot
        if now is None or not self.size:
            return
        if now.field is None:
            self._drawn = None
            for disc in self._discs:
                disc.show(None)
            return
        seen = (
            now.instant.pose,
            now.instant.noise,
            now.instant.noise.light and now.instant.tick,
            now.spec.robot,
        )
        self._asked = find_asked_lines(now, self._asked)
        drawn = (seen, id(now.field), self.size, now.program, self._asked)
        if drawn == self._drawn:
            return
        self._drawn = drawn
        faces = list_disc_faces(now.spec, now.instant, now.field, now.program)
        has_limits = any(face.thresholds for face in faces)
        self._arrange(faces)
        names = [face.name for face in faces]
        usual = (
            list_border_names(names, self._where, has_limits=has_limits)
            if names and self._where
            else ""
        )
        self.border_subtitle = name_sensors(now, self.size.width) or usual
        for disc, face in zip(self._discs, faces, strict=True):
            limits = (limit for limit in face.thresholds if limit.line in self._asked)
            disc.show(replace(face, thresholds=tuple(limits)), has_limits=has_limits)

    def _arrange(self, faces: list[DiscFace]) -> None:
        where = arrange_discs(len(faces), self.size.width, self.size.height)
        if where == self._where and len(faces) == len(self._discs):
            return
        self._where = where
        while len(self._discs) > len(faces):
            self._discs.pop().remove()
        added = [_Disc() for _ in range(len(faces) - len(self._discs))]
        self._discs += added
        self.mount(*added)
        self.styles.layout = "horizontal" if where.across else "vertical"
        for disc in self._discs:
            disc.place(where)
