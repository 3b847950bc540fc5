"""The sensor arrays panel: the discs of pixels that the colour sensors see."""

from __future__ import annotations

from rich.style import Style
from textual.app import ComposeResult
from textual.widget import Widget

from tuisim.app.render.cells import PALETTE_16
from tuisim.app.render.mat import CORNER_16_RGB, CORNER_RGB, FULL_PX, DiscLayout, draw_discs, lay_out
from tuisim.app.snapshot import Snapshot
from tuisim.app.terminal.cell_view import LinesView, PixelView
from tuisim.app.terminal.pacer import Throttle
from tuisim.charts.text_runs import Run
from tuisim.core.sensors.color import pixel_array

_PERIOD_S = 0.25
"""All pixels of both discs may change at once: a shorter period would saturate a slow link."""

_LABEL = Style(color="#a8a8a8")


class Arrays(Widget):
    """The sensor arrays panel: a line of names above the discs if there is room for it."""

    DEFAULT_CSS = """
    Arrays > LinesView { width: 1fr; height: 1; }
    Arrays > PixelView { width: 1fr; height: 1fr; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._names = LinesView()
        self._discs = PixelView()
        self._snapshot: Snapshot | None = None
        self._drawn: object = None
        self._throttle = Throttle(self, _PERIOD_S, self._draw)

    def compose(self) -> ComposeResult:
        yield self._names
        yield self._discs

    def on_resize(self) -> None:
        """Show the line of names only if the discs still fit completely."""
        self._names.display = self.size.height > FULL_PX // 2
        self._drawn = None
        self.call_after_refresh(self._draw)

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment; at most a few updates per second."""
        self._snapshot = snapshot
        self._throttle.ask()

    def _draw(self) -> None:
        now = self._snapshot
        if now is None or not self._discs.size:
            return
        if now.field is None:
            self._discs.clear_picture()
            return
        seen = (now.instant.pose, now.instant.noise, now.instant.noise.light and now.instant.tick, now.spec.robot)
        if (seen, id(now.field), self._discs.size) == self._drawn:
            return
        self._drawn = (seen, id(now.field), self._discs.size)
        sensors = now.spec.robot.color_sensors
        layout = lay_out(len(sensors), self._discs.size.width, 2 * self._discs.size.height)
        boxes = [pixel_array(sensor, now.instant, now.field) for sensor in sensors]
        mode = self._discs.color_mode
        corner_rgb = CORNER_16_RGB if mode.depth == PALETTE_16 and not mode.grey else CORNER_RGB
        self._discs.set_picture(draw_discs(layout, boxes, self._discs.ground_rgb, corner_rgb))
        self._label_discs(layout, [sensor.name for sensor in sensors])

    def _label_discs(self, layout: DiscLayout, names: list[str]) -> None:
        labels = [f"Sensor{at} {name}" for at, name in enumerate(names, 1)]
        if not layout.beside or not self._names.display:
            # Side by side or stacked, the order identifies them.
            self.border_subtitle = (" │ " if layout.beside else " above ").join(names) if len(names) > 1 else ""
            self._names.set_lines([])
            return
        self.border_subtitle = ""
        line: list[Run] = []
        at = 0
        for (col, _), label in zip(layout.corners, labels, strict=False):
            text = label[: layout.side_px].center(layout.side_px)
            line += [(" " * (col - at), _LABEL), (text, _LABEL)]
            at = col + len(text)
        self._names.set_lines([line])
