"""The world in real terminals, as it is seen."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.app.windows import WINDOWS, Pixels, shown_in

pytestmark = pytest.mark.slow

GREYS = (220, 211, 128)
SPOTS = ((255, 0, 0), (0, 255, 0), (0, 0, 255))
_CLOSE = 8
"""Sixel and the 256 colours have no colour more than this beside those of the mat."""


def _share(picture: Pixels, rgb: tuple[int, int, int]) -> float:
    return float((np.abs(picture.astype(int) - rgb) <= _CLOSE).all(axis=2).mean())


def _is_world(picture: Pixels) -> bool:
    """Return whether the mat `Grey_bands` with its bands and spots, and a robot on it, is a good part of a picture."""
    has_greys = all(_share(picture, (grey, grey, grey)) > 0.01 for grey in GREYS)
    has_spots = all(_share(picture, spot) > 0.0002 for spot in SPOTS)
    has_robot = _share(picture, (0, 95, 215)) > 0.0005
    return _share(picture, (255, 255, 255)) > 0.15 and has_greys and has_spots and has_robot


def _where_installed(name: str, *further: str) -> pytest.MarkDecorator:
    missing = [
        *WINDOWS[name].missing,
        *(program for program in further if shutil.which(program) is None),
    ]
    return pytest.mark.skipif(bool(missing), reason=f"{name}: not installed: {', '.join(missing)}")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=_where_installed(name)) for name in WINDOWS]
)
def test_each_terminal_program_shows_the_world_without_stray_colours(
    name: str, tmp_path: Path
) -> None:
    with shown_in(WINDOWS[name], ["log_greys"], tmp_path) as display:
        display.until(_is_world)
        # It may be drawn in other ways until the terminal has answered all questions, and on until every cell is fine.
        picture = display.at_rest()
    assert _is_world(picture)
    # Neither leftovers in the colours of codes that were misunderstood, nor a world that is still black in part.
    for garbage in ((205, 0, 205), (0, 205, 205)):
        assert _share(picture, garbage) < 0.001
