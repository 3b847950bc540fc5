"""Robots, obstacles, profiles and worlds: what files may leave out, and that what is written reads back."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.settings.makers import boxes, mm, presses, robots
from tuisim.base.errors import ConfigError, ObstacleError, RobotError
from tuisim.commands.batch_file import load_batch
from tuisim.engine.core.profile import PROFILES, MotorLaw
from tuisim.engine.core.remote_spec import BeaconSpec
from tuisim.engine.core.spec import (
    GyroSpec,
    InfraredSpec,
    MotorSpec,
    Obstacle,
    PenSpec,
    RobotSpec,
    RunSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.engine.obstacles import OBSTACLES, load_obstacles, save_obstacles
from tuisim.guide.catalogue import load_pages as guide_pages
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.profiles import load_profile
from tuisim.settings.robots import ROBOTS, RobotChoice, save_robot
from tuisim.settings.shared_options import parse_words
from tuisim.settings.worlds import WorldFile, save_world
from tuisim.tasks.goals.files import GoalsFile

Write = Callable[[str, str], str]

# Files are made anew by every example, so one folder may serve them all.


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a file of a test and return its path."""

    def write(name: str, text: str) -> str:
        (tmp_path / name).write_text(text, encoding="utf-8")
        return str(tmp_path / name)

    return write


@given(robot=robots())
def test_a_robot_reads_back_to_the_last_bit(robot: RobotSpec, tmp_path: Path) -> None:
    (tmp_path / "robot.toml").unlink(missing_ok=True)
    save_robot(robot, tmp_path / "robot.toml")
    assert RobotChoice.load(str(tmp_path / "robot.toml")).spec == robot


@given(found=st.lists(boxes, max_size=5).map(tuple))
def test_obstacles_read_back_to_the_last_bit(found: tuple[Obstacle, ...], tmp_path: Path) -> None:
    (tmp_path / "boxes.toml").unlink(missing_ok=True)
    save_obstacles(found, tmp_path / "boxes.toml")
    assert load_obstacles(str(tmp_path / "boxes.toml")) == found


own_profiles = st.builds(
    lambda base, cost_ns, speed: replace(
        base, name="mine", color_read_ns=cost_ns, max_speed_dps=speed
    ),
    st.sampled_from(list(PROFILES.values())),
    st.integers(0, 10**10),
    mm(1, 1e5),
)


@given(
    robot=robots() | st.sampled_from(list(ROBOTS)),
    background=st.sampled_from(["Empty_Map", "Radial_grey"]),
    obstacles=st.sampled_from(list(OBSTACLES)) | st.lists(boxes, max_size=3).map(tuple),
    profile=st.sampled_from(list(PROFILES)) | own_profiles,
    flags=st.fixed_dictionaries(
        {key: st.booleans() for key in ("walls", "solid", "pen_marks", "pen.down")}
    ),
    numbers=st.fixed_dictionaries(
        {
            "start.x_mm": mm(-1e4, 1e4),
            "start.y_mm": mm(-1e4, 1e4),
            "start.heading_deg": mm(-3e4, 3e4),
            "noise.light": st.integers(0, 128),
            "noise.motor": st.none() | st.integers(0, 500),
        }
    ),
    seed=st.integers(0, 2**63 - 1),
    beacon=st.none() | st.builds(BeaconSpec, mm(-1e4, 1e4), st.just(-5.5)),
    remote=st.lists(presses, max_size=3).map(tuple),
    program=st.sampled_from([None, "log_greys.py"]),
)
@pytest.mark.slow
def test_a_world_makes_the_same_run_again(
    robot: Any, program: str | None, flags: Any, numbers: Any, tmp_path: Path, **chosen: Any
) -> None:
    if isinstance(robot, RobotSpec):
        robot = RobotChoice(robot)
    spec = build_run_spec(Settings({"robot": robot, **flags, **numbers, **chosen}))
    (tmp_path / "lab.toml").unlink(missing_ok=True)
    save_world(spec, tmp_path / "lab.toml", program)
    world = WorldFile.load(tmp_path / "lab.toml")
    assert build_run_spec(Settings.merge(world.settings)) == spec
    assert world.program == program


EXPLORER = {
    field.name: getattr(ROBOTS["Explorer"], field.name)
    for field in fields(RobotSpec)
    if field.name != "name"
}


