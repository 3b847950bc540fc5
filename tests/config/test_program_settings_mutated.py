"""No text makes the reader of programs fail: programs with random changes give a robot, or the default one."""

from __future__ import annotations

import ast
import copy
import random
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tests.sources import ROOT
from tuisim.config.program_file import parse_program
from tuisim.config.program_settings import facts_of, program_settings, robot_for
from tuisim.errors import RobotError
from tuisim.source import Program

_FOLDERS = ("brick_programs", "pybricks_programs", "real_programs")
_VALUES = (
    "0",
    "-1",
    "1e400",
    "None",
    "''",
    "'outA'",
    "[]",
    "{}",
    "self",
    "x",
    "f(*x)",
    "lambda: x",
)


def _programs() -> list[ast.Module]:
    files = [
        file for folder in _FOLDERS for file in sorted((ROOT / "tests" / folder).rglob("*.py"))
    ]
    assert files
    return [ast.parse(file.read_text(encoding="utf-8")) for file in files]


def _mutants(count: int, seed: int) -> Iterator[str]:
    """Yield programs in which some expressions and statements are others, twice there or missing."""
    chance, programs = random.Random(seed), _programs()
    for _ in range(count):
        tree = copy.deepcopy(chance.choice(programs))
        for _ in range(chance.randint(1, 5)):
            _mutate(tree, chance)
        # Not every tree has a text: a format string takes no lambda.
        with suppress(ValueError):
            yield ast.unparse(ast.fix_missing_locations(tree))


def _mutate(tree: ast.Module, chance: random.Random) -> None:
    places = [*_places(tree)]
    if not places:
        return
    values, at = chance.choice(places)
    others = [given[place] for given, place in places if type(given[place]) is type(values[at])]
    kind = chance.randrange(4)
    if isinstance(values[at], ast.stmt):
        # A block is never empty.
        changed = [[ast.Pass()], [values[at]] * 2, [chance.choice(others)], [ast.Pass()]]
        values[at : at + 1] = copy.deepcopy(changed[kind])
    else:
        value = ast.parse(chance.choice(_VALUES), mode="eval").body
        values[at] = copy.deepcopy(value if kind == 0 else chance.choice(others))


class _Field(list[Any]):
    """The only value of a field of a node, as a list that changes the node."""

    def __init__(self, node: ast.AST, name: str) -> None:
        super().__init__([getattr(node, name)])
        self._node, self._name = node, name

    def __setitem__(self, at: Any, value: Any) -> None:
        super().__setitem__(at, value)
        setattr(self._node, self._name, value)


def _places(tree: ast.Module) -> Iterator[tuple[list[Any], int]]:
    """Yield where expressions that are read and statements stand: a list, and the index in it."""
    for node in ast.walk(tree):
        for name, value in ast.iter_fields(node):
            values = value if isinstance(value, list) else _Field(node, name)
            for at, inside in enumerate(values):
                is_read = isinstance(getattr(inside, "ctx", ast.Load()), ast.Load)
                if isinstance(inside, ast.stmt) or (isinstance(inside, ast.expr) and is_read):
                    yield values, at


@pytest.mark.parametrize(
    ("count", "seed"), [(200, 1), pytest.param(2_000, 26, marks=pytest.mark.slow)]
)
def test_no_text_makes_the_reader_fail(count: int, seed: int, tmp_path: Path) -> None:
    path = str(tmp_path / "p.py")
    read = [(text, facts_of(Program("p.py", text, path=path))) for text in _mutants(count, seed)]
    assert sum(facts.robot is not None for _, facts in read) > count / 4
    assert [(facts.unread, text) for text, facts in read if "failed" in facts.unread] == []


def test_a_failure_of_the_reader_gives_the_default_robot_and_a_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_given: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("tuisim.config.program_robot.assembly.build_robot", fail)
    source = parse_program("from ev3dev2.motor import MoveTank\n", "p.py")
    decided = program_settings(source).decided
    why = "tuisim failed to read the robot from its text (ZeroDivisionError)"
    assert decided.note.startswith(
        f"p.py runs as on a brick (profile ev3); {why}: it gets the default robot. "
    )
    with pytest.raises(RobotError, match="ZeroDivisionError"):
        robot_for(source)


def test_an_impossible_size_gives_the_default_robot_and_a_sentence() -> None:
    text = (
        "from ev3dev2.motor import MoveDifferential\nfrom ev3dev2.wheel import EV3Tire\n"
        "from ev3dev2.sensor.lego import TouchSensor\nbumper = TouchSensor()\n"
        "drive = MoveDifferential('outB', 'outC', EV3Tire, 12000)\n"
    )
    source = parse_program(text, "p.py")
    decided = program_settings(source).decided
    why = (
        "no robot can be what its text says (wheel_spacing_mm: must be a number from 1 to 1000, "
        "got 12000.0)"
    )
    assert decided.note.startswith(
        f"p.py runs as on a brick (profile ev3); {why}: it gets the default robot. "
    )
    assert "robot" not in decided.layer
    with pytest.raises(RobotError, match="got 12000"):
        robot_for(source)
