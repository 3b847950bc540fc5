"""Goals files: the goals of a task in TOML, together with the world, and perhaps the program, that they are for."""

from __future__ import annotations

import os
import re
import tomllib
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest, see_page
from tuisim.base.folders import programs_folder, user_path
from tuisim.engine import files
from tuisim.engine.core.conditions import ValueCondition
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RunSpec, WorldSpec
from tuisim.engine.core.values import quote
from tuisim.engine.files import Location
from tuisim.settings.options import has_world_values
from tuisim.settings.robots import DEFAULT_ROBOT, RobotChoice
from tuisim.settings.worlds import WorldFile, is_world_name, parse_world
from tuisim.tasks.goals.brick import resolve_column
from tuisim.tasks.goals.comparisons import CountCondition, KeepCondition, WhenCondition
from tuisim.tasks.goals.condition import WINDOWED, Condition, ConditionKind, Points, Seconds
from tuisim.tasks.goals.picture import PictureTable, draw_from_table
from tuisim.tasks.goals.spec import (
    CONDITIONS,
    MAX_GOALS,
    Combination,
    DrawCondition,
    Goal,
    Together,
    UseCondition,
)
from tuisim.tasks.goals.trial_world import TrialWorld, check_names, parse_other_worlds

MAX_NAME = 60
_EXAMPLE = "_goals.toml"
"""The end of the file names of examples."""
_VALUES: Mapping[str, Any] = {
    "name": str,
    "say": str,
    "hint": str,
    "points": Points,
    "hidden": bool,
    "within_s": Seconds,
}
"""The keys of a goal besides its condition and limits, with the types of their values."""
_LIMITS = ("before", "after", "until")


@dataclass(frozen=True, slots=True)
class GoalsFile:
    """The contents of a goals file: a task with its goals, settings and worlds."""

    path: Path
    title: str
    """The task, in a line; empty if the file does not say."""
    goals: tuple[Goal, ...]
    settings: Mapping[str, Any]
    """Settings of the world, by path; in precedence as those of a world file."""
    program: str | None = None
    """The program that the file names, if any: a path, or the name of an example."""
    others: tuple[TrialWorld, ...] = ()
    """Other worlds in which programs are tried, too."""
    inputs: tuple[str, ...] = ()
    """The answers to `input()`, if the goals have no dialogue."""

    @property
    def presses(self) -> Mapping[str, Any]:
        """The setting `press` of the file, which applies in every world, as a mapping with this one key.

        The result is empty if the file does not have the setting.
        """
        return {path: value for path, value in self.settings.items() if path == "press"}

    @property
    def answers(self) -> tuple[str, ...]:
        """The answers to `input()` in the first world."""
        return self.worlds[0].answers

    @property
    def worlds(self) -> tuple[TrialWorld, ...]:
        """All worlds in which programs are tried, the file's own first, each with all settings, goals and inputs."""
        names = tuple(goal.name for goal in self.goals)
        own = TrialWorld("", self.settings, names, self.goals, self.inputs)
        return (own, *(other.beside(own) for other in self.others))

    @property
    def every_goal(self) -> tuple[Goal, ...]:
        """The goals of all worlds, each name once: those of the first world, then those that only other worlds have."""
        goals_by_name = {
            goal.name: replace(goal, hidden=goal.hidden or world.hidden)
            for world in reversed(self.worlds)
            for goal in world.own_goals
        }
        names = dict.fromkeys(goal.name for world in self.worlds for goal in world.own_goals)
        return tuple(goals_by_name[name] for name in names)

    @staticmethod
    def load(path: Path | str) -> GoalsFile:
        """Read a goals file, with the world file and the pictures that it names.

        Args:
            path: The file, or one of `list_example_names`.

        Raises:
            ConfigError: a file cannot be read or is wrong; the error names file, line and key.
        """
        task = load_task(path)[1]
        if task is None:
            hint = f"begin each with a line [[goal]]; {see_page('goal-files')}"
            raise ConfigError(
                "there are no goals", hint, file=f"{user_path(path)}, line 1", key="goal"
            )
        return task


