"""The constants of `pybricks.media.ev3dev`."""

from __future__ import annotations

from tuisim.engine.shim.pybricks.media import IMAGES, SOUNDS, name_of


def test_a_path_has_the_name_of_its_constant() -> None:
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", SOUNDS) == "UH_OH"
    assert name_of("/usr/share/sounds/ev3dev/expressions/uh-oh.wav", IMAGES) is None
