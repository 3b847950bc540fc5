"""Runs from scripts: `tuisim.simulate`."""

from __future__ import annotations

import ast
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tuisim
from tests.api.write_face import FACE, write_face
from tests.cases import cases, for_rows
from tests.conftest import ROOT
from tuisim.base.errors import ConfigError, LogError
from tuisim.commands.guide import find_page
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

LOGGER = """\
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 0:
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
tank_drive.off()
"""


def test_a_run_has_samples_telemetry_output_and_a_picture() -> None:
    run = tuisim.simulate(LOGGER, background="Grey_bands", x=100, pendown=True)
    assert run.state == "finished"
    assert len(run.samples) == run.output.count("Colour: ") > 100
    assert run.telemetry["x_mm"].iloc[0] == 100
    assert run.time_s == pytest.approx(run.telemetry["time"].iloc[-1])
    picture = run.picture()
    assert picture.size == (897, 491)
    # The red trace crosses the first grey band.
    assert {picture.getpixel((175, row)) for row in range(266, 273)} == {
        (255, 0, 0),
        (220, 220, 220),
    }


def test_the_same_seed_gives_equal_sample_frames_and_another_seed_others() -> None:
    noisy = "for _ in range(20):\n    print('Colour:', colorLeft.reflected_light_intensity_pc)\n"
    first, second, other = (
        tuisim.simulate(noisy, background="Grey_bands", x=300, sensornoise=20, seed=seed).samples
        for seed in (3, 3, 4)
    )
    assert first.equals(second)
    assert not first.equals(other)


def test_a_run_that_simulate_returns_holds_the_programs_error() -> None:
    run = tuisim.simulate("x = 1\n1 / 0\n")
    assert (run.state, "ZeroDivisionError" in run.error) == ("raised", True)


@for_rows(
    "choices, expected",
    {
        "unknown argument": ({"backgrond": "Loop"}, "did you mean background"),
        "constants": ({"constants": {"K": 1}}, "tuisim.experiment has it"),
        "goals": ({"goals": "g.toml"}, r"Run.judge\(goals\) has it"),
        "boxes": (
            {"obstacles": [{"x_mm": 4}]},
            "obstacles: must be one value, .*a file has several",
        ),
        "array": ({"motornoise": np.arange(3)}, "motornoise: must be one value"),
        "unknown mat": ({"background": "Nope"}, "^background: no such mat"),
        "no number": ({"x": "far"}, "x: must be a number"),
        "several": ({"x": [0, 20]}, "x: must be one value, .*experiment takes several"),
        "no truth value": ({"pendown": 1}, "pendown: must be true or false"),
        "text for a number": ({"x": "100"}, "x: must be a number"),
        "no time": ({"timeout_s": 0}, "timeout_s: must be a number above 0"),
    },
)
def test_simulate_refuses_wrong_arguments_with_a_reason(
    choices: dict[str, Any], expected: str
) -> None:
    with pytest.raises(ConfigError, match=expected):
        tuisim.simulate(LOGGER, **choices)


def test_import_loads_next_to_nothing() -> None:
    program = (
        "import sys; before = set(sys.modules); import tuisim; print(*(set(sys.modules) - before))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not {
        "numpy",
        "pandas",
        "PIL",
        "IPython",
        "tuisim.api.face",
        "tuisim.engine.runs.handle",
    } & set(done.stdout.split())


def test_the_guides_example_of_simulate_runs_and_saves_its_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = find_page("notebooks").source.split("```python\n")[1:]
    (example,) = [block.partition("```")[0] for block in blocks if "simulate(" in block]
    names: dict[str, Any] = {}
    exec(example, names)
    assert names["run"].state == "finished"
    assert (tmp_path / "world.png").stat().st_size > 1000


WAITS = """\
# %%sim_magic_preloaded --press enter@1
from ev3dev2.button import Button
Button().wait_for_pressed('enter')
"""