@pytest.mark.parametrize(
    "text, changes",
    [
        ("wheel_diameter_mm = 40", {"wheel_diameter_mm": 40.0}),
        ("weight = 'heavy'", {"weight": 9.0}),
        ("weight = 4.5", {"weight": 4.5}),
        ("left_port = 'outA'\nright_port = 'outD'", {"left_port": "outA", "right_port": "outD"}),
        (
            "left_port = 'none'\nright_port = 'none'\n[motors.outC]\nlow_deg = -90",
            {
                "left_port": "none",
                "right_port": "none",
                "extra_motors": (MotorSpec("outC", "medium", -90.0),),
            },
        ),
        ("gyro = false\nultrasonic = false", {"gyro": None, "ultrasonic": None}),
        ("[gyro]\nport = 'in4'", {}),
        ("[pen]\ncolor = 'Teal'", {"pen": PenSpec(color="teal")}),
        ("[ultrasonic]\nnoise_mm = 5", {"ultrasonic": UltrasonicSpec(noise_mm=5)}),
        ("[motors]\noutA = 'medium'", {"extra_motors": (MotorSpec("outA", "medium"),)}),
        ("right_reversed = true\ngear_ratio = 0.5", {"right_reversed": True, "gear_ratio": 0.5}),
        (
            "[motors]\noutD = 'large'\n[motors.outA]\nlow_deg = -90\nhigh_deg = 0\n[motors.outB]\nkind = 'medium'",
            {
                "extra_motors": (
                    MotorSpec("outD", "large"),
                    MotorSpec("outA", "medium", -90.0, 0.0),
                ),
                "left_motor": "medium",
            },
        ),
        (
            "ultrasonic = false\nmotors.outA.high_deg = 90\n[touch_sensors.end]\nport = 'in1'\npressed_by = 'outA'\n"
            "pressed_at = 'high'",
            {
                "ultrasonic": None,
                "extra_motors": (MotorSpec("outA", high_deg=90.0),),
                "touch_sensors": (TouchSpec("end", "in1", pressed_by="outA", pressed_at="high"),),
            },
        ),
        (
            "base = 'Explorer'\nname = 'mine'\nmotors.outA.low_deg = -90\ntouch_sensors.bumper.y_mm = 70",
            {
                **EXPLORER,
                "extra_motors": (MotorSpec("outA", low_deg=-90.0),),
                "touch_sensors": (TouchSpec("bumper", "in1", 0.0, 70.0, 60.0),),
            },
        ),
        (
            "ultrasonic = false\n[touch_sensors.nose]\nport = 'in1'",
            {"ultrasonic": None, "touch_sensors": (TouchSpec("nose"),)},
        ),
        (
            "gyro = false\n[infrared]\nangle_deg = 5",
            {"gyro": None, "infrared": InfraredSpec(angle_deg=5)},
        ),
        (
            "gyro = false\n[ultrasonics.back]\nport = 'in4'\nangle_deg = 180",
            {"gyro": None, "extra_ultrasonics": (UltrasonicSpec("back", "in4", angle_deg=180),)},
        ),
        (
            "base = 'Explorer'\nname = 'mine'\ninfrared = false\n[motors]\noutA = false\n[touch_sensors]"
            "\nbumper = false",
            {**EXPLORER, "infrared": None, "extra_motors": (), "touch_sensors": ()},
        ),
    ],
    ids=[
        "length",
        "weight by name",
        "weight",
        "motor ports",
        "no wheels",
        "no sensors",
        "as it is",
        "pen",
        "ultrasonic",
        "motor",
        "wheel motors",
        "end stops",
        "touch at an end stop",
        "changed parts of a base",
        "touch",
        "infrared",
        "second ultrasonic",
        "further parts taken away",
    ],
)
def test_what_a_robot_file_leaves_out_is_as_in_the_default_robot(
    text: str, changes: dict[str, Any], write: Write
) -> None:
    assert RobotChoice.load(write("mine.toml", text)).spec == replace(
        RobotSpec(name="mine"), **changes
    )


@pytest.mark.parametrize(
    "text, sensors",
    [
        ("[color_sensors.left]\ndiameter_mm = 30", [("left", 30), ("right", 20)]),
        ("[color_sensors]\nleft = false", [("right", 20)]),
        ("[color_sensors]\nleft = false\nright = false", []),
        ("[color_sensors]\nright = {}\nleft = {}", [("right", 20), ("left", 20)]),
        (
            "gyro = false\n[color_sensors.middle]\nport = 'in4'\nx_mm = 0\ny_mm = 50\ndiameter_mm = 8",
            [("left", 20), ("right", 20), ("middle", 8)],
        ),
    ],
    ids=["one changed", "one gone", "none", "other order", "a third"],
)
def test_a_robot_file_can_change_remove_and_add_colour_sensors(
    text: str, sensors: list[tuple[str, int]], write: Write
) -> None:
    found = RobotChoice.load(write("mine.toml", text)).spec.color_sensors
    assert [(sensor.name, sensor.diameter_mm) for sensor in found] == sensors


