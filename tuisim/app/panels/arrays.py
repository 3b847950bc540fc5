"""The sensor arrays panel: the discs of pixels that the colour sensors see."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from rich.style import Style
from textual.app import ComposeResult
from textual.widget import Widget

from tuisim import palette
from tuisim.core.sensors.color import pixel_array
from tuisim.scene.discs import CORNER_16_RGB, CORNER_RGB, FULL_PX, DiscLayout, draw_discs, lay_out
from tuisim.terminal.cell_view import LinesView, PixelView
from tuisim.terminal.pacer import Throttle
from tuisim.terminal.text_runs import cut

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_PERIOD_S = 0.25
"""All pixels of both discs may change at once: a shorter period would saturate a slow link."""

_LABEL = Style(color=palette.LABEL)


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

    @property
    def _has_names(self) -> bool:
        """Whether there is a row for the names: the discs still fit completely."""
        return self.size.height > FULL_PX // 2

    def on_resize(self) -> None:
        """Show the line of names if there is room for it."""
        self._names.display = self._has_names
        self._drawn = None
        self.call_after_refresh(self._draw)

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment; at most a few updates per second, and the last one with the world."""
        has_stopped = snapshot.has_stopped_since(self._snapshot)
        self._snapshot = snapshot
        self._throttle.ask(at_once=has_stopped)

    def _draw(self) -> None:
        now = self._snapshot
        # The size of the panel, not that of what is in it: that follows a moment later.
        size = self.size
        if now is None or not size:
            return
        if now.field is None:
            self._discs.clear_picture()
            return
        seen = (now.instant.pose, now.instant.noise, now.instant.noise.light and now.instant.tick, now.spec.robot)
        if (seen, id(now.field), size) == self._drawn:
            return
        self._drawn = (seen, id(now.field), size)
        sensors = now.spec.robot.color_sensors
        layout = lay_out(len(sensors), size.width, 2 * (size.height - self._has_names))
        boxes = [pixel_array(sensor, now.instant, now.field) for sensor in sensors]
        mode = self._discs.color_mode
        corner_rgb = CORNER_16_RGB if mode.dithers and not mode.grey else CORNER_RGB
        self._discs.set_picture(draw_discs(layout, boxes, self._discs.ground_rgb, corner_rgb))
        self._label_discs(layout, [sensor.name for sensor in sensors])

    def _label_discs(self, layout: DiscLayout, names: list[str]) -> None:
        if not layout.beside or not self._has_names:
            # Side by side or stacked, the order identifies them.
            self.border_subtitle = (" │ " if layout.beside else " above ").join(names) if len(names) > 1 else ""
            self._names.set_lines([])
            return
        self.border_subtitle = ""
        self._names.set_lines([[(name_line(layout, names), _LABEL)]])


def name_line(layout: DiscLayout, names: Sequence[str]) -> str:
    """Return the line above discs side by side: each name above its disc, with a space at least between two."""
    pitch = min((after - col for (col, _), (after, _) in pairwise(layout.corners)), default=layout.side_px + 1)
    room = min(layout.side_px, pitch - 1)
    long = [f"Sensor{at} {name}" for at, name in enumerate(names, 1)]
    labels = long if all(len(label) <= room for label in long) else names
    line = ""
    for (col, _), label in zip(layout.corners, labels, strict=False):
        line = line.ljust(col) + cut(label, room).center(layout.side_px)
    return line
