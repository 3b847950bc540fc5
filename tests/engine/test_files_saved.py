"""Saving into an existing file keeps the user's comments, order and settings; what is saved reads back equal."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.engine import files
from tuisim.engine.core.spec import Obstacle, RobotSpec, RunSpec
from tuisim.engine.obstacles import load_obstacles, save_obstacles
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.robots import ROBOTS, RobotChoice, save_robot
from tuisim.settings.worlds import WorldFile, save_world


def saved(kind: str, old: str, thing: Any, folder: Path) -> str:
    """Save into a file that has a text already, check that it reads back, and return its new text."""
    file = folder / "mine.toml"
    file.write_bytes(old.encode())
    save, load = KINDS[kind]
    save(thing, file)
    assert load(str(file)) == thing
    return file.read_bytes().decode()


def load_run(file: str) -> RunSpec:
    return build_run_spec(Settings.merge(WorldFile.load(file).settings))


KINDS: dict[str, tuple[Callable[..., None], Callable[[str], object]]] = {
    "robot": (save_robot, lambda file: RobotChoice.load(file).spec),
    "obstacles": (save_obstacles, load_obstacles),
    "world": (save_world, load_run),
}


def test_a_robot_file_may_differ_from_any_robot(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("base = 'Small_Robot_Wide_Eyes'\nname = 'Wide'\nback_mm = -70", "utf-8")
    wide = replace(ROBOTS["Small_Robot_Wide_Eyes"], name="Wide", back_mm=-70.0)
    assert RobotChoice.load(str(file)).spec == wide


def in_order(kept: str, text: str) -> bool:
    """Whether a text has the lines of another one in the same order, with more lines between them."""
    lines = iter(text.split("\n"))
    return all(line in lines for line in kept.split("\n")[:-1])


ROBOT_FILE = """\
# Ann's robot, for the
# maze.

