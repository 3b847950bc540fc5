"""The film of the app in README: `python -m tests.guide.film` makes it anew, in as much time as it lasts."""

from __future__ import annotations

import asyncio
import gc
import os
import tempfile
import time
from collections.abc import AsyncGenerator, AsyncIterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from textual.pilot import Pilot

from tests.app.app_help import lab, ready
from tests.conftest import ROOT
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.screenshot import collect_cells
from tuisim.app.snapshot import RunPhase
from tuisim.app.terminal_app import picture_mode_at_start
from tuisim.base.source import Program
from tuisim.pictures.movies.files import PALETTE_FRAMES, encode_gif
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.terminal.cell_image import CellGrid, draw_cells
from tuisim.terminal.picture_options import CellSet

FILM = Path(__file__).with_name("tuisim.gif")
SIZE = (120, 40)
SPEED = 2.0
FRAME_S = 0.1
_REFINED_S = 2.0
"""So long the mat is drawn step by step, before the film."""
_LAST_MS = 1000
_GIF_MS = 10

Frame = tuple[float, CellGrid]
"""When it was taken, in seconds, and the screen."""


async def frames() -> AsyncGenerator[Frame]:
    """Yield what is seen: the example of the grey bands drives, two seconds back, and the values of the bands."""
    text = (ROOT / "programs" / "log_greys.py").read_text(encoding="utf-8")
    program = Program(name="log_greys.py", text=text, prelude="preloaded", path="log_greys.py")
    spec = build_run_spec(Settings({"background": "Grey_bands"}))
    settings = AppSettings(spec=spec, program=program, speed=SPEED)
    opened = LabApp(settings, picture_mode_at_start(CellSet.OCTANT, "truecolor"))
    async with opened.run_test(size=SIZE) as pilot:
        app = await ready(pilot)
        await pilot.pause(_REFINED_S)
        app.clear_notifications()
        back = "less_than_sign"
        for key, seconds in (
            ("", 0.3),
            ("R", 0.5),
            (back, 0.5),
            (back, 0.8),
            ("end", 0.1),
            ("c", 0.1),
            ("plus", 1.0),
        ):
            async for frame in _watch(pilot, key, seconds):
                yield frame


async def _watch(pilot: Pilot[Any], key: str, seconds: float) -> AsyncIterator[Frame]:
    """Press a key, and yield what is seen until the program has ended, and for some time after that."""
    if key:
        await pilot.press(key)
    next_s = time.monotonic()
    end_s = next_s + seconds
    while next_s < end_s:
        yield time.monotonic(), collect_cells(pilot.app)
        next_s = max(next_s + FRAME_S, time.monotonic())
        if lab(pilot).find_situation().state is RunPhase.RUNNING:
            end_s = next_s + seconds
        await asyncio.sleep(next_s - time.monotonic())


def gif_of(film: Sequence[Frame]) -> bytes:
    """Return frames as GIF, each as long as it was seen."""
    begins_ms = [round(at_s * 1000 / _GIF_MS) * _GIF_MS for at_s, _ in film]
    images = [draw_cells(grid) for _, grid in film]
    durations_ms = [end - begin for begin, end in pairwise(begins_ms)]
    samples = images[:: max(len(images) // PALETTE_FRAMES, 1)]
    return encode_gif(iter(images), samples, [*durations_ms, _LAST_MS])


async def _film() -> bytes:
    return gif_of([frame async for frame in frames()])


def main() -> None:
    """Write the film."""
    os.environ |= {"TUISIM_HOME": tempfile.mkdtemp(), "COLORTERM": "truecolor"}
    # A search for garbage among all the cells that are kept would stop the film.
    gc.disable()
    FILM.write_bytes(asyncio.run(_film()))


if __name__ == "__main__":
    main()
