"""Runs the students' programs as a batch, and collects their outcomes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.faults import describe_fault
from tuisim.base.folders import remove_tree
from tuisim.base.source import user_python_path
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tree import dump_run
from tuisim.engine.runs.catalogue import STUDENT_TAG
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.settings.presses import press_actions
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.journal import Journal
from tuisim.tasks.marks.outcome import Outcome, build_outcome
from tuisim.tasks.marks.students import Student
from tuisim.tasks.marks.workspace import build_program, compute_digest, copy_files
from tuisim.tasks.pool import run_many
from tuisim.tasks.task import Keep, Task

STALL_LIMIT_S = 10.0
"""CPU seconds in one instant of simulated time after which a program counts as hung."""
REAL_TIME_LIMIT_S = 120.0
"""Real seconds after which a run is stopped."""


@dataclass(frozen=True, slots=True)
class MarkPlan:
    """How the programs of all students are run: worlds, seeds and options."""

    worlds: tuple[TrialWorld, ...]
    """The worlds of the task, the first one first."""
    seeds: tuple[int, ...]
    options: RunOptions
    """Without answers to `input()`, a run gets those of its world."""
    keep: Keep
    jobs: int = 0
    """Number of worker processes; 0 means one for each processor."""
    isolate: bool = False
    version: str = ""
    """Version of tuisim: an interrupted marking is resumed only with the same."""
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RunEntry:
    """A student whose program can be run, with the specifications of the runs."""

    student: Student
    specs: tuple[RunSpec, ...]
    """In the order of the worlds, with any seed."""
    presses: tuple[tuple[str, ...], ...]
    """What a hand presses, in the same order."""


@dataclass(frozen=True, slots=True)
class _Turn:
    """One planned run of one student's program: the seed, the world and the options."""

    entry: RunEntry
    seed: int
    world: TrialWorld
    spec: RunSpec
    options: RunOptions
    key: str


def run_entries(
    entries: Sequence[RunEntry], plan: MarkPlan, journal: Journal
) -> Generator[tuple[str, Outcome]]:
    """Run every student's program with every seed; yield names of students and outcomes as they become known.

    A program that hangs, prints without end or dies with the first seed is not run with the other seeds in that world.
    If this happens in the first world, it is not run in the other worlds either. Outcomes in the journal are not
    computed again. Closing the iterator stops the running programs. An unexpected error with one student gives an
    outcome that does not count.

    Args:
        entries: The students.
        plan: How the programs are run.
        journal: The outcomes so far, to which new outcomes are added.

    Raises:
        LogError: the journal cannot be read or written.
    """
    turns: dict[str, list[_Turn]] = {}
    for entry in entries:
        try:
            turns[entry.student.name] = _list_turns(entry, plan)
        except Exception as error:  # Any error concerns this run only; the others go on.
            yield entry.student.name, Outcome(plan.seeds[0], "", describe_fault(error))
    given_up: set[tuple[str, str]] = set()
    first, *others = (world.where for world in plan.worlds)
    rounds = (
        (plan.seeds[:1], [first]),
        (plan.seeds[:1], others),
        (plan.seeds[1:], [first, *others]),
    )
    for seeds, worlds in rounds:
        now = [
            turn
            for name, every in turns.items()
            for turn in every
            if turn.seed in seeds
            and turn.world.where in worlds
            and given_up.isdisjoint({(name, first), (name, turn.world.where)})
        ]
        for name, outcome in _run(now, plan, journal):
            if outcome.gave_up and outcome.seed == plan.seeds[0]:
                given_up.add((name, outcome.world))
            yield name, outcome


def count_runs(outcomes: Sequence[Outcome], plan: MarkPlan) -> int:
    """Return how many runs of a student's program are needed in total.

    Where the program gave up with the first seed, no runs with other seeds follow.

    Args:
        outcomes: The student's outcomes so far.
        plan: The worlds and seeds.
    """
    given_up = {
        outcome.world for outcome in outcomes if outcome.gave_up and outcome.seed == plan.seeds[0]
    }
    if plan.worlds[0].where in given_up:
        return 1
    return sum(1 if world.where in given_up else len(plan.seeds) for world in plan.worlds)


