"""Runs the students' programs as a batch, and collects their outcomes."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.batch.pool import run_many
from tuisim.batch.task import Keep, Task
from tuisim.core.spec import RunSpec
from tuisim.core.tree import to_plain
from tuisim.data_class import dataclass
from tuisim.goals.spec import Goal
from tuisim.marks.journal import Journal
from tuisim.marks.outcome import Outcome, outcome_of
from tuisim.marks.students import Student
from tuisim.marks.workspace import copy_of, digest_of, program_in
from tuisim.runs.handle import RunOptions, user_python_path
from tuisim.runs.removal import remove_tree
from tuisim.runs.temporary import temporary_home

STALL_LIMIT_S = 10.0
"""CPU seconds in one instant of simulated time after which a program counts as hung."""
TIME_LIMIT_S = 120.0
"""Simulated seconds that a program may take, if nobody says otherwise."""
REAL_TIME_LIMIT_S = 120.0
"""Real seconds of one run."""


@dataclass(frozen=True, slots=True)
class MarkPlan:
    """What is run for each student."""

    goals: tuple[Goal, ...]
    seeds: tuple[int, ...]
    options: RunOptions
    keep: Keep
    jobs: int = 0
    """Number of workers; 0 is one for each processor."""
    isolate: bool = False
    version: str = ""
    """Version of tuisim: an interrupted marking is resumed only with the same."""
    arguments: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RunEntry:
    """A student whose program can be run."""

    student: Student
    spec: RunSpec
    """With any seed."""


@dataclass(frozen=True, slots=True)
class _Turn:
    """One run of one student."""

    entry: RunEntry
    seed: int
    key: str


def outcomes_of(entries: Sequence[RunEntry], plan: MarkPlan, journal: Journal) -> Generator[tuple[str, Outcome]]:
    """Run every student's program with every seed; yield names of students and outcomes as they become known.

    A program that hangs, floods or dies with the first seed is not run with the others. Outcomes that the journal
    knows are not run again. Closing the iterator stops what is running.

    Raises:
        LogError: a student's files, a recording or the journal cannot be read or written.
    """
    turns = {entry.student.name: _turns(entry, plan) for entry in entries}
    given_up: set[str] = set()
    first = [every[0] for every in turns.values()]
    for name, outcome in _run(first, plan, journal):
        if outcome.gave_up:
            given_up.add(name)
        yield name, outcome
    later = [turn for name, every in turns.items() if name not in given_up for turn in every[1:]]
    yield from _run(later, plan, journal)


def _turns(entry: RunEntry, plan: MarkPlan) -> list[_Turn]:
    student = entry.student
    assert student.source is not None
    basis: list[object] = [
        plan.version,
        student.main,
        student.source.program.prelude,
        digest_of(student),
        repr(plan.goals),
    ]
    basis += [plan.options.to_plain(), plan.keep, plan.isolate, plan.arguments, user_python_path()]
    turns = []
    for seed in plan.seeds:
        text = json.dumps([*basis, to_plain(replace(entry.spec, seed=seed))], sort_keys=True, default=str)
        turns.append(_Turn(entry, seed, hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()))
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
    with temporary_home("tuisim-mark-") as home:
        # Its resolved path is what a program sees.
        workspace = home.resolve()
        for result in run_many(_tasks(unknown, plan, workspace), plan.jobs):
            turn, place = unknown[result.index], workspace / str(result.index)
            outcome = outcome_of(result, turn.seed, place)
            remove_tree(place)
            if outcome.counts:
                journal.add(turn.key, outcome)
            yield turn.entry.student.name, outcome


def _tasks(turns: Sequence[_Turn], plan: MarkPlan, workspace: Path) -> Iterator[Task]:
    for index, turn in enumerate(turns):
        student = turn.entry.student
        folder = copy_of(student, workspace / str(index))
        program = program_in(student, folder, arguments=plan.arguments, python_path=user_python_path())
        yield Task(
            index=index,
            program=program,
            spec=replace(turn.entry.spec, seed=turn.seed),
            options=plan.options,
            goals=plan.goals,
            parameters={"student": student.name, "seed": turn.seed},
            keep=plan.keep,
            real_time_limit_s=REAL_TIME_LIMIT_S,
            isolate=plan.isolate,
        )