def load_task(path: Path | str, mats: str | None = None) -> tuple[WorldFile, GoalsFile | None]:
    """Read a world file; return its world, and its goals as a `GoalsFile`, or None in place of this if it has no goals.

    Args:
        path: The file, or one of `list_example_names`.
        mats: A further folder in which to search for the mat if the file does not name a folder of mats; None to search
            in no further folder.

    Raises:
        ConfigError: a file cannot be read or is wrong; the error names file, line and key.
    """
    path = _find_file(user_path(path))
    if not is_world_name(path.name):
        what = "is not a .toml file" if os.path.exists(path) else "no such file"
        hint = f"a file of a world or of goals is named NAME.toml; {see_page('goal-files')}"
        raise ConfigError(what, hint, file=str(path))
    data = files.read_file(path, ConfigError)
    with add_line_to_errors(path):
        world = parse_world(data, path, mats)
        return world, _build_goals_file(data, path, world)


@contextmanager
def add_line_to_errors(path: Path, text: str | None = None) -> Iterator[None]:
    """In a `with` block, add the number of the line to each ConfigError that names this file and a key.

    Args:
        path: The file, as errors name it.
        text: The TOML in the file; None reads the file.
    """
    try:
        yield
    except ConfigError as error:
        if error.file != str(path) or not error.key:
            raise
        line = find_key_line(
            path.read_text("utf-8-sig", "replace") if text is None else text, error.key
        )
        raise files.with_location(error, f"{path}, line {line}", error.key) from None


def list_example_names() -> list[str]:
    """Return the names of the example tasks: `log_greys` for the file `log_greys_goals.toml`.

    Raises:
        ConfigError: there is no folder of programs.
    """
    return [path.name.removesuffix(_EXAMPLE) for path in list_examples()]


def list_examples() -> list[Path]:
    """Return the paths of the example goals files, sorted by name.

    Raises:
        ConfigError: there is no folder of programs.
    """
    return sorted(programs_folder().glob(f"*{_EXAMPLE}"))


def _find_file(path: Path) -> Path:
    """Return the path of the example goals file with a name such as `log_greys`.

    A path that names an existing file, or that is not the name of an example, is returned unchanged.
    """
    if path.parent != Path() or os.path.exists(path):
        return path
    name = path.name.removesuffix(_EXAMPLE)
    return programs_folder() / f"{name}{_EXAMPLE}" if name in list_example_names() else path


def _build_goals_file(data: Any, path: Path, world: WorldFile) -> GoalsFile | None:
    """Return the task in a goals file, with its goals and those of the world file that it is based on.

    The result is None if neither file has goals.

    Args:
        data: The parsed contents of the goals file.
        path: The goals file.
        world: Its world.
    """
    location = Location(str(path))
    base = load_task(path.parent / user_path(data["world"]))[1] if "world" in data else None
    if base is None and "goal" not in data:
        return None
    inherited = base.goals if base else ()
    own = (
        parse_goals(data["goal"], location.at("goal"), path.parent, inherited)
        if "goal" in data
        else ()
    )
    names = {goal.name for goal in own}
    goals = (*(goal for goal in inherited if goal.name not in names), *own)
    if "title" in data:
        title = files.convert(data["title"], str, location.at("title"))
    elif base:
        title = base.title
    else:
        title = ""
    others = _parse_others(data["also"], goals, location.at("also"), path) if "also" in data else ()
    known = base.others if base else ()
    task = GoalsFile(
        path,
        title,
        goals,
        world.settings,
        world.program,
        (*known, *others),
        world.inputs,
    )
    # Without a world, each program chooses its robot, whose columns are not known here.
    if has_world_values(world.settings):
        runs = build_runs(task.worlds)
        check_columns(own, runs, location.at("goal"))
        for number, other in enumerate(others, start=1):
            check_columns(other.own_goals, runs, location.at(f"also[{number}].goal"))
    return task


