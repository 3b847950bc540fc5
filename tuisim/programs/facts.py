"""What the text of a program says, read once: how it is made, what it calls, asks, waits for and compares."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from functools import cached_property, lru_cache

from tuisim.base.source import Program
from tuisim.base.syntax_tree import parse_module
from tuisim.engine.core.sensors.color import LightRead
from tuisim.engine.core.spec import RobotSpec
from tuisim.programs.calls import list_calls
from tuisim.programs.mistakes import find_fault
from tuisim.programs.questions import Question, QuestionReader, Word
from tuisim.programs.robot.source import parse
from tuisim.programs.robot.thresholds import ProgramThreshold, find_light_reads, find_thresholds
from tuisim.programs.slips import find_idle_definition, list_slips
from tuisim.programs.structure import STRUCTURES
from tuisim.programs.waits import (
    LoopEnd,
    find_first_drive,
    find_turns,
    list_constants,
    list_counts,
    list_loop_ends,
)
from tuisim.programs.wheel_turns import WheelTurn, list_wheel_turns

__all__ = [
    "STRUCTURES",
    "LoopEnd",
    "ProgramFacts",
    "ProgramThreshold",
    "Question",
    "WheelTurn",
    "read_facts",
]

MAX_TEXT = 100_000
"""Characters of the longest text that is read for what it waits for; it takes time for each line."""


class ProgramFacts:
    """What the text of a program says; nothing is executed.

    Args:
        program: The program.
    """

    def __init__(self, program: Program) -> None:
        self._program = program

    @cached_property
    def _tree(self) -> ast.Module:
        """The syntax tree of the program; raises what `parse_module` does."""
        return parse_module(self._program.text)

    @cached_property
    def _short_tree(self) -> ast.Module:
        """The syntax tree of the program, without statements if it is not Python, or too long."""
        text = self._program.text
        return (parse(text) if len(text) <= MAX_TEXT else None) or ast.Module([], [])

    @cached_property
    def fault(self) -> tuple[str, int] | None:
        """Why the program does not compile, and the line, 0 if there is none; None if it compiles."""
        return find_fault(self._program.text)

    def count_structure(self, name: str) -> int:
        """Return how many loops, functions and so on the program has.

        Args:
            name: What to count, one of `STRUCTURES`.

        Raises:
            SyntaxError, ValueError, RecursionError: it is not Python.
        """
        return STRUCTURES[name](self._tree)

    def find_calls(self, call: str) -> list[int]:
        """Return the lines with a call, in ascending order.

        Args:
            call: A name such as `time.sleep`, a method of an object that the prelude defines such as `tank_drive.on`,
                or the name of a function or method alone. An object of the same class counts as well.

        Raises:
            SyntaxError, ValueError, RecursionError: it is not Python.
        """
        return list_calls(self._tree, self._program.prelude, call)

    @cached_property
    def _question_reader(self) -> QuestionReader:
        return QuestionReader(self._short_tree)

    def find_question(self, line: int) -> Question:
        """Return what the program does with what a line reads; `Question()` if its text does not tell."""
        return self._question_reader.find_question(line)

    @cached_property
    def _constants(self) -> Mapping[str, Word]:
        return list_constants(self._short_tree)

    @cached_property
    def loop_ends(self) -> tuple[LoopEnd, ...]:
        """The loops that end by a comparison which the text shows, the inner ones first."""
        return list_loop_ends(self._short_tree, self._constants)

    @cached_property
    def counts(self) -> tuple[tuple[int, LoopEnd], ...]:
        """The lines in loops that count each time that a comparison with a constant is true, with the comparison."""
        return tuple(list_counts(self._short_tree, self._constants))

    def find_turns(self, line: int) -> tuple[float, str] | None:
        """Return by how much a call on a line turns a motor or both wheels, and the unit; None if there is none."""
        return find_turns(self._short_tree, self._constants, line)

    @cached_property
    def wheel_turns(self) -> tuple[WheelTurn, ...]:
        """The calls that turn both wheels against each other by an angle that could be meant for the robot."""
        return tuple(list_wheel_turns(self._short_tree))

    @cached_property
    def first_drive(self) -> int:
        """The first line that starts motors; 0 for none."""
        return find_first_drive(self._short_tree)

    @cached_property
    def slips(self) -> tuple[tuple[int, str], ...]:
        """The lines that do nothing, or always the same, and why, in words."""
        return tuple(list_slips(self._short_tree))

    @cached_property
    def idle_definition(self) -> tuple[int, str] | None:
        """The last function or class of a program that only defines, and why nothing happens; otherwise None."""
        return find_idle_definition(self._short_tree)

    def find_light_reads(self, robot: RobotSpec) -> Mapping[str, LightRead]:
        """Return which number of each colour sensor the program reads first, by name of the sensor."""
        return find_light_reads(self._program, robot)

    def find_thresholds(self, robot: RobotSpec) -> Mapping[str, tuple[ProgramThreshold, ...]]:
        """Return what the program compares its colour sensors with, in order of its lines, by name of the sensor."""
        return find_thresholds(self._program, robot)


@lru_cache(8)
def read_facts(program: Program) -> ProgramFacts:
    """Return the facts that the text of a program shows."""
    return ProgramFacts(program)
