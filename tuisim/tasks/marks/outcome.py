"""The outcome of one run of a student's program, without anything that differs from machine to machine.

Its texts have no paths, addresses and control characters.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import printable, shortened
from tuisim.base.faults import UNJUDGED
from tuisim.base.source import source_lines, user_python_path
from tuisim.engine.protocol import End
from tuisim.tasks.goals.judge import UNCOMPILED
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import AllOf
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.task import Result

_ADDRESS = re.compile(r"\b0x[0-9a-fA-F]{6,}\b")
MAX_CHARACTERS = 300
"""Longest reason; the rest is cut off."""
_ERROR_HEAD, _ERROR_TAIL = 1000, 3000
"""Characters of a long traceback that are kept, at its beginning and its end."""
_GIVEN_UP = frozenset(
    {
        End.STALLED,
        End.OUTPUT_LIMIT,
        End.CRASHED,
        End.KILLED,
        End.FALSIFIED,
        End.STOPPED,
        End.DISK_FULL,
    }
)
"""Ends after which further seeds are not run, as each would take as long."""


@dataclass(frozen=True, slots=True)
class GoalOutcome:
    """Whether one run of a student's program met one goal."""

    name: str
    met: bool
    reason: str = ""
    """Why it was missed; empty if it was met."""
    line: int = 0
    """The program's line that the reason is about; 0 if there is none."""
    hidden: bool = False
    """Whether it was missed only in hidden worlds, of which no student is told anything."""
    is_penalty: bool = False
    """Whether it takes points off."""
    is_unknown: bool = False
    """Whether it could not be judged, so that nobody knows whether it was met."""
    event: Change | None = None
    """When and where it was decided; None if the program's text alone decides it, or the recording is falsified."""

    @property
    def is_good(self) -> bool:
        """Whether the goal was met or, if it takes points off, not met; False if that is unknown."""
        return self.met is not self.is_penalty and not self.is_unknown


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of one run of a student's program, or of all worlds of the task with one seed: see `merge_worlds`."""

    seed: int
    end: str
    """A value of `End`; empty if this machine could not start the program."""
    failure: str = ""
    """Why the program did not finish, one line; empty if it finished."""
    line: int = 0
    """The main program's line at which it failed; 0 if there is none."""
    error: str = ""
    """The program's traceback."""
    time_s: float = 0.0
    goals: tuple[GoalOutcome, ...] = ()
    """In the order of the goals."""
    run_id: str = ""
    """Its id in the store; empty if it was not kept."""
    world: str = ""
    """In which of the other worlds it was, see `TrialWorld.where`; empty for the first."""
    hidden: bool = False
    """Whether that world is hidden; of merged ones whether it failed only in such a world."""

    @property
    def counts(self) -> bool:
        """Whether the run counts: False if this machine could not start the program or store its recording."""
        return bool(self.end) and self.end != End.DISK_FULL

    @property
    def is_in_doubt(self) -> bool:
        """Whether the run could not be judged for a reason that the program may have caused to avoid a result."""
        return self.end == End.DISK_FULL or (not self.end and self.failure.startswith(UNJUDGED))

    @property
    def gave_up(self) -> bool:
        """Whether further runs would only cost time: the program met no goal, and hung, printed without end, or died.

        A program that cannot be compiled gave up, too. A program that met a goal with points did not: its other runs
        show whether it meets the goal again.
        """
        if any(goal.reason.startswith(UNCOMPILED) for goal in self.goals):
            return True
        return self.end in _GIVEN_UP and not any(
            goal.met and not goal.is_penalty for goal in self.goals
        )


def build_outcome(result: Result, seed: int, folder: Path, world: TrialWorld) -> Outcome:
    """Return the outcome of a run from the result of its task.

    Args:
        result: The result of the task.
        seed: The seed of the task.
        folder: The folder in which the program ran; its path does not appear in the outcome.
        world: The world of the run, in which only some goals may count.
    """
    failure = (
        "" if result.end == End.FINISHED and not result.exit_code else _describe_failure(result)
    )
    judgements = {judgement.goal.name: judgement for judgement in result.judgements}
    goals = []
    for name, judgement in judgements.items():
        if name not in world.goals:
            continue
        state = judgement.state
        met = state is GoalState.MET
        cause = _find_cause(judgement, judgements)
        is_unplaced = result.end == End.FALSIFIED or judgement.is_of_text
        goals.append(
            GoalOutcome(
                name,
                met,
                "" if met else _join_lines(make_portable(cause.reason, folder)),
                0 if met else cause.line,
                is_penalty=judgement.goal.points < 0,
                is_unknown=state is GoalState.UNKNOWN,
                event=None if is_unplaced else judgement.event,
            )
        )
    return Outcome(
        seed,
        result.end,
        _join_lines(make_portable(failure, folder)),
        result.error_line,
        _cut_middle("\n".join(map(printable, source_lines(make_portable(result.error, folder))))),
        result.time_s,
        tuple(goals),
        result.run_id,
        world.where,
        world.hidden,
    )