def _parse_others(
    data: object, goals: tuple[Goal, ...], location: Location, path: Path
) -> tuple[TrialWorld, ...]:
    names = tuple(goal.name for goal in goals)
    others = parse_other_worlds(
        data, names, location, path, partial(parse_goals, beside=goals), of_task=True
    )
    for number, other in enumerate(others, start=1):
        check_names(
            other.goals,
            {*names, *(goal.name for goal in other.own_goals)},
            location.at(f"[{number}]"),
        )
    return others


def parse_goals(
    data: object, location: Location, folder: Path, beside: Sequence[Goal] = ()
) -> tuple[Goal, ...]:
    """Return the goals in a list of tables; names of files in them are relative to `folder`.

    Args:
        data: The list.
        location: Its place, for errors.
        folder: The folder of the goals file.
        beside: Goals of the first world, to which the goals in the list may refer. A goal in the list replaces the one
            of the same name.

    Raises:
        ConfigError: a goal is wrong; the error names its key.
    """
    listed = files.entries(data, location, MAX_GOALS, "goals")
    goals = tuple(_parse_goal(entry, place, folder) for entry, place in listed)
    own = {goal.name for goal in goals}
    inherited = [goal for goal in beside if goal.name not in own]
    _check_names(
        (*goals, *inherited), [*(place for _, place in listed), *[location] * len(inherited)]
    )
    return goals


def _parse_goal(data: object, location: Location, folder: Path) -> Goal:
    table = files.table(data, location, (*_VALUES, *CONDITIONS, *_LIMITS))
    values: dict[str, Any] = {
        key: files.convert(table[key], kind, location.at(key))
        for key, kind in _VALUES.items()
        if key in table
    }
    files.required(table, "name", location)
    if len(values["name"]) > MAX_NAME:
        raise location.at("name").wrong(
            f"is too long, {len(values['name'])} characters", f"at most {MAX_NAME}"
        )
    conditions = tuple(
        _parse_condition(kind, table[key], location.at(key), folder)
        for key, kind in CONDITIONS.items()
        if key in table
    )
    if not conditions:
        raise location.wrong(
            "has no condition", f"one of {', '.join(CONDITIONS)}; {see_page('goal-files')}"
        )
    condition = conditions[0] if len(conditions) == 1 else Together(conditions)
    values |= {
        limit: _parse_limit(table[limit], location.at(limit)) for limit in _LIMITS if limit in table
    }
    goal = Goal(condition=condition, **values)
    _check_limits(goal, location)
    return goal


def _parse_condition(
    kind: type[Condition], data: object, location: Location, folder: Path
) -> Condition:
    if data is False:
        raise location.wrong("cannot be false", "leave it out")
    if data is True:
        data = {}
    elif not isinstance(data, dict) and kind.SHORT:
        data = {kind.SHORT: data}
    if isinstance(data, dict) and isinstance(data.get(kind.SHORT), str):
        # A single text may stand without a list: `lines = "done"` means `["done"]`.
        data = {**data, kind.SHORT: [data[kind.SHORT]]}
    _check_lists(kind, data, location)
    if kind is UseCondition and isinstance(data, dict) and "reading" in data:
        raise location.at("reading").wrong(
            "what decides a call is not judged", "use [[also]]: a world with other right answers"
        )
    if kind is DrawCondition:
        table = files.convert(data, PictureTable, location)
        try:
            return draw_from_table(table, folder)
        except ConfigError as error:
            raise location.at("image").wrong(f"{error}") from None
    return files.convert(data, kind, location)


