"""No text makes the reader of programs fail: programs with random changes give a robot, or the default one."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tests.sources import ROOT
from tuisim.base.errors import RobotError
from tuisim.base.source import Program
from tuisim.programs.program_file import parse_program
from tuisim.programs.program_settings import build_program_settings, choose_robot, read_source_facts

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


class _Exchange(ast.NodeTransformer):
    """Puts other expressions in place of some."""

    def __init__(self, others: Mapping[ast.AST, str]) -> None:
        self._others = others

    def visit(self, node: ast.AST) -> Any:
        """Return what stands there then."""
        if node in self._others:
            return ast.parse(self._others[node], mode="eval").body
        return super().visit(node)


def _mutants(count: int, seed: int) -> Iterator[str]:
    """Yield programs in which some expressions are others."""
    files = [
        path for folder in _FOLDERS for path in sorted((ROOT / "tests" / folder).rglob("*.py"))
    ]
    chance = random.Random(seed)
    for _ in range(count):
        tree = ast.parse(chance.choice(files).read_text(encoding="utf-8"))
        nodes = [
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.expr) and isinstance(getattr(node, "ctx", ast.Load()), ast.Load)
        ]
        changed = chance.sample(nodes, min(len(nodes), chance.randint(1, 5)))
        words = [*_VALUES, *map(ast.unparse, chance.sample(nodes, len(changed)))]
        # Not every tree has a text: a format string takes no lambda.
        with suppress(ValueError):
            yield ast.unparse(
                _Exchange({node: chance.choice(words) for node in changed}).visit(tree)
            )


@pytest.mark.parametrize(
    ("count", "seed"), [(100, 1), pytest.param(500, 26, marks=pytest.mark.slow)]
)
def test_reading_the_robot_from_a_mutated_program_never_fails(
    count: int, seed: int, tmp_path: Path
) -> None:
    path = str(tmp_path / "p.py")
    read = [
        (text, read_source_facts(Program("p.py", text, path=path)))
        for text in _mutants(count, seed)
    ]
    assert sum(facts.robot is not None for _, facts in read) > count / 4
    assert [(facts.unread, text) for text, facts in read if "failed" in facts.unread] == []


def test_a_failure_while_reading_the_robot_gives_the_default_one_and_a_note(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_given: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("tuisim.programs.robot.assembly.build_robot", fail)
    source = parse_program("from ev3dev2.motor import MoveTank\n", "p.py")
    decided = build_program_settings(source).decided
    why = "tuisim failed to read the robot from its source (ZeroDivisionError)"
    assert decided.note.startswith(
        f"p.py runs as on a brick (profile ev3); {why}: it gets the default robot. "
    )
    with pytest.raises(RobotError, match="ZeroDivisionError"):
        choose_robot(source, "it")


def test_an_impossible_wheel_size_gives_the_default_robot_and_a_note() -> None:
    text = (
        "from ev3dev2.motor import MoveDifferential\nfrom ev3dev2.wheel import EV3Tire\n"
        "from ev3dev2.sensor.lego import TouchSensor\nbumper = TouchSensor()\n"
        "drive = MoveDifferential('outB', 'outC', EV3Tire, 12000)\n"
    )
    source = parse_program(text, "p.py")
    decided = build_program_settings(source).decided
    why = (
        "its source describes an impossible robot (wheel_spacing_mm: must be a number from 1 to 1000, "
        "got 12000.0)"
    )
    assert decided.note.startswith(
        f"p.py runs as on a brick (profile ev3); {why}: it gets the default robot. "
    )
    assert "robot" not in decided.layer
    with pytest.raises(RobotError, match="got 12000"):
        choose_robot(source, "it")


def test_an_impossible_robot_of_a_hub_keeps_the_hub_and_gets_a_note() -> None:
    text = (
        "from pybricks.hubs import PrimeHub\nfrom pybricks.parameters import Port\n"
        "from pybricks.pupdevices import ColorSensor, Motor\n"
        "arm = Motor(Port.C)\neye = ColorSensor(Port.C)\n"
    )
    decided = build_program_settings(parse_program(text, "p.py")).decided
    assert decided.layer["robot"].spec.hub == "PrimeHub"
    assert decided.note.startswith(
        "p.py runs on a robot built from it: PrimeHub; the rest of it is impossible (middle.port: two parts are on C); "
    )
