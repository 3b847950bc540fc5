"""The same words give the same run by each way into tuisim, and an option of a brick's program changes only itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from tests.settings.golden import outside
from tuisim.api.descriptions import read_options
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.tree import dump_run
from tuisim.notebook.lab import Lab
from tuisim.programs.program_file import ProgramSource, read_program
from tuisim.programs.program_settings import build_program_settings, find_free_paths
from tuisim.settings.build import build_run_spec
from tuisim.settings.magic_line import parse_line
from tuisim.settings.options import Settings
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.marks.entries import build_entries
from tuisim.tasks.marks.students import find_students

PROGRAMS = {
    "tyre": """\
from ev3dev2.motor import MoveDifferential, OUTPUT_B, OUTPUT_C
from ev3dev2.wheel import EV3Tire
m = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 128)
m.on_for_distance(30, 500)
""",
    "reversed": """\
from ev3dev2.motor import LargeMotor, MoveTank, OUTPUT_C, OUTPUT_B
def forward(cm):
    tank.on_for_degrees(-30, -30, cm * 20)
tank = MoveTank(OUTPUT_C, OUTPUT_B)
forward(30)
""",
    "arm": """\
from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C
MediumMotor(OUTPUT_A).on_for_degrees(20, 45)
MoveTank(OUTPUT_B, OUTPUT_C).on_for_rotations(30, 30, 1)
""",
    "pybricks": """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
DriveBase(Motor(Port.B), Motor(Port.C), 43.2, 120).straight(300)
""",
    "of the course": "tank_drive.on_for_rotations(20, 20, 1)\n",
}
GOAL = '[[goal]]\nname = "done"\nfinish = true\n'

Change = Callable[[NextRun], NextRun]


class Option(NamedTuple):
    """An option, as each way into tuisim has it."""

    words: str
    choices: Mapping[str, Any]
    world: str
    key: Change
    changes: tuple[str, ...]
    """What it may change of the run."""


GROUND = ("world.floor", "world.walls")
"""What a program for a brick has only by the rules of a brick."""


def mat(name: str) -> Option:
    return Option(
        f"-b {name}",
        {"background": name},
        f'background = "{name}"',
        lambda plan: plans.change_mat(plan, name),
        ("world.background", "world.start", "world.obstacles", "robot.color_sensors"),
    )


def profile(name: str) -> Option:
    return Option(
        f"--profile {name}",
        {"profile": name},
        f'profile = "{name}"',
        lambda plan: plans.change_profile(plan, name),
        ("profile", "world.solid", *(GROUND if name in ("robolab", "nbev3devsim") else ())),
    )


def moved(**values: float) -> Change:
    def key(plan: NextRun) -> NextRun:
        return plans.move_start(plan, replace(plan.spec.world.start, **values))

    return key


def noise(**values: int) -> Change:
    return lambda plan: plans.change_noise(plan, NoiseSpec(**values))


OPTIONS: Mapping[str, Option] = {
    option.words: option
    for option in (
        Option("", {}, "seed = 0", lambda plan: plan, ()),
        *map(mat, ("Loop", "Grey_bands", "Obstacles_Test", "Empty_Map")),
        *map(profile, ("ev3", "robolab", "nbev3devsim", "lego-micropython", "pybricks4")),
        Option("-x 600", {"x": 600}, "start = { x_mm = 600 }", moved(x_mm=600), ("world.start",)),
        Option("-y 400", {"y": 400}, "start = { y_mm = 400 }", moved(y_mm=400), ("world.start",)),
        Option(
            "-a 90",
            {"angle": 90},
            "start = { heading_deg = 90 }",
            moved(heading_deg=90),
            ("world.start",),
        ),
        Option(
            "-o Square_posts",
            {"obstacles": "Square_posts"},
            'obstacles = "Square_posts"',
            lambda plan: plans.change_obstacle_set(plan, "Square_posts"),
            ("world.obstacles",),
        ),
        Option("-N 20", {"sensornoise": 20}, "noise.light = 20", noise(light=20), ("world.noise",)),
        Option("-M 20", {"motornoise": 20}, "noise.motor = 20", noise(motor=20), ("world.noise",)),
        Option(
            "--seed 4", {"seed": 4}, "seed = 4", lambda plan: plans.change_seed(plan, 4), ("seed",)
        ),
    )
}
"""By its words in the shell."""


OF_ITSELF = ("of the course", "--profile ev3")


def is_fitting(program: str, option: str) -> bool:
    """Return whether a program may run with an option: a profile may be for the other library.

    A course program that gets the rules of a brick by a key stays where it is.
    """
    of_pybricks = option in ("--profile lego-micropython", "--profile pybricks4")
    if option.startswith("--profile"):
        return of_pybricks is (program == "pybricks") and (program, option) != OF_ITSELF
    return True


TABLE = [
    (program, option) for program in PROGRAMS for option in OPTIONS if is_fitting(program, option)
]


@pytest.fixture
def folder(tmp_path: Path, home: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder to work in, in which nothing starts."""
    monkeypatch.chdir(tmp_path)
    assert home.parent.is_dir()
    with outside.nothing_starts():
        yield tmp_path


