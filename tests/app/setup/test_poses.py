"""Where the robot is put: at random, to saved poses, by the mouse; and the ghost of the chart's cursor."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from textual.widgets import Input, OptionList

from tests.app.app_help import (
    LOGS,
    open_lab,
    screen_text,
    until,
    until_shown,
)
from tests.cases import for_each, for_rows
from tuisim.app.setup.next_run import build_plan
from tuisim.app.setup.poses import (
    choose_random_pose,
    delete_pose,
    find_poses_file,
    has_room,
    load_poses,
    save_pose,
)
from tuisim.base.errors import ConfigError
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import Obstacle
from tuisim.settings.options import Settings

SPEC = build_plan(Settings()).spec
POSTS = tuple(Obstacle(x, y, 150, 150) for x in range(200, 2300, 500) for y in (150, 500, 850))


@for_rows(
    "pose, obstacles, solid, fit",
    [
        (Pose(50, 500, 0), (), False, False),
        (Pose(1000, 50, 0), (), True, False),
        (Pose(1000, 500, 0), (Obstacle(950, 450, 100, 100),), False, True),
        (Pose(1000, 500, 0), (Obstacle(950, 450, 100, 100),), True, False),
        # Beside the middle of its side, beyond its corner, and within its corner once it is turned.
        (Pose(1000, 500, 0), (Obstacle(1060, 400, 50, 200),), True, True),
        (Pose(1000, 500, 0), (Obstacle(1050, 610, 50, 50),), True, True),
        (Pose(1000, 500, 0), (Obstacle(880, 610, 120, 50),), True, True),
        (Pose(1000, 500, 45), (Obstacle(830, 560, 120, 50),), True, False),
    ],
)
def test_has_room_is_true_only_where_the_robot_touches_nothing_solid(
    pose: Pose, obstacles: tuple[Obstacle, ...], solid: bool, fit: bool
) -> None:
    spec = replace(SPEC, world=replace(SPEC.world, obstacles=obstacles, solid=solid))
    assert has_room(spec, pose) is fit


@for_each(seed=range(20))
def test_a_random_pose_is_a_free_place(seed: int) -> None:
    spec = replace(SPEC, world=replace(SPEC.world, obstacles=POSTS, solid=True))
    pose = choose_random_pose(spec, random.Random(seed))
    assert pose is not None
    assert has_room(spec, pose)


def test_choose_random_pose_gives_none_if_the_field_is_full() -> None:
    spec = replace(
        SPEC, world=replace(SPEC.world, obstacles=(Obstacle(0, 0, 2362, 1143),), solid=True)
    )
    assert choose_random_pose(spec, random.Random(1)) is None


def test_saved_poses_are_stored_replaced_and_deleted() -> None:
    assert load_poses() == {}
    save_pose("by the wall", Pose(1, 2, -90))
    save_pose(' "odd" [name] = ü ', Pose(1.5, 2.25, 1e-3))
    save_pose("by the wall", Pose(3, 4, 5))
    assert load_poses() == {"by the wall": Pose(3, 4, 5), '"odd" [name] = ü': Pose(1.5, 2.25, 1e-3)}
    delete_pose("by the wall")
    delete_pose("no such")
    assert list(load_poses()) == ['"odd" [name] = ü']


def test_saving_a_pose_keeps_the_users_comments() -> None:
    find_poses_file().write_text(
        "# My poses\n[poses.a]  # the door\nx_mm = 1\ny_mm = 2\nheading_deg = 0\n"
    )
    save_pose("b", Pose(1, 2, 3))
    assert find_poses_file().read_text().startswith("# My poses\n[poses.a]  # the door\nx_mm = 1\n")
    delete_pose("a")
    delete_pose("b")
    assert (load_poses(), find_poses_file().read_text()[:10]) == ({}, "# My poses")


@pytest.mark.parametrize(
    "name", ["", "  ", "x" * 41, "two\nlines"], ids=["empty", "blank", "long", "lines"]
)
def test_a_pose_needs_a_name(name: str) -> None:
    with pytest.raises(ConfigError, match="a pose needs a name"):
        save_pose(name, Pose(0, 0, 0))
    assert not find_poses_file().exists()


@pytest.mark.parametrize(
    "text, said",
    [
        ("[poses.a]\nx_mm = 1\ny_mm = 2\n", "poses.a.heading_deg: is missing"),
        ("[poses.a]\nx_mm = nan\ny_mm = 2\nheading_deg = 0\n", "poses.a.x_mm: must be a number"),
        ("places = 3\n", "places: no such key"),
        ("[[[", "is not TOML"),
    ],
)
def test_saving_a_pose_into_a_faulty_file_says_why_and_leaves_it_unchanged(
    text: str, said: str
) -> None:
    find_poses_file().write_text(text)
    with pytest.raises(ConfigError, match=said):
        save_pose("b", Pose(0, 0, 0))
    assert find_poses_file().read_text() == text


@pytest.mark.slow
async def test_a_pose_saved_in_the_app_can_be_chosen_again() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        app.run_controller.place(Pose(700, 300, 45))
        await pilot.press("P")
        await until(pilot, lambda: isinstance(app.focused, Input))
        assert "None yet" in screen_text(app)
        await pilot.press(*"corner", "enter")
        await until(
            pilot, lambda: "x 700, y 300, 45°" in screen_text(app).partition("Save where")[0]
        )
        await pilot.press("escape", "m", "P")
        await until(pilot, lambda: isinstance(app.focused, OptionList))
        await pilot.press("down", "enter")
        await until(pilot, lambda: len(app.screen_stack) == 1)
        assert app.run_controller.pose == Pose(700, 300, 45)
        await pilot.press("P")
        await until(pilot, lambda: isinstance(app.focused, OptionList))
        await pilot.press("down", "delete")
        await until_shown(pilot, "None yet")
        assert load_poses() == {}
