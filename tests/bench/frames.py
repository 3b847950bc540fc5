"""What the app sends to the terminal while the robot drives, and the CPU that takes."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.bench.figures import Figure
from tests.bench.processes import cpu_s
from tests.bench.references import paints
from tests.bench.sampling import Effort
from tests.bench.terminal import Terminal

CIRCLE = """\
# %%sim_magic_preloaded -b Grey_bands -x 600 -y 500
import time
tank_drive.on(SpeedPercent(10), SpeedPercent(20))
while True:
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
"""
"""Round and round over the bands, with a sample printed every 0.11 s."""

SETTLE_S = 3.0
"""From the program's start: the first paint, of the chart too, is not counted."""
ALL_BUT_CHART = ("-R", "-O", "-A", "-i", "-D", "-X")
WITH_CHART = (*ALL_BUT_CHART, "-c")
HIDE_CHART = b"cc"
"""The first of the keys gives the chart the focus."""
_BETWEEN_KEYS_S = 0.5


@dataclass(frozen=True, slots=True)
class Watched:
    """What was seen of the app in a stretch of whole frames."""

    frames: int
    bytes_sent: int
    wall_s: float
    app_cpu_s: float

    @property
    def frame_cpu_s(self) -> float:
        """What the app needs for a frame, with all that it does besides."""
        return self.app_cpu_s / self.frames


def frames(effort: Effort) -> Iterator[Figure]:
    """Yield bytes a frame with all panels but the chart."""
    seen = _watch(ALL_BUT_CHART, effort.watch_s, keys=HIDE_CHART)
    yield Figure(
        "a frame, all panels but the chart", seen.bytes_sent / seen.frames / 1e3, "kB", most=1.2
    )
    yield Figure("frames", seen.frames / seen.wall_s, "/ s")
    yield Figure("app's CPU for a frame", 1e3 * seen.frame_cpu_s, "ms CPU")
    seen = _watch(ALL_BUT_CHART, effort.watch_s, colorterm="truecolor", keys=HIDE_CHART)
    yield Figure("a frame, in full colour", seen.bytes_sent / seen.frames / 1e3, "kB")


def chart(effort: Effort) -> Iterator[Figure]:
    """Yield bytes a second and CPU with the chart open."""
    seen = _watch(WITH_CHART, effort.watch_s)
    yield Figure("a second, with the chart", seen.bytes_sent / seen.wall_s / 1e3, "kB", most=13)
    yield Figure("frames, with the chart", seen.frames / seen.wall_s, "/ s")
    ratio = paints(seen.frame_cpu_s)
    yield Figure(
        "app's CPU for a frame, with the chart",
        1e3 * seen.frame_cpu_s,
        "ms CPU",
        most=0.13,
        ratio=ratio,
    )
    seen = _watch(WITH_CHART, effort.watch_s, colorterm="truecolor")
    yield Figure(
        "a second, with the chart, in full colour", seen.bytes_sent / seen.wall_s / 1e3, "kB"
    )


def _watch(
    panels: tuple[str, ...],
    seconds: float,
    colorterm: str = "",
    keys: bytes = b"",
) -> Watched:
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "circle.py"
        program.write_text(CIRCLE, "utf-8")
        with Terminal([str(program), *panels], COLORTERM=colorterm) as terminal:
            terminal.read_until(lambda: b"Colour: " in terminal.seen and terminal.queries > 0)
            terminal.read_for(SETTLE_S)
            for key in keys:
                terminal.type(bytes([key]))
                terminal.read_for(_BETWEEN_KEYS_S)
            return _counted(terminal, seconds)


def _counted(terminal: Terminal, seconds: float) -> Watched:
    """Watch from the end of one frame to the end of another."""

    def next_frame() -> tuple[int, int, float, float]:
        before = terminal.queries
        terminal.read_until(lambda: terminal.queries > before)
        return terminal.queries, terminal.shown, time.monotonic(), cpu_s(terminal.pid)

    begin = next_frame()
    terminal.read_for(seconds)
    end = next_frame()
    return Watched(end[0] - begin[0], end[1] - begin[1], end[2] - begin[2], end[3] - begin[3])
