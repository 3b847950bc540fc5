"""README: its length, its fences, and its film."""

from __future__ import annotations

from contextlib import aclosing
from io import BytesIO

import pytest
from PIL import Image, ImageSequence

from tests.conftest import ROOT
from tests.guide.documents import DOCUMENTS, blocks
from tests.guide.film import FILM, SIZE, frames, gif_of
from tuisim.terminal.cell_image import CELL_PX

FILM_PX = SIZE[0] * CELL_PX[0], SIZE[1] * CELL_PX[1]
MAX_BYTES = 1_500_000
MIN_MS, MAX_MS = 6_000, 10_000
MAX_LINES = 160
START = "python3 -m venv .venv && .venv/bin/pip install -q -e"


def test_readme_has_at_most_its_limit_of_lines() -> None:
    assert DOCUMENTS["README"].count("\n") <= MAX_LINES


def test_readme_has_the_two_commands_for_a_clone() -> None:
    marked = {
        block.kind: block.code for block in blocks("README") if block.kind in ("sh run", "sh test")
    }
    assert marked == {
        "sh run": f"{START} . && .venv/bin/tuisim programs/log_greys.py\n",
        "sh test": f"{START} '.[test]' && .venv/bin/python -m pytest -q\n",
    }


def durations_ms(content: bytes) -> list[int]:
    """How long each frame of a GIF as large as the film is shown."""
    with Image.open(BytesIO(content)) as film:
        assert (film.format, film.size, film.info["loop"]) == ("GIF", FILM_PX, 0)
        return [frame.info["duration"] for frame in ImageSequence.Iterator(film)]


def test_the_film_is_short_and_small() -> None:
    assert f"({FILM.relative_to(ROOT)})" in DOCUMENTS["README"]
    content = FILM.read_bytes()
    assert len(content) <= MAX_BYTES
    assert MIN_MS <= sum(durations_ms(content)) <= MAX_MS


@pytest.mark.slow
async def test_the_film_script_records_the_panels_and_a_running_program(home: object) -> None:
    """After a change of the app's look: `python -m tests.guide.film`."""
    film = []
    async with aclosing(frames()) as taken:
        async for frame in taken:
            film.append(frame)
            if len(film) == 10:
                break
    shown = ["\n".join("".join(text for text, _ in row) for row in grid) for _, grid in film]
    for panel in ("World: Grey_bands", "Instrumentation", "Sensor arrays", "Chart", "log_greys.py"):
        assert panel in shown[0]
    assert "idle 2×" in shown[0]
    assert any("running 2×" in frame for frame in shown)
    assert len(durations_ms(gif_of(film))) > 1
