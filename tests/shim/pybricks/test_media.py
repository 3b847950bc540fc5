"""The constants of `pybricks.media.ev3dev`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tuisim.shim.pybricks.media import IMAGES, SOUNDS, ImageFile, SoundFile, name_of

FILES = json.loads(Path(__file__).with_name("api.json").read_text())["files"]


@pytest.mark.parametrize("of, count", [(SoundFile, 105), (ImageFile, 45)])
def test_a_constant_has_the_path_of_its_file_on_the_brick(of: type, count: int) -> None:
    found = {name: value for name, value in vars(of).items() if name.isupper()}
    assert found == {name: f"/usr/share/{path}" for name, path in FILES[of.__name__].items()}
    assert len(found) == count


def test_a_path_has_the_name_of_its_constant() -> None:
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", SOUNDS) == "UH_OH"
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", IMAGES) is None
