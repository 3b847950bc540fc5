"""Names that were meant."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.base.meant import find_meant_names

SENSOR = {
    "ambient_light_intensity",
    "color",
    "color_name",
    "distance_centimeters",
    "distance_centimeters_continuous",
    "distance_inches",
    "full_reflected_light_intensity",
    "off",
    "on",
    "on_for_seconds",
    "reflected_light_intensity",
    "reflected_light_intensity_pc",
    "_secret",
}
MEANT = {
    "a beginning": ("reflected_light", ["reflected_light_intensity"]),
    "a beginning of two": ("distance", ["distance_inches", "distance_centimeters"]),
    "an end": (
        "intensity",
        ["ambient_light_intensity", "reflected_light_intensity", "full_reflected_light_intensity"],
    ),
    "another spelling": ("colour", ["color"]),
    "a letter too many": ("offf", ["off"]),
    "another word for it": ("forward", ["on"]),
    "a part of many": ("r", []),
    "nothing": ("banana", []),
    "private": ("secret", []),
}


@for_rows("wrong, names", MEANT)
def test_find_meant_names_gives_the_names_that_a_misspelt_one_is_near(
    wrong: str, names: list[str]
) -> None:
    assert find_meant_names(wrong, SENSOR) == names
