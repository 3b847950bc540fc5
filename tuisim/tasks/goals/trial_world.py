"""The worlds of a task, or of a step in a lesson: other ones are tables with keys of a world, `where`, and goals."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine import files
from tuisim.engine.files import Location
from tuisim.settings.worlds import parse_world
from tuisim.tasks.goals.spec import DialogueCondition, Goal

_OWN_KEYS = ("where", "goals", "goal")
_WORLD_KEYS = (
    "background",
    "mats",
    "start",
    "robot",
    "noise",
    "drift",
    "obstacles",
    "obstacle",
    "press",
    "inputs",
)
_HIDDEN = "hidden"

MAX_LESSON_WORLDS, MAX_TASK_WORLDS = 3, 20

GoalReader = Callable[[object, Location, Path], tuple[Goal, ...]]
"""Reads a list of goals; the files that they name are in a folder."""


@dataclass(frozen=True, slots=True)
class TrialWorld:
    """A world in which a student's program is tried; several worlds expose a program that fits only one of them."""

    where: str
    """How it differs from the first one, for the student, such as `from 10 cm farther back`; empty for the first."""
    settings: Mapping[str, Any]
    """Settings by path; of another world only those that differ."""
    goals: tuple[str, ...]
    """Names of the goals to be met in this world."""
    own_goals: tuple[Goal, ...] = ()
    """The goals that only this world has."""
    inputs: tuple[str, ...] = ()
    """The answers to `input()` in this world, if its goals have no dialogue."""
    hidden: bool = False
    """Whether the world, and what happens in it, are hidden from students."""

    @property
    def answers(self) -> tuple[str, ...]:
        """The answers that `input()` returns: those of the dialogues in `own_goals`, in order, else `inputs`."""
        dialogues = (
            part
            for goal in self.own_goals
            for part in goal.parts
            if isinstance(part, DialogueCondition)
        )
        return (
            tuple(turn.answer for dialogue in dialogues for turn in dialogue.turns) or self.inputs
        )

    def select_goals(self, goals: Sequence[Goal]) -> tuple[Goal, ...]:
        """Return the goals of this world: `own_goals`, and goals of the first world with other names.

        Args:
            goals: The goals of the first world.
        """
        own = {goal.name: goal for goal in self.own_goals}
        return (*(own.pop(goal.name, goal) for goal in goals), *own.values())

    def beside(self, first: TrialWorld) -> TrialWorld:
        """Return a copy of this world in which missing settings, goals and inputs are those of the first world."""
        return replace(
            self,
            settings={**first.settings, **self.settings},
            own_goals=self.select_goals(first.own_goals),
            inputs=self.inputs or first.inputs,
        )


def parse_other_worlds(
    data: object,
    goals: tuple[str, ...],
    location: Location,
    path: Path,
    read_goals: GoalReader,
    *,
    of_task: bool = False,
) -> tuple[TrialWorld, ...]:
    """Return the worlds in a list of tables, in which programs are tried after the first world.

    Args:
        data: The list of tables.
        goals: Names of the goals that count in a world whose table names none. In a lesson, they count only if the
            table does not define goals either.
        location: Where the list is in the file, for errors.
        path: The file; names of files in a world are relative to it.
        read_goals: Reads the goals of a table.
        of_task: Whether the worlds belong to a task and may be hidden; otherwise they belong to a lesson.

    Raises:
        ConfigError: a table is wrong; the error names its key.
    """
    others: list[TrialWorld] = []
    for entry, place in files.entries(
        data, location, MAX_TASK_WORLDS if of_task else MAX_LESSON_WORLDS, "other worlds"
    ):
        table = files.table(
            entry, place, (*_OWN_KEYS, *((_HIDDEN,) if of_task else ()), *_WORLD_KEYS)
        )
        where = files.convert(files.required(table, "where", place), str, place.at("where"))
        if any(where == other.where for other in others):
            raise place.at("where").wrong(
                f"there are two {where!r}", "say what is different in each"
            )
        own = read_goals(table["goal"], place.at("goal"), path.parent) if "goal" in table else ()
        own_names = tuple(goal.name for goal in own)
        named = files.convert(table.get("goals", []), tuple[str, ...], place.at("goals"))
        usual = goals if of_task or not own else ()
        goal_names = tuple(dict.fromkeys((*(named or usual), *own_names)))
        try:
            world = parse_world(
                {key: table[key] for key in _WORLD_KEYS if key in table}, path, changes=True
            )
        except ConfigError as error:
            # An error in this file lacks the place of the table; one in another file is complete.
            if error.file != place.file:
                raise
            raise files.with_location(error, place.file, f"{place.key}.{error.key}") from None
        if not (world.settings or world.inputs):
            raise place.wrong("is the same world", f"one of {', '.join(_WORLD_KEYS)}")
        is_hidden = files.convert(table.get(_HIDDEN, False), bool, place.at(_HIDDEN))
        others.append(TrialWorld(where, world.settings, goal_names, own, world.inputs, is_hidden))
    return tuple(others)


def check_names(names: Sequence[str], known: Collection[str], location: Location) -> None:
    """Check that the names in the key `goals` of a world's table are names of goals.

    Raises:
        ConfigError: a name is not among the known ones.
    """
    for number, name in enumerate(names, start=1):
        if name not in known:
            raise location.at(f"goals[{number}]").wrong(
                f"there is no goal {name!r}", f"one of {', '.join(sorted(known))}"
            )