def _list_turns(entry: RunEntry, plan: MarkPlan) -> list[_Turn]:
    student = entry.student
    assert student.source is not None
    basis: list[object] = [
        plan.version,
        student.main,
        student.source.program.prelude,
        compute_digest(student),
    ]
    basis += [plan.keep, plan.isolate, plan.arguments, user_python_path()]
    turns = []
    for world, of_world, presses in zip(plan.worlds, entry.specs, entry.presses, strict=True):
        options = replace(
            plan.options,
            answers=plan.options.answers or world.answers,
            actions=press_actions(presses, of_world.profile.tick_hz),
        )
        settings = [repr(world), options.to_plain()]
        plain = dump_run(of_world)
        for seed in plan.seeds:
            own = [*settings, {**plain, "seed": seed}]
            text = json.dumps([*basis, *own], sort_keys=True, default=str).encode(
                "utf-8", "surrogatepass"
            )
            spec = replace(of_world, seed=seed)
            turns.append(_Turn(entry, seed, world, spec, options, hashlib.sha256(text).hexdigest()))
    return turns


def _run(turns: Sequence[_Turn], plan: MarkPlan, journal: Journal) -> Iterator[tuple[str, Outcome]]:
    unknown = []
    for turn in turns:
        if turn.key in journal.known:
            yield turn.entry.student.name, replace(journal.known[turn.key], seed=turn.seed)
        else:
            unknown.append(turn)
    if not unknown:
        return
    with create_temporary_home("tuisim-mark-") as home:
        # The program sees the resolved path, which `make_portable` must find in its texts.
        workspace = home.resolve()
        uncopied: list[tuple[str, Outcome]] = []
        for result in run_many(_build_tasks(unknown, plan, workspace, uncopied), plan.jobs):
            turn = unknown[result.index]
            place = workspace / str(result.index)
            try:
                outcome = build_outcome(result, turn.seed, place, turn.world)
            except Exception as error:  # Any error concerns this run only; the others go on.
                outcome = _build_unjudged(turn, error)
            remove_tree(place)
            if outcome.counts:
                journal.add(turn.key, outcome)
            yield turn.entry.student.name, outcome
        yield from uncopied


def _build_unjudged(turn: _Turn, error: Exception) -> Outcome:
    return Outcome(turn.seed, "", describe_fault(error), world=turn.world.where)


def _build_tasks(
    turns: Sequence[_Turn],
    plan: MarkPlan,
    workspace: Path,
    uncopied: list[tuple[str, Outcome]],
) -> Iterator[Task]:
    """Yield a task for each planned run, with a copy of the student's files.

    Args:
        turns: The runs.
        plan: How the programs are run.
        workspace: The folder for the copies.
        uncopied: If the files for a run cannot be copied, the student's name and an outcome are added to this list, and
            the run has no task.
    """
    for index, turn in enumerate(turns):
        student = turn.entry.student
        try:
            folder = copy_files(student, workspace / str(index))
        except Exception as error:  # Any error concerns this run only; the others go on.
            uncopied.append((student.name, _build_unjudged(turn, error)))
            continue
        program = build_program(
            student, folder, arguments=plan.arguments, python_path=user_python_path()
        )
        yield Task(
            index=index,
            program=program,
            spec=turn.spec,
            options=turn.options,
            goals=turn.world.own_goals,
            parameters={"student": student.name, "seed": turn.seed},
            keep=plan.keep,
            # A tag names the student, as all programs of a class may have the same name.
            tags=(STUDENT_TAG + "_".join(student.name.split()),),
            real_time_limit_s=REAL_TIME_LIMIT_S,
            isolate=plan.isolate,
            is_replayed=True,
        )