back_mm = -70   # was too long
[pen]           # felt tip
color='blue'
# The eyes look far ahead.
[color_sensors.left]
y_mm = 45
[color_sensors.right]
y_mm = 45
"""


def test_a_robot_file_keeps_comments_order_and_what_is_equal(tmp_path: Path) -> None:
    (tmp_path / "old.toml").write_text(ROBOT_FILE)
    robot = RobotChoice.load(str(tmp_path / "old.toml")).spec
    text = saved("robot", ROBOT_FILE, replace(robot, pen=replace(robot.pen, color="red")), tmp_path)
    assert in_order(ROBOT_FILE.replace("color='blue'", 'color="red"'), text)


ROBOT_FILES = {
    "empty": "",
    "blank": "\n",
    "comment": "# Only a comment.\n",
    "base": "base = 'Explorer'  # with a bumper\n",
    "dotted key": "pen.color = 'blue'\nname = 'x'",
    "inline table": "pen = {color = 'blue', width_mm = 3}",
    "eye taken away": "[color_sensors]\nleft.x_mm = 3\nright = false\n",
    "no gyro": "gyro = false # none\n",
    "CRLF": "name = 'x'\r\nback_mm = -70 # so\r\n[pen]\r\ndown = true\r\n",
    "motor": "weight = 'heavy'\n[motors]\noutA = 'medium'\n",
    "further sensor": "gyro = false\n[infrareds.a]\nport = 'in4'\n[pen]\nx_mm = 1\n[color_sensors.left]\nx_mm = 9\n",
    "other order": "[color_sensors.right]\nx_mm = 3 # r\n[pen]\n[color_sensors.left]\nx_mm = 4 # l\n",
    "quoted keys": "'name' = 'x'\n\"pen\".\"color\" = 'red'",
    "empty tables": "[pen]\n[color_sensors]\n[color_sensors.left]\n[ultrasonic]\n[color_sensors.right]\n[motors]\n",
    "inline in dotted keys": "color_sensors.left = {x_mm = 1}\ncolor_sensors.right.y_mm = 3",
    "list": "[ultrasonic]\nray_angles_deg = [\n  0, # ahead\n  1,\n]\n",
}


@pytest.mark.parametrize(
    "robot", [RobotSpec(name="new", weight=4.5), ROBOTS["Explorer"]], ids=["plain", "parts"]
)
@cases("old", ROBOT_FILES)
def test_a_robot_saved_into_another_robots_file_is_read_back(
    old: str, robot: RobotSpec, tmp_path: Path
) -> None:
    saved("robot", old, robot, tmp_path)


BOX = "# Posts.\n[[obstacle]]  # left\nx_mm = 1\ny_mm = 2\nwidth_mm = 3  # thin\nheight_mm = 4\n"
BOXES = {
    "one": BOX,
    "two": BOX * 2,
    "none": "obstacle = [] # none",
    "inline": "obstacle = [{x_mm = 1, y_mm = 2, width_mm = 3, height_mm = 4}]",
}


@pytest.mark.parametrize("count", [0, 1, 3])
@cases("old", BOXES)
def test_obstacles_saved_into_a_file_of_others_are_read_back(
    old: str, count: int, tmp_path: Path
) -> None:
    saved(
        "obstacles",
        old,
        tuple(Obstacle(1, 2, 3, number) for number in range(1, count + 1)),
        tmp_path,
    )


def test_saving_a_changed_obstacle_keeps_the_files_comments(tmp_path: Path) -> None:
    text = saved("obstacles", BOX, (Obstacle(1, 2, 9.0, 4),), tmp_path)
    assert text == BOX.replace("width_mm = 3 ", "width_mm = 9.0 ")


WORLD = """\
# Lesson 3
rays = true            # to see them
autorun = true
panels = ["chart"]     # the log
seed = 3
robot = "Small_Robot"  # a small one
[noise]
light = 5              # a dark room
"""


@pytest.mark.parametrize(
    "changes, expected",
    [
        (
            {"seed": 4, "robot": "Small_Robot", "noise.light": 5},
            WORLD.replace("seed = 3", "seed = 4"),
        ),
        (
            {"seed": 3, "robot": "Small_Robot", "noise.light": 9},
            WORLD.replace("light = 5 ", "light = 9 "),
        ),
    ],
    ids=["seed", "noise"],
)
def test_saving_a_world_keeps_keys_that_are_not_part_of_a_run(
    changes: dict[str, Any], expected: str, tmp_path: Path
) -> None:
    assert in_order(expected, saved("world", WORLD, build_run_spec(Settings(changes)), tmp_path))
    asked = Settings.merge(WorldFile.load(tmp_path / "mine.toml").settings)
    assert (asked["rays"], asked["autorun"], asked["panels_on"]) == (True, True, ("chart",))


WORLDS = {
    "preset": WORLD,
    "parted tables": "[robot.pen]\nx_mm = 1\n[start]\n[robot.gyro]\n[[remote]]\nbuttons = ['beacon']\n",
    "inline": "start = {x_mm = 1}\nrobot = {back_mm = -3}\nobstacle = []\n",
    "inside": "[robot]\nback_mm = -70\n[[remote]]\nbuttons = ['beacon']\n[beacon]\nx_mm = 1\ny_mm = 1",
    "files that are gone": "robot = 'gone.toml'\nprofile = 'gone.toml'\nobstacles = 'gone.json'\nprogram = 'gone.py'",
}


@pytest.mark.parametrize("robot", ["Small_Robot", "other"])
@cases("old", WORLDS)
def test_a_world_saved_into_another_worlds_file_is_read_back(
    old: str, robot: str, tmp_path: Path
) -> None:
    (tmp_path / "other.toml").write_text("back_mm = -80")
    word = "Small_Robot" if robot == "Small_Robot" else str(tmp_path / "other.toml")
    saved(
        "world",
        old,
        build_run_spec(Settings({"robot": word, "profile": "ev3", "obstacles": "Wall"})),
        tmp_path,
    )


@pytest.mark.parametrize("mats", ["own", "other"])
def test_a_folder_of_mats_stays_unless_it_replaces_the_mat(
    mats: str, root: Path, tmp_path: Path
) -> None:
    for folder, name in (("own", "Loop.png"), ("other", "maze.png")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / name).write_bytes((root / "backgrounds" / "Square.png").read_bytes())
    text = saved(
        "world", f"mats = '{mats}'", build_run_spec(Settings({"background": "Loop"})), tmp_path
    )
    assert ("mats" in text) == (mats == "other")


@pytest.mark.parametrize(
    "save, thing, old, said",
    [
        (
            save_robot,
            RobotSpec(),
            "owner = 'Ann'\nname = 'x'",
            "owner: no such key (one of .*; correct the file",
        ),
        (
            save_robot,
            RobotSpec(),
            "[pen]\ncap = 1",
            "pen.cap: no such key (one of .*; correct the file",
        ),
        (save_robot, RobotSpec(), WORLD, "rays: no such key"),
        (save_obstacles, (), "back_mm = -70", "back_mm: no such key"),
        (save_world, build_run_spec(Settings()), "sed = 1", "sed: no such key (did you mean seed"),
        (save_world, build_run_spec(Settings()), "seed = ", "is not TOML: "),
        (save_robot, RobotSpec(), "\xff", "is not UTF-8 text"),
    ],
    ids=["key", "inner key", "other kind", "obstacles", "world", "not TOML", "not UTF-8"],
)
def test_a_file_that_cannot_be_read_is_not_replaced(
    save: Callable[..., None], thing: object, old: str, said: str, tmp_path: Path
) -> None:
    file = tmp_path / "mine.toml"
    file.write_bytes(old.encode("latin-1"))
    with pytest.raises(ConfigError) as caught:
        save(thing, file)
    assert all(part in str(caught.value) for part in (str(file), *said.split(".*")))
    assert file.read_bytes() == old.encode("latin-1")


def test_a_failed_save_of_settings_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine.toml").write_text(ROBOT_FILE)

    def full(*_: object, **__: object) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, "replacing", full)
    with pytest.raises(
        ConfigError, match=r"mine\.toml: cannot be written: No space left on device"
    ):
        save_robot(RobotSpec(), tmp_path / "mine.toml")
    assert (tmp_path / "mine.toml").read_text() == ROBOT_FILE


def test_only_saving_into_an_existing_file_imports_its_library(tmp_path: Path) -> None:
    code = (
        "import sys; from tuisim.settings.robots import ROBOTS, RobotChoice, save_robot\n"
        "for imported in (False, True):\n"
        "    save_robot(ROBOTS['Explorer'], 'mine.toml'); RobotChoice.load('mine.toml')\n"
        "    assert ('tomlkit' in sys.modules) == imported"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=tmp_path)