def _check_lists(kind: type[Condition], data: object, location: Location) -> None:
    """Check that a condition has lists as values of the keys that need a list, of texts or of ranges.

    Args:
        kind: The class of the condition.
        data: The condition's table in the goals file.
        location: The location of the table, for errors.

    Raises:
        ConfigError: a value is not such a list; the error says what it must be.
    """
    for key, value in data.items() if isinstance(data, dict) else ():
        field = kind.__dataclass_fields__.get(key)
        if field is None:
            continue
        if key == kind.SHORT and field.type == "tuple[str, ...]" and not isinstance(value, list):
            raise location.at(key).wrong(f"must be text, or a list of texts, got {quote(value)}")
        if field.type == "tuple[Range, ...]" and not (
            isinstance(value, list) and all(map(_is_list, value))
        ):
            raise location.at(key).wrong(
                f"must be [[from, to]], or one such pair for each, got {quote(value)}"
            )


def _is_list(value: object) -> bool:
    return isinstance(value, list)


def _parse_limit(data: object, location: Location) -> str | float:
    if isinstance(data, str):
        return files.convert(data, str, location)
    if isinstance(data, bool) or not isinstance(data, int | float):
        raise location.wrong(f"must be the name of a goal, or a time in seconds, got {quote(data)}")
    return files.convert(data, Seconds, location)


_UNFIT = {
    ConditionKind.REACHED: "a run meets the condition once: use before",
    ConditionKind.HELD: "the condition must hold all the time: use until",
    ConditionKind.FIXED: "the condition is known before the run",
    ConditionKind.COMBINED: "give it to the goals that are combined",
}


def _check_limits(goal: Goal, location: Location) -> None:
    """Check the limits of a goal, such as `before` and `within_s`.

    Raises:
        ConfigError: a limit does not fit any condition of the goal, or a limit is a time before or equal to `after`.
    """
    kinds = [part.KIND for part in goal.parts]
    fitting = {limit for kind in kinds for limit in goal.limits(kind)}
    if goal.within_s is not None and not set(kinds) & set(WINDOWED):
        raise location.at("within_s").wrong("does not fit this condition", _UNFIT[kinds[0]])
    for limit in _LIMITS:
        if getattr(goal, limit) is not None and limit not in fitting:
            raise location.at(limit).wrong("does not fit this condition", _UNFIT[kinds[0]])
        end = getattr(goal, limit)
        if (
            limit != "after"
            and isinstance(end, float)
            and isinstance(goal.after, float)
            and goal.after >= end
        ):
            raise location.at("after").wrong(
                f"must be less than {limit}, {end:g}, got {goal.after:g}"
            )


def _check_names(goals: Sequence[Goal], places: Sequence[Location]) -> None:
    """Check that goals have different names, and that the names by which they refer to other goals exist.

    Raises:
        ConfigError: a name is used twice or is missing, or a goal refers to itself, directly or through other goals.
    """
    by_name: dict[str, Goal] = {}
    for goal, location in zip(goals, places, strict=True):
        if goal.name in by_name:
            raise location.at("name").wrong(
                f"there are two goals {goal.name!r}", "give each its own name"
            )
        by_name[goal.name] = goal
    for goal, location in zip(goals, places, strict=True):
        for name in goal.needs:
            if name not in by_name:
                raise _find_reference(goal, name, location).wrong(
                    f"there is no goal {name!r}", nearest(name, by_name)
                )
    try:
        TopologicalSorter({goal.name: goal.needs for goal in goals}).prepare()
    except CycleError as error:
        # The first and the last name of a circle are the same, and each goal is needed by the next one.
        circle = error.args[1][:0:-1]
        first = min(range(len(circle)), key=lambda index: [*by_name].index(circle[index]))
        circle = [*circle[first:], *circle[: first + 1]]
        words = " needs ".join(f"{name!r}" for name in circle)
        location = places[[*by_name].index(circle[0])]
        raise _find_reference(by_name[circle[0]], circle[1], location).wrong(
            f"the goals need each other: {words}"
        ) from None