COURSE_ROBOT = {
    "wheeldiameter": 28,
    "wheelSpacing": 90,
    "wheelNoise": 50,
    "back": -60,
    "weight": "weightless",
    "pen": {"x": 1, "y": 2, "color": "Orange", "width": 8},
    "sensor1": {"enabled": True, "x": -10, "y": 15, "diameter": 10},
    "sensor2": {"enabled": False},
    "ultrasonic": {"enabled": True, "x": 0, "y": 10, "angle": 5, "noise": 2},
    "gyro": {"enabled": False},
}


def test_the_json_of_the_course_is_read(write: Write) -> None:
    small = ROBOTS["Small_Robot"]
    assert RobotChoice.load(write("old.json", json.dumps(COURSE_ROBOT))).spec == replace(
        small,
        name="old",
        color_sensors=small.color_sensors[:1],
        ultrasonic=UltrasonicSpec(y_mm=10.0, angle_deg=5.0, noise_mm=2.0),
        gyro=None,
        pen=PenSpec(1.0, 2.0, "orange", 8.0),
    )
    assert RobotChoice.load(write("bare.json", "{}")).spec == RobotSpec(name="bare")


SAVED_ROBOT = {
    **COURSE_ROBOT,
    "baseWeight": "medium",
    "width": 98,
    "height": 130,
    "wheelNoise": 7,
    "sensorNoise": 12,
}


@pytest.mark.parametrize(
    "changes, found",
    [
        ({}, {}),
        ({"width": "?", "height": None, "baseWeight": 3}, {}),
        ({"wheelNoise": None, "sensorNoise": None}, {"noise.motor": 1, "noise.light": None}),
        ({"weight": None}, {"weight": 6.0}),
        ({"weight": ""}, {"weight": 6.0}),
        ({"ultrasonic": {"x": 0, "y": 10, "angle": 5}}, {"ultrasonic_mm": 1.0}),
        (
            {"colour": 3, "gyro": {"enabled": True, "drift": 2}, "pen": {"cap": 1}},
            {"notes": "old.json: ignored unknown keys: pen.cap, gyro.drift, colour"},
        ),
    ],
    ids=[
        "whole",
        "box",
        "no noises",
        "null weight",
        "empty weight",
        "no ultrasonic noise",
        "unknown keys",
    ],
)
def test_a_robot_saved_by_the_old_simulator_is_read_with_its_noise_and_weight(
    changes: dict[str, Any], found: dict[str, Any], write: Write
) -> None:
    choice = RobotChoice.load(str(write("old.json", json.dumps({**SAVED_ROBOT, **changes}))))
    expected = {
        "noise.motor": 7,
        "noise.light": 12,
        "weight": 0.0,
        "ultrasonic_mm": 2.0,
        "notes": "",
        **found,
    }
    ultrasonic = choice.spec.ultrasonic
    assert ultrasonic is not None
    assert {
        "noise.motor": choice.motor_noise,
        "noise.light": choice.light_noise,
        "weight": choice.spec.weight,
        "ultrasonic_mm": ultrasonic.noise_mm,
        "notes": "".join(note[note.index("old.json") :] for note in choice.notes),
    } == expected


@pytest.mark.parametrize(
    "words, noise", [("", 50), ("-M 7", 7), ("-M 0", 0)], ids=["file", "switch", "none"]
)
def test_wheel_noise_of_the_file_is_the_runs_unless_a_switch_says_another(
    words: str, noise: int, write: Write
) -> None:
    robot = write("old.json", json.dumps(COURSE_ROBOT))
    spec = build_run_spec(Settings.merge({"robot": robot}, parse_words(words.split())))
    assert spec.world.noise.motor == noise


@pytest.mark.parametrize(
    "text, xs_mm",
    [
        ("wheel_diameter_mm = 40", [-60.0, 60.0]),
        ("[color_sensors.left]\ndiameter_mm = 30", [-60.0, 60.0]),
        ("[color_sensors.left]\nx_mm = -25", [-25.0, 20.0]),
    ],
    ids=["wheels", "diameter", "place"],
)
def test_eyes_that_a_file_places_stay_on_a_mat_with_places_of_its_own(
    text: str, xs_mm: list[float], write: Write
) -> None:
    spec = build_run_spec(
        Settings({"background": "Radial_grey", "robot": write("mine.toml", text)})
    )
    assert [sensor.x_mm for sensor in spec.robot.color_sensors] == xs_mm


