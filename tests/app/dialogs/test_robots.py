"""The robot picker: pictures and parts."""

from __future__ import annotations

import numpy as np
import pytest

from tests.app.app_help import open_lab, screen_text, until
from tuisim.app.dialogs.robots import RobotPicker, describe_parts
from tuisim.engine.core.spec import RobotSpec
from tuisim.pictures.scene.portrait import draw_portrait
from tuisim.pictures.scene.robot import COLORED
from tuisim.pictures.scene.view import SQUARE
from tuisim.settings.robots import ROBOTS


def words_of(robot: RobotSpec) -> list[str]:
    return ["".join(text for text, _ in line).strip() for line in describe_parts(robot)]


def test_each_part_is_listed_with_its_port_and_place() -> None:
    assert words_of(ROBOTS["Explorer"]) == [
        "B C wheels ⌀ 56, 180 mm apart",
        "A   medium motor",
        "■ 1   bumper: 60 ahead",
        "■ 2   left: 30 ahead, ⌀ 20",
        "■ 3   infrared: 20 ahead",
        "4   gyro",
    ]


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("size", [(40, 12), (40, 40), (300, 150)], ids=str)
def test_a_robot_is_whole_in_its_picture(robot: str, size: tuple[int, int]) -> None:
    spec = ROBOTS[robot]
    picture = draw_portrait(spec, size, SQUARE).astype(int)

    drawn = (picture != picture[0, 0]).any(axis=2)
    assert drawn.any()
    assert not drawn[[0, -1]].any() and not drawn[:, [0, -1]].any()
    for part in (COLORED.body, COLORED.wheel, COLORED.marker):
        assert (np.abs(picture - part).sum(axis=2) < 90).any(), part


@pytest.mark.slow
async def test_a_search_without_a_match_shows_no_robot() -> None:
    async with open_lab() as (pilot, app):
        await pilot.press("r")
        await until(pilot, lambda: isinstance(app.screen, RobotPicker))
        await until(pilot, lambda: "wheels" in screen_text(app))
        await pilot.press(*"xyz")
        await until(pilot, lambda: "nothing here has these words" in screen_text(app))
        await until(pilot, lambda: "wheels" not in screen_text(app))


async def test_the_places_of_sensors_are_whole_in_a_narrow_tall_terminal() -> None:
    async with open_lab(size=(65, 58)) as (pilot, app):
        await pilot.press("r")
        await until(pilot, lambda: "right: 20 right, 30 ahead, ⌀ 20" in screen_text(app))
