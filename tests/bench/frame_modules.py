"""How many modules the app walks through for one frame: `python -m tests.bench.frame_modules FILE FRAMES [WORD…]`.

The command starts the app with the words and writes what it has counted to the file, as JSON. A frame is everything
that the app's main thread does from drawing one to drawing the next.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median, quantiles
from unittest.mock import patch

from tests.bench.figures import Figure
from tests.bench.frames import CIRCLE
from tests.bench.module_moves import MoveCounter
from tests.bench.sampling import Effort
from tests.bench.terminal import Terminal
from tuisim.base.atomic import replacing
from tuisim.cli import run_command
from tuisim.terminal.pacer import Pacer

SETTLE_S = 5.0
"""From the first frame, for modules that are imported and caches that are filled."""
EACH_FRAME = 5
"""Only one of so many frames is counted: counting slows the app."""
FRAMES_A_REPEAT = 6
PATIENCE_S = 120.0


class FrameWalks:
    """Counts for some frames how often each module of tuisim is entered.

    Args:
        file: Where the counts are written when there are enough.
        frames: How many are enough.
    """

    def __init__(self, file: Path, frames: int) -> None:
        self._file = file
        self._frames = frames
        self._walks: list[Mapping[str, int]] = []
        self._counter: MoveCounter | None = None
        self._number = 0
        self._begun_s = 0.0

    def drawn(self) -> None:
        """A frame is drawn: the walk for the one before has ended, and another begins, unless it is left out."""
        if self._counter is not None:
            self._walks.append(self._counter.stop().entered)
            self._counter = None
            if len(self._walks) == self._frames:
                with replacing(self._file) as file:
                    file.write(json.dumps(self._walks).encode())
        self._number += 1
        self._begun_s = self._begun_s or time.monotonic()
        is_counted = not self._number % EACH_FRAME and time.monotonic() - self._begun_s > SETTLE_S
        if is_counted and len(self._walks) < self._frames:
            self._counter = MoveCounter()
            self._counter.start()


def frame_modules(effort: Effort) -> Iterator[Figure]:
    """Yield the modules that a frame enters and how often, at 120 x 40, with the panels as they are."""
    frames = walked(("-R",), FRAMES_A_REPEAT * effort.repeats)
    modules = median(len(entered) for entered in frames)
    # On a busy machine most frames come late, and show more ticks than a frame should.
    changes = quantiles([sum(entered.values()) for entered in frames], n=4)[0]
    yield Figure("modules entered in a frame", modules, "", most=48)
    yield Figure("changes of module in a frame", changes, "", most=130)


def walked(panels: Sequence[str], count: int) -> list[Mapping[str, int]]:
    """Start the app with a robot that drives, and return for some frames how often each module was entered."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "circle.py"
        told = Path(folder) / "counted.json"
        program.write_text(CIRCLE, "utf-8")
        command = (sys.executable, "-m", "tests.bench.frame_modules", str(told), str(count))
        with Terminal([str(program), *panels], command) as terminal:
            terminal.read_until(told.exists, PATIENCE_S)
        frames: list[Mapping[str, int]] = json.loads(told.read_text())
    return frames


def run_app(words: Sequence[str], on_drawn: Callable[[], None]) -> int:
    """Start the app with some words, and call a function after each frame."""
    drawn = Pacer.drawn

    def draw_and_tell(pacer: Pacer) -> None:
        drawn(pacer)
        on_drawn()

    with patch.object(Pacer, "drawn", draw_and_tell):
        return run_command(words)


def main(file: str, frames: str, *words: str) -> int:
    """Start the app, and count."""
    return run_app(words, FrameWalks(Path(file), int(frames)).drawn)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