@pytest.mark.parametrize(
    "name, text, found",
    [
        (
            "a.toml",
            "[[obstacle]]\nx_mm = 1\ny_mm = 2\nwidth_mm = 3\nheight_mm = 4.5",
            (Obstacle(1, 2, 3, 4.5),),
        ),
        ("a.toml", "obstacle = []", ()),
        (
            "a.json",
            "[[1, 2, 3, 4.5], [5, 6, 7, 8]]",
            (Obstacle(1, 2, 3, 4.5), Obstacle(5, 6, 7, 8)),
        ),
        ("a.json", "[]", ()),
    ],
    ids=["toml", "toml, none", "json", "json, none"],
)
def test_an_obstacle_file_gives_its_boxes(
    name: str, text: str, found: tuple[Obstacle, ...], write: Write
) -> None:
    assert load_obstacles(write(name, text)) == found


@pytest.mark.parametrize(
    "text, changes",
    [
        ("color_read_ms = 2.5", {"color_read_ns": 2_500_000}),
        ("clock_read_ns = 7", {"clock_read_ns": 7}),
        (
            "tick_hz = 50\nsolid = true\ntitle = 'Mine'",
            {"tick_hz": 50, "solid": True, "title": "Mine"},
        ),
        (
            "base = 'nbev3devsim'\nname = 'older'\ngyro_read_ms = 0",
            {"name": "older", "gyro_read_ns": 0},
        ),
        ("motor_law = 'nbev3devsim'", {"motor_law": MotorLaw.NBEV3DEVSIM}),
    ],
    ids=["ms", "ns", "rules", "base", "motor law"],
)
def test_what_a_profile_file_leaves_out_is_as_in_its_base_profile(
    text: str, changes: dict[str, Any], write: Write
) -> None:
    base = PROFILES["nbev3devsim" if "base" in text else "robolab"]
    assert load_profile(write("mine.toml", text)) == replace(base, **{"name": "mine", **changes})


def test_paths_in_a_world_are_relative_to_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lab = tmp_path / "lab"
    lab.mkdir()
    (tmp_path / "small.toml").write_text("base = 'Small_Robot'")
    (lab / "boxes.json").write_text("[[1, 2, 3, 4]]")
    (lab / "slow.toml").write_text("tick_hz = 50")
    (lab / "drive.py").write_text("")
    (lab / "lab.toml").write_text(
        "robot = '../small.toml'\nobstacles = 'boxes.json'\nprofile = 'slow.toml'\nprogram = 'drive.py'\n"
        "panels = ['chart', 'arrays']\nhidden_panels = ['controls']\nrays = true\n"
    )
    monkeypatch.chdir(tmp_path)
    world = WorldFile.load("lab/lab.toml")
    asked = Settings.merge(world.settings)
    spec = build_run_spec(asked)
    assert (spec.robot.name, spec.world.obstacles, spec.profile.tick_hz) == (
        "small",
        (Obstacle(1, 2, 3, 4),),
        50,
    )
    assert world.program == "lab/drive.py"
    assert [str(file) for file in world.files] == [
        "lab/lab.toml",
        "small.toml",
        "lab/boxes.json",
        "lab/slow.toml",
        "lab/drive.py",
    ]
    assert (asked["panels_on"], asked["panels_off"], asked["rays"]) == (
        ("chart", "arrays"),
        ("controls",),
        True,
    )


@pytest.mark.parametrize("name", ["mat.png", "mat", "pics/mat.png"])
def test_a_saved_world_names_its_mat_image_relative_to_its_folder(
    name: str, root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "lab" / "pics").mkdir(parents=True)
    shutil.copy(root / "backgrounds" / "Square.png", tmp_path / "lab" / name)
    monkeypatch.chdir(tmp_path)
    spec = build_run_spec(Settings({"background": f"lab/{name}", "background_fit": "centre"}))
    assert spec.world.background == str(tmp_path / "lab" / name)
    save_world(spec, "lab/lab.toml")
    assert str(tmp_path) not in (tmp_path / "lab" / "lab.toml").read_text()
    assert build_run_spec(Settings.merge(WorldFile.load("lab/lab.toml").settings)) == spec
    (tmp_path / "lab").rename(tmp_path / "moved")
    moved = build_run_spec(Settings.merge(WorldFile.load("moved/lab.toml").settings))
    assert moved.world.background == str(tmp_path / "moved" / name)


