"""The constants of `pybricks.media.ev3dev`."""

from __future__ import annotations

from tuisim.engine.shim.pybricks.media import IMAGES, SOUNDS, name_of


def test_the_constant_of_a_sound_or_image_path_is_found() -> None:
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", SOUNDS) == "UH_OH"
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", IMAGES) is None
