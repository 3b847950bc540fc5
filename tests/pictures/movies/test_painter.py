"""Frames of a movie: where the panels are, and what is written above them."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.base.errors import ConfigError
from tuisim.pictures.charts.layout import Words
from tuisim.pictures.movies.clip import ClipPanel, ClipRun
from tuisim.pictures.movies.painter import WIDTH_PX, FramePainter, PictureBox, _place_boxes

ALL = tuple(ClipPanel)
SETS = [panels for count in (1, 2, 3) for panels in combinations(ALL, count)]


def overlap(one: PictureBox, other: PictureBox) -> bool:
    return (
        one.left < other.left + other.width
        and other.left < one.left + one.width
        and one.top < other.top + other.height
        and other.top < one.top + one.height
    )


@for_each(size=[(320, 400), (600, 500), (1920, 1080)], panels=SETS)
def test_panels_of_a_movie_lie_inside_the_picture_without_overlap(
    panels: tuple[ClipPanel, ...], size: tuple[int, int]
) -> None:
    boxes = _place_boxes(panels, size, 2)
    assert boxes.keys() == set(panels)
    assert not any(overlap(one, other) for one, other in combinations(boxes.values(), 2))
    for box in boxes.values():
        assert 0 <= box.left <= box.left + box.width <= size[0]
        assert 0 < box.top < box.top + box.height <= size[1]


def test_a_size_without_room_for_a_panel_is_refused() -> None:
    with pytest.raises(ConfigError, match="160x120 is too small"):
        _place_boxes(ALL, (160, 120), 2)


def test_a_movies_frame_has_the_chosen_size_or_one_that_fits_its_panels(recorded: ClipRun) -> None:
    moment = recorded.read_moment(0.1)
    assert FramePainter(recorded, (ClipPanel.WORLD,), (0, 0.5), (320, 240)).image(moment).size == (
        320,
        240,
    )
    world = FramePainter(recorded, (ClipPanel.WORLD,), (0, 0.5))
    both = FramePainter(recorded, (ClipPanel.WORLD, ClipPanel.CHART), (0, 0.5))
    assert world.size[0] == both.size[0] == WIDTH_PX
    assert world.size[1] < both.size[1]


def test_the_caption_of_a_movies_frame_has_as_many_values_as_fit(recorded: ClipRun) -> None:
    def words(size: tuple[int, int]) -> list[str]:
        painter = FramePainter(recorded, (ClipPanel.WORLD,), (0, 0.5), size)
        return [
            shape.text
            for shape in painter.draw(recorded.read_moment(0.3)).shapes
            if isinstance(shape, Words)
        ]

    assert words((320, 240)) == ["0.30 s", "Colour: 50"]
    assert words((90, 240)) == ["0.30 s"]


def test_the_world_in_a_movie_differs_between_two_frames(recorded: ClipRun) -> None:
    painter = FramePainter(recorded, (ClipPanel.WORLD,), (0, 0.5), (320, 240))
    first, last = (np.asarray(painter.image(recorded.read_moment(time_s))) for time_s in (0.0, 0.5))
    # Below the caption.
    assert (first[40:] != last[40:]).any()
