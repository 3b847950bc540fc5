"""Animations that run in the background: of a hub's light, and of its matrix of lights."""

from __future__ import annotations

import _thread
from collections.abc import Callable, Sequence
from typing import Any

from tuisim.engine.core.profile import MS, NS_PER_S
from tuisim.engine.shim.pybricks.brick import whole


class Animation:
    """Frames that a background thread shows one after another, until they are stopped or replaced by others."""

    _number = 0

    def stop(self) -> None:
        """End the animation; the last frame stays visible."""
        self._number += 1

    def play(self, show: Callable[[Any], None], frames: Sequence[tuple[Any, int]]) -> None:
        """Show frames one after another, again and again, in the background.

        Args:
            show: Displays a frame.
            frames: Pairs of a frame and the time in ms for which it is displayed.

        Raises:
            ValueError: there are no frames, or a time is not above 0.
        """
        if not frames or any(whole(time) <= 0 for _, time in frames):
            raise ValueError("Invalid argument")
        self._number += 1
        _thread.start_new_thread(self._keep_on, (self._number, show, frames))

    def _keep_on(
        self, number: int, show: Callable[[Any], None], frames: Sequence[tuple[Any, int]]
    ) -> None:
        # The thread sleeps by waiting for a lock that is never released: unlike a sleep, this does not count as a line
        # of the program that takes time.
        alarm = _thread.allocate_lock()
        alarm.acquire()
        while number == self._number:
            for frame, time in frames:
                if number != self._number:
                    return
                show(frame)
                alarm.acquire(True, whole(time) * MS / NS_PER_S)
