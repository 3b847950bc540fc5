"""The mats on which lessons try programs again are those that the script draws."""

from __future__ import annotations

import numpy as np
import pytest
from lesson_mats import BANDS, FOLDER, draw
from PIL import Image

from tuisim.tasks.lessons.catalogue import find_shipped_paths


@pytest.mark.parametrize("name", BANDS)
def test_lesson_mat_is_current_and_used(name: str) -> None:
    with Image.open(FOLDER / f"{name}.png") as image:
        assert np.array_equal(np.asarray(image), np.asarray(draw(name)))
    assert any(f"../mats/{name}.png" in path.read_text() for path in find_shipped_paths().values())


def test_every_lesson_mat_in_the_folder_is_one_of_the_drawn_ones() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == set(BANDS)
