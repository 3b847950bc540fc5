"""Functions as programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveTank
from ev3dev2.motor import SpeedPercent as Speed

import tuisim
from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.programs.function import read_function

SPEED = 30
TURNS = {"few": [1, 2.5]}
WORLD = tuisim.World()


def drive_turns(tank: Any, turns: float = TURNS["few"][0]) -> None:
    tank.on_for_rotations(Speed(SPEED), Speed(SPEED), turns)


def drive() -> None:
    drive_turns(MoveTank(OUTPUT_B, OUTPUT_C))
    print("Angle:", math.pi)
    raise ValueError("here")


def use_course_names() -> None:
    tank_drive.on_for_rotations(Speed(50), Speed(50), 1)  # type: ignore[name-defined]  # noqa: F821
    print("Colour:", colorLeft.reflected_light_intensity_pc)  # type: ignore[name-defined]  # noqa: F821


def build_inner(number: int) -> Callable[[], None]:
    def show() -> None:
        print("Number:", number)

    return show


def use_world() -> None:
    print(WORLD)


def test_a_function_takes_along_what_it_uses_and_points_into_its_file() -> None:
    run = tuisim.simulate(drive)
    line = drive.__code__.co_firstlineno + 3
    assert (run.state, run.samples["value"].tolist()) == ("raised", [pytest.approx(math.pi)])
    assert f'File "{__file__}", line {line}, in drive' in run.error
    assert run.stored.end is not None and run.stored.end.error_line == line
    assert run.pose.y_mm > run.stored.spec.world.start.y_mm or run.pose.x_mm > 100


def test_names_that_are_nowhere_are_the_predefined_ones() -> None:
    run = tuisim.simulate(use_course_names)
    assert (run.state, run.samples["variable"].tolist()) == ("finished", ["Colour"])


def test_a_function_knows_the_values_around_it() -> None:
    assert tuisim.simulate(build_inner(7)).output == "Number: 7\n"


def test_functions_are_programs_of_an_experiment() -> None:
    frame = tuisim.experiment([build_inner(1), use_course_names], seeds=[0], jobs=1)
    assert frame["Number_last"].tolist()[:1] == [1]
    assert frame["program"].tolist() == [
        "test_function.py:show",
        "test_function.py:use_course_names",
    ]


def test_a_function_of_another_file_goes_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "own_helpers.py").write_text("def count():\n    return 4\n")
    (tmp_path / "own_main.py").write_text(
        "from own_helpers import count\ndef go():\n    print('A:', count())\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    own_main = import_module("own_main")
    try:
        assert tuisim.simulate(own_main.go).output == "A: 4\n"
    finally:
        for name in ("own_main", "own_helpers"):
            del sys.modules[name]


def _without_source() -> Any:
    names: dict[str, Any] = {}
    exec("def typed():\n    print(1)\n", names)
    return names["typed"]


@cases(
    "program, words",
    {
        "a value that cannot go along": (use_world, "use_world uses WORLD, a World, which cannot"),
        "a lambda": (lambda: None, "<lambda> .* is not a program"),
        "parameters": (build_inner, "build_inner as a program takes no arguments: number"),
        "no source": (_without_source(), "the function typed has no source"),
        "no function": (3, "3 is not a program"),
    },
)
def test_what_is_no_program_is_refused_by_name(program: Any, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        read_function(program)