@cases(
    "choices, time_s",
    {
        "as its first line says": ({}, 1),
        "one": ({"press": ["enter@2"]}, 2),
        "several": ({"press": ["up@1", "enter@3"]}, 3),
        "in a world": ({"world": "hands.toml"}, 4),
    },
)
def test_buttons_are_pressed_by_hand_in_runs_and_experiments(
    choices: dict[str, Any], time_s: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hands.toml").write_text('press = ["enter@4"]\n')
    (tmp_path / "waits.py").write_text(WAITS)
    assert int(tuisim.simulate("waits.py", **choices).time_s) == time_s
    frame = tuisim.experiment("waits.py", jobs=1, **choices)
    assert frame["time_s"].astype(int).tolist() == [time_s]


@cases(
    "press, message",
    {
        "no list": (5, "press: must be a list of presses such as enter@1.5, got 5"),
        "no button": (
            ["up@1", "entre@1"],
            "press [2]: 'entre' cannot be pressed (did you mean enter?)",
        ),
        "no text": ([1], "press [1]: must be text, got 1"),
    },
)
def test_a_wrong_press_names_its_place(press: Any, message: str) -> None:
    with pytest.raises(ConfigError) as raised:
        tuisim.simulate(WAITS, press=press)
    assert str(raised.value) == message


LAB = """
background = "Loop"
arguments = ["fast"]
[start]
x_mm = 400
heading_deg = 45
[noise]
motor = 20
"""
POSE = "# %%sim_magic -x 100 -y 300\nimport sys\nprint(sys.argv[1:])\n"


def test_a_program_runs_in_a_world_file(tmp_path: Path) -> None:
    (tmp_path / "lab.toml").write_text(LAB)
    run = tuisim.simulate(POSE, world=tmp_path / "lab.toml", angle=-90)
    start = run.stored.spec.world.start
    assert (start.x_mm, start.y_mm, start.heading_deg) == (400, 300, -90)
    assert (run.stored.spec.world.background, run.output) == ("Loop", "['fast']\n")
    assert (
        tuisim.simulate(POSE, arguments=["slow"], world=tmp_path / "lab.toml").output
        == "['slow']\n"
    )


PYBRICKS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Direction, Port
from pybricks.robotics import DriveBase
left, right = (Motor(port, Direction.COUNTERCLOCKWISE, [12, 36]) for port in (Port.A, Port.D))
robot = DriveBase(left, right, wheel_diameter=55.5, axle_track=104)
robot.straight(100)
robot.turn(90)
print("Distance:", robot.distance())
"""


def test_a_pybricks_program_drives_as_far_as_it_asks_for() -> None:
    run = tuisim.simulate(PYBRICKS)
    assert (run.state, run.samples["value"].tolist()) == ("finished", [100])
    first, last = run.stored.telemetry.record(0), run.stored.telemetry.last()
    assert last is not None
    assert (last.x_mm - first.x_mm, last.y_mm - first.y_mm) == pytest.approx((100, 0), abs=1)
    # Positive turns are clockwise.
    assert last.heading_deg - first.heading_deg == pytest.approx(-90, abs=1)


def test_an_experiment_with_a_pybricks_program_measures_the_distance_driven() -> None:
    frame = tuisim.experiment(PYBRICKS, seeds=[1, 2], jobs=1)
    assert frame["Distance_last"].tolist() == [100, 100]


def test_an_experiment_takes_place_in_a_world_file_instead_of_that_of_its_goals(
    tmp_path: Path,
) -> None:
    (tmp_path / "lab.toml").write_text(LAB)
    (tmp_path / "goals.toml").write_text(
        "background = 'Square'\n[[goal]]\nname = 'done'\nfinish = true\n"
    )
    frame = tuisim.experiment(
        POSE, seeds=[1, 2], world=tmp_path / "lab.toml", goals=tmp_path / "goals.toml", jobs=1
    )
    assert (frame["x_mm"].tolist(), frame["goal_done"].tolist()) == ([400, 400], [True, True])


def test_simulate_takes_a_single_call_as_the_text_of_a_program() -> None:
    assert tuisim.simulate("print(1 + 1)").output == "2\n"


@cases(
    "describe, words",
    {
        "mat": (lambda: tuisim.World(background="Nope"), "^background: no such mat"),
        "hub": (lambda: tuisim.Robot(hub="PrimeHub"), "hub: needs a robot with its ports"),
    },
)
def test_a_robot_or_world_with_a_wrong_value_is_refused_when_it_is_created(
    describe: Callable[[], object], words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        describe()


def test_simulate_refuses_a_world_file_that_does_not_exist(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.toml: there is no such file"):
        tuisim.simulate(POSE, world=tmp_path / "nowhere.toml")


def test_load_run_takes_a_number_or_a_folder() -> None:
    made = tuisim.simulate("print('A: 1')\n").stored
    number = tuisim.load_run("last").stored.number
    names: list[Any] = [number, str(number), np.int64(number), made.folder]
    for name in names:
        assert tuisim.load_run(name).stored.id == made.id


def test_runs_are_equal_if_they_are_the_same_stored_run() -> None:
    run, other = tuisim.simulate("print(1)"), tuisim.simulate("print(1)")
    assert run == tuisim.load_run(run.number) == pickle.loads(pickle.dumps(run)) != other
    assert len({run, tuisim.load_run(run.stored.folder), other}) == 2


NO_RUNS = {
    "number": (99999, "no run '99999'"),
    "negative": (-1, "no run '-1'"),
    "many digits": (10**5000, "no run has a number as large as this"),
    "nothing": (None, "this names no run: None (its number"),
    "fraction": (1.5, "this names no run: 1.5"),
    "bytes": (b"last", "this names no run: b'last'"),
}


@cases("run, words", NO_RUNS)
def test_load_run_refuses_words_that_name_no_run(run: Any, words: str) -> None:
    tuisim.simulate("print('A: 1')\n")
    with pytest.raises(LogError, match=re.escape(words)):
        tuisim.load_run(run)


@cases(
    "given, words",
    {
        "one seed": ({"seeds": 3}, "seeds: must be several, got 3"),
        "jobs": ({"jobs": -1}, "jobs: must be a whole number from 0 to 1000, got -1"),
    },
)
def test_experiment_refuses_wrong_arguments_with_a_reason(
    given: dict[str, Any], words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        tuisim.experiment("log_greys", **given)


def test_the_face_is_as_the_list_of_options_writes_it() -> None:
    assert FACE.read_text(encoding="utf-8") == write_face()


def test_the_package_has_no_other_public_names() -> None:
    assert set(dir(tuisim)) == {
        *(
            "Lab",
            "Robot",
            "World",
            "experiment",
            "load_run",
            "mark",
            "read_log",
            "runs",
            "simulate",
        ),
        *("__version__", "load_ipython_extension"),
    }


@cases(
    "call, expected",
    {
        "an option": ("tuisim.simulate('log_greys', backg", ["background=", "background_fit="]),
        "of an experiment": ("tuisim.experiment('log_greys', sens", ["sensornoise="]),
        "of a world": ("tuisim.World(pendo", ["pendown="]),
        "a name": ("tuisim.sim", ["simulate"]),
    },
)
def test_an_editor_completes_names_and_options_of_the_api(call: str, expected: list[str]) -> None:
    import jedi

    completions = jedi.Script(f"import tuisim\n{call}").complete(2, len(call))
    assert [one.name for one in completions] == expected


def _misspell() -> None:
    """Never called: the type check of all tests refuses a comment where it has nothing to ignore."""
    tuisim.simulate("log_greys", backgrond="Loop")  # type: ignore[call-arg]
    tuisim.experiment("log_greys", sensornose=[0, 20])  # type: ignore[call-arg]
    tuisim.World(anlge=3)  # type: ignore[call-arg]
    tuisim.experiment("log_greys", sensornoise=[0, 20], robot=tuisim.Robot(gear_ratio=2))


def test_repr_of_a_run_is_one_line_and_its_html_has_a_picture() -> None:
    run = tuisim.simulate("print('A: 1')\nraise ValueError('<b>')\n")
    assert re.fullmatch(
        r"<run \d+ of program under robolab: raised after 0\.\d\d s: ValueError: <b> \(line 2\)>",
        repr(run),
    )
    assert repr(run.stored) == repr(run)
    assert tuisim.load_run(run.number).stored.folder == run.stored.folder
    page = run._repr_html_()
    assert page.startswith('<img src="data:image/png;base64,')
    assert "ValueError: &lt;b&gt;" in page
    assert "<td>A</td>" in page


def test_descriptions_are_one_line_and_compared_by_their_values() -> None:
    number: Any = np.int64(3)
    world = tuisim.World(background="Loop", x=number)
    assert repr(world) == "World(background='Loop', x=3)"
    assert world == tuisim.World(background="Loop", x=3) != tuisim.World(background="Loop")
    assert len({world, tuisim.World(background="Loop", x=3), tuisim.Robot()}) == 2
    with pytest.raises(AttributeError, match="World has no attribute 'x'; print it"):
        print(world.x)  # type: ignore[attr-defined]


@for_rows(
    "describe, words",
    {
        "no such robot": (lambda: tuisim.Robot("Nope"), "no such robot"),
        "wrong size": (lambda: tuisim.Robot(wheel_diameter_mm=-1), "wheel_diameter_mm"),
        "unknown part": (lambda: tuisim.Robot(parts={"arm": {}}), "arm"),
        "misspelt sensor": (
            lambda: tuisim.Robot(parts={"color_sensors.lefft.diameter_mm": 20}),
            r"lefft.port: is missing .did you mean left\?",
        ),
        "option of a call": (
            lambda: tuisim.World(profile="ev3"),  # type: ignore[call-arg]
            r"tuisim\.simulate\(profile=…\) has it",
        ),
        "track": (
            lambda: tuisim.Robot(track_mm=140),  # type: ignore[call-arg]
            "did you mean wheel_spacing_mm",
        ),
        "separator": (
            lambda: tuisim.read_log("log.csv", sep=";"),  # type: ignore[call-arg]
            "did you mean separator",
        ),
        "no file": (lambda: tuisim.World("nowhere.toml"), "no such file"),
        "wrong value": (lambda: tuisim.World(drift="wide"), "no such value"),
    },
)
def test_a_wrong_description_is_refused_where_it_is_written(describe: Any, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        describe()


def test_the_docstrings_example_of_robot_parts_builds_a_robot() -> None:
    example = re.search(r"parts: .*`(.*?)`", tuisim.Robot.__doc__ or "")
    assert example
    assert tuisim.Robot(parts=ast.literal_eval(example[1])) != tuisim.Robot()


def test_simulate_uses_the_given_robot_and_world() -> None:
    robot = tuisim.Robot(wheel_diameter_mm=40, parts={"pen": {"width_mm": 5}})
    world = tuisim.World(background="Loop", x=300, sensornoise=20)
    spec = tuisim.simulate("print(1)\n", robot=robot, world=world, x=310).stored.spec
    assert (spec.robot.wheel_diameter_mm, spec.robot.pen.width_mm) == (40, 5)
    assert (spec.world.background, spec.world.start.x_mm) == ("Loop", 310)
    assert spec.world.noise.light == 20


def test_an_experiment_varies_each_option_that_is_a_list() -> None:
    frame = tuisim.experiment(
        "import sys\nprint('A:', len(sys.argv))\n",
        seeds=[5, 3],
        sensornoise=[0, 20],
        robot=[tuisim.Robot(), "Small_Robot"],
        parameters={"noise.motor": [0, 1]},
        arguments=["x"],
        x=100,
        jobs=1,
    )
    assert len(frame) == 16
    assert [*frame.columns[:5]] == ["run", "robot", "sensornoise", "noise.motor", "seed"]
    assert frame["robot"].tolist() == ["Default_Robot"] * 8 + ["Small_Robot"] * 8
    assert frame["sensornoise"].tolist() == [0] * 4 + [20] * 4 + [0] * 4 + [20] * 4
    assert frame["seed"].tolist() == [5, 3] * 8
    assert set(frame["A_last"]) == {2}


def test_runs_returns_the_stored_runs_as_a_table() -> None:
    first, second = (tuisim.simulate("print(1)\n", seed=seed).stored for seed in (4, 5))
    table = tuisim.runs().tail(2)
    assert table["number"].tolist() == [first.number, second.number]
    assert table["seed"].tolist() == [4, 5]


GOALS = """
background = "Empty_Map"
[[goal]]
name = "done"
finish = true
points = 2
"""


BRICK = "from ev3dev2.motor import LargeMotor\n"
SENSING = BRICK + "from ev3dev2.sensor.lego import UltrasonicSensor\nUltrasonicSensor()\n"


@pytest.mark.parametrize(
    "text, world, profile, x_mm, walls, solid",
    [
        ("print(1)\n", None, "robolab", 100, True, False),
        (BRICK, None, "ev3", 1181, False, True),
        (SENSING, None, "ev3", 1181, True, True),
        (BRICK, "lab.toml", "ev3", 280, True, True),
        ("print(1)\n", "lab.toml", "robolab", 500, True, False),
    ],
)
def test_a_world_has_the_defaults_that_the_page_names(
    tmp_path: Path, text: str, world: str | None, profile: str, x_mm: int, walls: bool, solid: bool
) -> None:
    (tmp_path / "lab.toml").write_text('background = "Loop"\n')
    spec = tuisim.simulate(text, world=world and tmp_path / world).stored.spec
    assert (spec.profile.name, spec.world.walls, spec.world.solid) == (profile, walls, solid)
    assert spec.world.start.x_mm == x_mm
    assert (FIELD_WIDTH_MM, FIELD_HEIGHT_MM) == (2362, 1143)


def test_mark_returns_the_points_of_each_student(tmp_path: Path) -> None:
    (tmp_path / "goals.toml").write_text(GOALS)
    for name, text in (("Ada", "print(1)\n"), ("Bob", "1 / 0\n")):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "main.py").write_text(text)
    marks = tuisim.mark(
        tmp_path / "goals.toml", tmp_path / "class", seeds=np.array([1]), jobs=1, isolate=False
    )
    assert marks[["student", "points"]].to_numpy().tolist() == [["Ada", 2], ["Bob", 0]]
    assert tuisim.runs()["tags"].tolist()[-1] == "student:Bob"
