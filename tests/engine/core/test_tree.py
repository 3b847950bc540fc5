"""A run as a tree of values: paths, other values, plain data; and what one more value takes."""

from __future__ import annotations

import json
import os
import shutil
import site
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any
from venv import EnvBuilder

import pytest

from tests.cases import for_each
from tests.conftest import ROOT
from tests.running import PATIENCE_S
from tuisim.base.errors import ConfigError, RobotError
from tuisim.engine.core import tree
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, TouchSpec, WorldSpec

RUN = RunSpec(RobotSpec(touch_sensors=(TouchSpec(),), ultrasonic=None), WorldSpec(), ROBOLAB)

Said = Callable[..., str]


@pytest.mark.parametrize(
    "path, value",
    [
        ("seed", 0),
        ("world.noise.light", 0),
        ("world.start.heading_deg", 0.0),
        ("robot.pen.color", "red"),
        ("robot.color_sensors.right.x_mm", 20.0),
        ("robot.touch_sensors.touch.width_mm", 20.0),
        ("profile.motor_law", "brick"),
    ],
)
def test_get_value_finds_each_value_of_a_run_by_its_path(path: str, value: object) -> None:
    assert tree.get_value(RUN, path) == value


@pytest.mark.parametrize("path", ["world.fog", "robot.color_sensors.middle.x_mm", "seed.x"])
def test_a_wrong_path_into_a_run_raises(path: str) -> None:
    with pytest.raises(LookupError):
        tree.get_value(RUN, path)


def test_putting_a_value_into_a_run_leaves_the_others_unchanged() -> None:
    changed = tree.put_all(
        RUN, {"world.noise.light": 5, "world.start.x_mm": 7.0, "robot.color_sensors.left.y_mm": 1.0}
    )
    assert (changed.world.noise.light, changed.world.start) == (5, Pose(7.0, 800.0, 0.0))
    assert [sensor.y_mm for sensor in changed.robot.color_sensors] == [1.0, 30.0]
    assert tree.put(tree.put(changed, "world", RUN.world), "robot", RUN.robot) == RUN


@pytest.mark.parametrize(
    "path, value, error, said",
    [
        (
            "world.noise.light",
            129,
            RobotError,
            "noise.light: must be a whole number from 0 to 128, got 129",
        ),
        ("world.walls", 1, RobotError, "walls: must be true or false, got 1"),
        (
            "robot.color_sensors.left.port",
            "in9",
            RobotError,
            "left.port: no such port 'in9' (one of in1, in2",
        ),
        ("robot.color_sensors.left.port", "in3", RobotError, "right.port: two sensors are on in3"),
        (
            "world.obstacles",
            (1,),
            RobotError,
            "obstacles: must be a table of keys and values, got (1,)",
        ),
        (
            "robot.weight",
            "heavy",
            RobotError,
            "weight: must be weightless, light, medium, heavy, or a number",
        ),
    ],
)
def test_putting_a_wrong_value_into_a_run_raises_with_the_reason(
    path: str, value: object, error: type[ConfigError], said: str
) -> None:
    with pytest.raises(error) as caught:
        tree.put(RUN, path, value)
    assert str(caught.value).startswith(said)


def test_values_put_into_a_run_together_are_checked_together() -> None:
    # Each port by itself is that of the other wheel.
    changed = tree.put_all(RUN, {"robot.left_port": "outC", "robot.right_port": "outB"})
    assert (changed.robot.left_port, changed.robot.right_port) == ("outC", "outB")


def test_a_run_dumped_to_json_loads_as_the_same_run() -> None:
    plain = json.loads(json.dumps(tree.dump_run(RUN)))
    assert tree.load_run(plain) == tree.restore(plain) == RUN
    # What came later is left out where it is as it was.
    assert "gear_ratio" not in plain["robot"]
    assert plain["robot"]["ultrasonic"] is None


@for_each(
    damage=["x", [], None, True],
    path=[
        "",
        "robot",
        "world",
        "profile",
        "world.noise",
        "world.start",
        "world.start.x_mm",
        "robot.pen",
    ],
)
def test_loading_a_run_from_data_of_a_wrong_type_raises(path: str, damage: object) -> None:
    plain: dict[str, object] = json.loads(json.dumps(tree.dump_run(RUN)))
    whole: dict[str, Any] = {"": plain}
    inside: Any = whole
    *outer, last = ["", *path.split(".")] if path else [""]
    for name in outer:
        inside = inside[name]
    inside[last] = damage
    for read in (tree.load_run, tree.restore):
        with pytest.raises((KeyError, TypeError, ValueError, ConfigError)):
            read(whole[""])