def runs_of(folder: Path, program: str, option: Option) -> dict[str, RunSpec]:
    """Return the run of a program with an option by each way into tuisim."""
    (folder / "class").mkdir(exist_ok=True)
    for path in ("p.py", "class/p.py"):
        (folder / path).write_text(PROGRAMS[program])
    (folder / "w.toml").write_text(f"{option.world}\n")
    (folder / "t.toml").write_text(f"{option.world}\n{GOAL}")
    (folder / "g.toml").write_text(GOAL)
    words = option.words.split()
    given = read_options(option.choices)
    commands = {
        "run": ("run", "p.py", *words),
        "app": ("p.py", *words),
        "batch": ("batch", "p.py", *words, "--jobs", "1"),
        "a world": ("run", "w.toml", "p.py"),
        "a world in the app": ("w.toml", "p.py"),
        "a task": ("run", "t.toml", "p.py"),
        "a batch of a task": ("batch", "t.toml", "p.py", "--jobs", "1"),
    }
    runs = {}
    for door, command in commands.items():
        outcome = outside.of_command(command)
        assert outcome.specs, (door, outcome.err)
        runs[door] = outcome.specs[0]
    runs["simulate"] = outside.of_choices("p.py", option.choices).specs[0]
    students = find_students(["class"]).students
    for door, goals, above in (("mark", "g.toml", given), ("mark in a world", "t.toml", {})):
        (entry,), _ = build_entries(students, GoalsFile.load(folder / goals), above)
        runs[door] = entry.specs[0]
    return runs | runs_in_app(read_program(folder / "p.py"), option)


def runs_in_app(source: ProgramSource, option: Option) -> dict[str, RunSpec]:
    """Return the run of a program in the app, if the option comes after it, and before."""
    plain = build_program_settings(source)
    before = Settings.merge(read_options(option.choices))
    opened = plans.build_first_plan(
        build_run_spec(plain.settings), plain.settings, plain.decided, source.program
    )
    later, _ = plans.follow_program(plans.build_plan(before, find_free_paths(before)), source)
    return {"a key in the app": option.key(opened).spec, "opened in the app": later.spec}


WITH_WORLD = ("a world", "a world in the app", "a task", "a batch of a task", "mark in a world")
"""There is no floor around the mat in a world or a task that does not say so."""


@pytest.mark.quick_cases("pybricks-*", "tyre-*")
@pytest.mark.parametrize("program, option", TABLE)
def test_command_app_notebook_and_api_give_a_program_the_same_run(
    program: str, option: str, folder: Path
) -> None:
    runs = runs_of(folder, program, OPTIONS[option])
    given_in_world = {"floor": False, **read_options(OPTIONS[option].choices)}
    source = read_program(folder / "p.py")
    on_field = build_run_spec(build_program_settings(source, given_in_world).settings)
    given = {door: on_field if door in WITH_WORLD else runs["run"] for door in runs}
    assert [door for door, spec in runs.items() if spec != given[door]] == []


@pytest.mark.quick_cases("tyre-*")
@pytest.mark.parametrize(
    "program, option", [pair for pair in TABLE if pair[0] in ("tyre", "reversed", "arm")]
)
def test_a_cell_and_a_file_with_the_same_magic_line_give_the_same_run(
    program: str, option: str, folder: Path
) -> None:
    (folder / "p.py").write_text(f"# %%sim_magic {option}\n{PROGRAMS[program]}")
    (of_file,) = outside.of_command(("run", "p.py")).specs
    lab = Lab()
    lab.apply(parse_line(option, "sim_magic"), PROGRAMS[program], "none")
    of_cell = lab.spec
    name = of_file.robot.name
    assert of_file == replace(of_cell, robot=replace(of_cell.robot, name=name))
    assert name == ("Robot of p.py" if program == "arm" else "Default_Robot")


def values_of(spec: RunSpec) -> dict[str, object]:
    """Return a run as values by path."""

    def flat(value: object, path: str) -> Iterator[tuple[str, object]]:
        if isinstance(value, dict):
            for key, inside in value.items():
                yield from flat(inside, f"{path}.{key}" if path else key)
        else:
            yield path, value

    return dict(flat(dump_run(spec), ""))


@pytest.mark.parametrize(
    "program, option", [(program, option) for program, option in TABLE if program[:2] != "of"]
)
def test_an_option_of_run_changes_only_its_own_setting(
    program: str, option: str, folder: Path
) -> None:
    (folder / "p.py").write_text(PROGRAMS[program])
    first, second = (
        values_of(outside.of_command(("run", "p.py", *words)).specs[0])
        for words in ((), option.split())
    )
    changed = {path for path in first.keys() | second.keys() if first.get(path) != second.get(path)}
    assert [path for path in changed if not path.startswith(OPTIONS[option].changes)] == []