def merge_worlds(
    outcomes: Sequence[Outcome], seeds: Sequence[int], worlds: Sequence[str] = ("",)
) -> list[Outcome]:
    """Return for each seed one outcome of all worlds: a goal is met if it is met in every world where it counts.

    A goal that takes points off is met if it is met in any world. A seed is left out if one of its runs is missing or
    does not count; all seeds are left out if an outcome is in doubt. If the program gave up with the first seed in a
    world, that outcome is also used for the other seeds in this world.

    Args:
        outcomes: The outcomes of one student, in any order.
        seeds: The seeds of the marking.
        worlds: The names of the worlds, the first one first.
    """
    if any(outcome.is_in_doubt for outcome in outcomes):
        return []
    known = {(outcome.world, outcome.seed): outcome for outcome in outcomes}
    gave_up = {
        outcome.world: outcome
        for outcome in outcomes
        if outcome.gave_up and outcome.seed == seeds[0]
    }
    seed_outcomes = []
    for seed in seeds:
        first = known.get((worlds[0], seed))
        # A program that gave up in the first world was not run in the others.
        own = worlds[:1] if worlds[0] in gave_up else worlds
        parts = [first, *(known.get((world, seed), gave_up.get(world)) for world in own[1:])]
        complete = [outcome for outcome in parts if outcome is not None and outcome.counts]
        if len(complete) == len(parts):
            seed_outcomes.append(_merge(seed, complete))
    return seed_outcomes


def _merge(seed: int, parts: Sequence[Outcome]) -> Outcome:
    """Return one outcome of the runs with a seed in all worlds.

    Args:
        seed: The seed.
        parts: The outcomes in each world, the first world's first.
    """
    # Outcomes in visible worlds come first, so that their reasons are shown to the student.
    parts = sorted(parts, key=lambda part: part.hidden)
    goals: dict[str, GoalOutcome] = {}
    # A run without a recording has no outcomes of goals, so it is not known which goals are met in all worlds.
    is_known = all(part.goals for part in parts)
    for part in parts:
        for goal in part.goals if is_known else ():
            if _is_weightier(goal, goals.get(goal.name)):
                reason = (
                    f"{part.world}: {goal.reason}" if part.world and goal.reason else goal.reason
                )
                goals[goal.name] = replace(
                    goal, reason=reason, hidden=part.hidden and not goal.is_good
                )
    failed = next((part for part in parts if part.failure), None)
    if failed is None or not failed.world:
        return replace(failed or parts[0], seed=seed, goals=tuple(goals.values()))
    return replace(
        failed, seed=seed, goals=tuple(goals.values()), failure=f"{failed.world}: {failed.failure}"
    )


def _is_weightier(goal: GoalOutcome, before: GoalOutcome | None) -> bool:
    """Return whether a goal's outcome in one world replaces the merged outcome of earlier worlds, as it is worse.

    A good outcome is always replaced. An unknown outcome is replaced only by a miss. A miss is never replaced.

    Args:
        goal: The outcome in this world.
        before: The merged outcome of earlier worlds; None if this is the first world.
    """
    if before is None or before.is_good:
        return True
    return before.is_unknown and not (goal.is_good or goal.is_unknown)


def find_unknown_goals(outcomes: Iterable[Outcome]) -> dict[str, str]:
    """Return the names of the goals that could not be judged in some runs, each with the reason."""
    return {
        goal.name: goal.reason for outcome in outcomes for goal in outcome.goals if goal.is_unknown
    }


def make_portable(text: str, folder: Path | str) -> str:
    """Return a text without addresses in memory, and without the parts of paths that depend on this machine.

    Paths in the program's folder, in folders of modules and in Python's folders become relative to these.
    """
    if "/" in text:
        modules = {
            *map(os.path.abspath, (*sys.path, *user_python_path())),
            sys.prefix,
            sys.base_prefix,
        } - {"/"}
        # Inner folders come first, as the first alternative that matches is taken.
        places = "|".join(map(re.escape, (str(folder), *sorted(modules, reverse=True))))
        text = re.sub(rf"(?<![\w/.~-])(?:{places})/", "", text)
    return _ADDRESS.sub("0x…", text)


def _find_cause(judgement: Judgement, judgements: Mapping[str, Judgement]) -> Judgement:
    """Return the judgement whose reason explains a missed goal.

    This is the goal's own judgement or, for a goal with `all`, the judgement of the first goal in `all` that is not
    met.
    """
    if isinstance(judgement.goal.condition, AllOf):
        for name in judgement.goal.condition.goals:
            if judgements[name].state is not GoalState.MET:
                return _find_cause(judgements[name], judgements)
    return judgement


def _describe_failure(result: Result) -> str:
    """Return why a program did not finish, as text."""
    if result.end == End.STOPPED:
        return "stopped, because it took too long"
    if result.end == End.STALLED:
        # The run's own summary is not used: it depends on whether the program's process or its parent noticed it first.
        return "stuck: no simulated time passed"
    lines = source_lines(result.error.rstrip("\n"))
    return (
        result.summary or (lines[-1] if lines else result.end.replace("_", " ")) or "did not finish"
    )


def _cut_middle(text: str) -> str:
    if len(text) <= _ERROR_HEAD + _ERROR_TAIL:
        return text
    return f"{text[:_ERROR_HEAD]}…\n…{text[-_ERROR_TAIL:]}"


def _join_lines(text: str) -> str:
    return shortened(printable(text.strip()), MAX_CHARACTERS)