def _find_reference(goal: Goal, name: str, location: Location) -> Location:
    """Return the location of the key in which a goal names another goal; if no key does, the location of the goal.

    Args:
        goal: The goal.
        name: The name of the other goal.
        location: The location of the goal.
    """
    limits = (limit for limit in _LIMITS if getattr(goal, limit) == name)
    combined = (
        key
        for key, kind in CONDITIONS.items()
        for part in goal.parts
        if type(part) is kind and isinstance(part, Combination) and name in part.goals
    )
    key = next(limits, next(combined, ""))
    return location.at(key) if key else location


_STATEMENT = re.compile(r"[ \t]*(?:[\w\"'-].*=|\[.*\][ \t]*(?:#.*)?$)")
"""Matches every line that begins a TOML statement, and some other lines."""
_STEP = re.compile(r"\[(\d+)\]|([^.\[\]]+)")


def find_key_line(text: str, key: str) -> int:
    """Return the line, from 1, at which the value of a key begins in a valid TOML text.

    If there is no such key, the line of the innermost table that should contain it is returned; 1 if that is missing,
    too.

    Args:
        text: The TOML.
        key: The key's path, such as `goal[2].reach.x_mm`, where entries count from 1.
    """
    lines = text.split("\n")
    path = [int(step[1]) - 1 if step[1] else step[2] for step in _STEP.finditer(key)]
    while path and not _has(_parse_lines(lines), path):
        path.pop()

    # The text is cut only where statements begin, so that a long value is not parsed once for each of its lines.
    starts = [index for index, line in enumerate(lines) if _STATEMENT.match(line)]
    ends = [*starts, len(lines)]

    def begun(count: int) -> bool:
        """Return whether the key is in the first `count` statements of the TOML.

        If the text ends in the middle of a value after these statements, as much is added as is needed to complete it.
        """
        while (parsed := _parse_lines(lines[: ends[count]])) is None:
            count += 1
        return _has(parsed, path)

    statements = bisect_left(range(len(ends)), True, key=begun)
    return starts[statements - 1] + 1 if statements else 1


def _parse_lines(lines: list[str]) -> Any:
    try:
        return tomllib.loads("\n".join(lines))
    except (ValueError, RecursionError):
        return None


def _has(data: Any, path: list[int | str]) -> bool:
    try:
        for step in path:
            data = data[step]
    except (KeyError, IndexError, TypeError):
        return False
    return True


def build_runs(worlds: Sequence[TrialWorld]) -> list[RunSpec]:
    """Return a run specification for each world, with the world's robot and the profile that has the most columns."""
    robots = [RobotChoice.load(world.settings.get("robot", DEFAULT_ROBOT)) for world in worlds]
    # A run may have another profile; this one has the most columns.
    return [RunSpec(robot.spec, WorldSpec(), PROFILES["ev3"]) for robot in robots]


def check_columns(goals: Sequence[Goal], runs: Sequence[RunSpec], location: Location) -> None:
    """Check that every column that a goal names is in at least one of the runs.

    Args:
        location: The location of the list of goals; errors add the goal's number to it.

    Raises:
        ConfigError: a goal names a column that none of the runs has.
    """
    for number, goal in enumerate(goals, start=1):
        for part in goal.parts:
            for comparison in _list_conditions(part):
                key = next(key for key, kind in CONDITIONS.items() if type(part) is kind)
                _check(comparison, runs, location.at(f"[{number}]").at(key))


def _list_conditions(part: Condition) -> tuple[ValueCondition, ...]:
    match part:
        case WhenCondition() | KeepCondition():
            return part.conditions
        case CountCondition():
            return (part.condition,)
    return ()


def _check(comparison: ValueCondition, runs: Sequence[RunSpec], location: Location) -> None:
    failure: ConfigError | None = None
    for run in runs:
        try:
            resolve_column(comparison, run)
            return
        except ConfigError as error:
            failure = error
    if failure:
        raise location.wrong(f"the robot has no column {comparison.name!r}", failure.hint)