def test_restoring_a_run_checks_types_but_not_limits_of_values() -> None:
    plain = json.loads(json.dumps(tree.dump_run(RUN)))
    plain["world"]["noise"]["light"] = 129
    assert tree.restore(plain).world.noise.light == 129
    with pytest.raises(TypeError, match="weight is 'heavy'"):
        tree.restore({**plain, "robot": {**plain["robot"], "weight": "heavy"}})
    with pytest.raises(ConfigError, match=r"noise\.light"):
        tree.load_run(plain)
    plain["robot"]["ultrasonic"] = {"ray_angles_deg": [-21.0, [-14.0]]}
    with pytest.raises(TypeError, match="ray_angles_deg is"):
        tree.restore(plain)


def test_every_value_with_an_option_has_a_help_text() -> None:
    lacking = [path for path, value in tree.list_leaves(RunSpec) if value.flags and not value.help]
    assert lacking == []


AFTER = "    start: Pose = part("
NEW = """\
    friction: float = number(0, 1, default=0.5, later=True, flags=("--friction",), help="friction of the mat")
"""


@pytest.fixture
def with_friction(tmp_path: Path) -> Said:
    """Return what runs a command of a copy of the package whose world has one more value."""
    shutil.copytree(
        ROOT / "tuisim", tmp_path / "tuisim", ignore=shutil.ignore_patterns("__pycache__")
    )
    table = tmp_path / "tuisim" / "engine" / "core" / "spec.py"
    before = table.read_text()
    assert before.count(AFTER) == 1
    table.write_text(before.replace(AFTER, NEW + AFTER))
    # An environment of its own: the processes of programs know no PYTHONPATH.
    python = tmp_path / "venv" / "bin" / "python"
    EnvBuilder(symlinks=True).create(tmp_path / "venv")
    (folder,) = (tmp_path / "venv").glob("lib/python*/site-packages")
    (folder / "copy.pth").write_text("\n".join((str(tmp_path), *map(str, site.getsitepackages()))))
    environment = {
        **os.environ,
        "TUISIM_HOME": str(tmp_path / "home"),
        "TUISIM_ASSETS": str(ROOT),
    }

    def said(*words: str, code: int = 0, python_code: bool = False, **more: str) -> str:
        done = subprocess.run(
            [python, *(("-c",) if python_code else ("-m", "tuisim")), *words],
            cwd=tmp_path,
            env=environment | more,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=False,
        )
        assert done.returncode == code, done.stderr
        return done.stdout + done.stderr

    return said


FORM = """
from tuisim.app.setup.fields import find
from tuisim.app.setup.next_run import build_plan
from tuisim.settings.options import Settings
edit = find(build_plan(Settings()), "friction")
print(edit.label, edit.read(edit.write(build_plan(Settings()), "0,75")))
"""

SAVE = """
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.worlds import save_world
save_world(build_run_spec(Settings({"friction": 0.25})), "saved.toml")
"""


@pytest.mark.slow
def test_a_value_added_to_the_world_gets_option_magic_and_file_key(
    with_friction: Said, tmp_path: Path
) -> None:
    def friction() -> float:
        return float(
            json.loads(with_friction("runs", "show", "last", "--json"))["values"]["friction"]
        )

    (tmp_path / "a.py").write_text("print('A: 1')\n")
    (tmp_path / "b.py").write_text("# %%sim_magic --friction 0.125\nprint('A: 1')\n")
    (tmp_path / "w.toml").write_text("friction = 0.75\n")

    with_friction("run", "a.py")
    assert friction() == 0.5
    with_friction("run", "a.py", "--friction", "0.3")
    assert friction() == 0.3
    assert "values: friction 0.3" in with_friction("runs", "show", "last")
    assert "--friction: must be a number from 0 to 1, got '2'" in with_friction(
        "run", "a.py", "--friction", "2", code=2
    )
    with_friction("run", "b.py")
    assert friction() == 0.125
    with_friction("run", "w.toml", "a.py")
    assert friction() == 0.75
    assert "did you mean friction" in with_friction("run", _wrong_world(tmp_path), "a.py", code=2)
    rows = with_friction("batch", "a.py", "--set", "friction=0,1", "--json").splitlines()
    assert [json.loads(row)["friction"] for row in rows if row.startswith("{")] == [0, 1]
    (tmp_path / "home" / "config.toml").write_text("[simulation]\nfriction = 0.625\n")
    with_friction("run", "a.py")
    assert friction() == 0.625
    with_friction(SAVE, python_code=True)
    assert "friction = 0.25  " in (tmp_path / "saved.toml").read_text()
    assert with_friction(FORM, python_code=True) == "friction 0.75\n"
    assert "--friction" in with_friction("guide", "options")
    assert "friction" in with_friction("guide", "settings")
    completed = with_friction(
        _TUISIM_COMPLETE="bash_complete", COMP_WORDS="tuisim run --fric", COMP_CWORD="2"
    )
    assert "--friction" in completed


def _wrong_world(folder: Path) -> str:
    (folder / "wrong.toml").write_text("frixion = 0.5\n")
    return "wrong.toml"