def test_layers_of_settings_are_laid_key_by_key_also_those_of_the_start(write: Write) -> None:
    write("base.toml", "background = 'Square'\n[start]\nx_mm = 300\n")
    magic = parse_words(["-b", "Loop", "-x", "700", "-N", "5", "-P", "green"])
    world = WorldFile.load(
        write("lab.toml", "background = 'Square'\n[pen]\ncolor = 'blue'")
    ).settings
    asked = Settings.merge(magic, world, parse_words(["-N", "9"]))
    spec = build_run_spec(asked)
    assert (spec.world.background, spec.world.start.x_mm) == ("Square", 700)
    assert (spec.world.noise.light, spec.robot.pen.color) == (9, "blue")
    based = WorldFile.load(
        write("based.toml", "world = 'base.toml'\nbackground = 'Loop'\n")
    ).settings
    assert build_run_spec(Settings.merge(based)).world.start.x_mm == 300


@pytest.mark.parametrize(
    "words, solid",
    [("", False), ("--solid", True), ("--profile ev3", True), ("--profile ev3 --no-solid", False)],
    ids=["default", "switch", "profile", "switch against the profile"],
)
def test_walls_are_solid_as_the_profile_says_unless_a_switch_says_otherwise(
    words: str, solid: bool
) -> None:
    assert build_run_spec(Settings.merge(parse_words(words.split()))).world.solid is solid


def run_like(**changes: Any) -> RunSpec:
    spec = build_run_spec(Settings())
    return replace(
        spec, **{key: replace(getattr(spec, key), **change) for key, change in changes.items()}
    )


@pytest.mark.parametrize(
    "save, thing, error",
    [
        (save_robot, replace(RobotSpec(), name="two\nlines"), RobotError),
        (save_robot, replace(RobotSpec(), pen=PenSpec(color="reed")), RobotError),
        (save_robot, replace(RobotSpec(), gyro=GyroSpec(name="other")), RobotError),
        (save_obstacles, (Obstacle(0, 0, 1, 1),) * 1001, ObstacleError),
        (save_world, run_like(robot={"name": ""}), RobotError),
        (save_world, run_like(profile={"tick_hz": 50}), ConfigError),
    ],
    ids=[
        "robot's name",
        "colour",
        "sensor's name",
        "many obstacles",
        "robot in a world",
        "profile in a world",
    ],
)
def test_saving_what_no_file_can_express_is_refused_and_writes_nothing(
    save: Callable[..., None], thing: object, error: type[ConfigError], tmp_path: Path
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("before")
    with pytest.raises(error, match="mine"):
        save(thing, file)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]
    assert file.read_text() == "before"


@pytest.mark.parametrize("name", ["folder.toml", "no/such.toml", "robot.txt", "robot"])
def test_a_place_that_cannot_be_written_is_told_and_left_as_it_is(
    name: str, tmp_path: Path
) -> None:
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(RobotError, match=name):
        save_robot(RobotSpec(), tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.toml"]


def test_the_toml_files_printed_in_the_guide_can_be_used_together(tmp_path: Path) -> None:
    pages = (page.source for page in guide_pages().values())
    blocks = [block for text in pages for block in text.split("```toml\n# ")[1:]]
    for block in blocks:
        name, _, text = block.partition("```")[0].partition("\n")
        (tmp_path / name).write_text(text)
    spec = build_run_spec(Settings.merge(WorldFile.load(tmp_path / "lab.toml").settings))
    assert [sensor.name for sensor in spec.robot.color_sensors] == ["left", "right"]
    assert (spec.profile.name, spec.profile.color_read_ns) == ("profile", 5_000_000)
    assert load_obstacles(str(tmp_path / "obstacles.toml")) == (Obstacle(900, 500, 200, 100),)
    explorer = RobotChoice.load(str(tmp_path / "explorer.toml")).spec
    assert [sensor.name for sensor in explorer.sensors] == ["left", "middle", "back", "bumper"]
    assert [goal.name for goal in GoalsFile.load(tmp_path / "bands_goals.toml").goals] == [
        "levels",
        "black",
        "finish",
    ]
    assert load_batch(tmp_path / "square.toml").programs == ("square.py",)
    gripper = RobotChoice.load(str(tmp_path / "gripper.toml")).spec
    assert (gripper.gear_ratio, gripper.extra_motors) == (
        0.5,
        (MotorSpec("outA", "medium", -90.0, 0.0),),
    )
    assert len(blocks) == 8
