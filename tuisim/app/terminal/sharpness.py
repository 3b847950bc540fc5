"""When a picture that was drawn coarsely becomes fine: on a slow link not while it moves."""

from __future__ import annotations

import time
from collections.abc import Callable

from textual.timer import Timer
from textual.widget import Widget

from tuisim.app.terminal.picture_mode import picture_mode_of

REFINE_S = 0.1
"""Time between two steps in which a coarse picture becomes fine."""
_STILL_S = 0.3


class Sharpness:
    """Draws the picture of a widget more finely as soon as that is possible.

    Args:
        widget: Provides the timer.
        refine: Draws some of the picture more finely; returns whether more is to be done.
        still_s: A picture that has not changed for this long stands still.
    """

    def __init__(self, widget: Widget, refine: Callable[[], bool], still_s: float = _STILL_S) -> None:
        self._widget = widget
        self._refine = refine
        self._still_s = still_s
        self._timer: Timer | None = None
        self._is_coarse = False
        self._changed_s = 0.0

    @property
    def is_still(self) -> bool:
        """Whether the picture stands still."""
        return time.monotonic() - self._changed_s >= self._still_s

    def changed(self, *, is_coarse: bool = False) -> None:
        """Note that the picture was drawn; `is_coarse` if it is to be drawn more finely as soon as that is possible."""
        self._changed_s, self._is_coarse = time.monotonic(), is_coarse
        if is_coarse and self._timer is None:
            self._timer = self._widget.set_interval(REFINE_S, self._step)

    def _step(self) -> None:
        picture_mode = picture_mode_of(self._widget.app)
        if not picture_mode.is_idle() or (picture_mode.is_slow() and not self.is_still):
            return
        if self._is_coarse:
            self._is_coarse = False
            has_more = self._refine()
            # What it has drawn may be coarse again.
            self._is_coarse = self._is_coarse or has_more
        if not self._is_coarse and self._timer is not None:
            self._timer.stop()
            self._timer = None
