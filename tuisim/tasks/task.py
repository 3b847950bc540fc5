"""A task of a batch and its result, as plain values that any process can exchange."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field
from enum import StrEnum

from tuisim.base.data_class import dataclass
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.handle import RunOptions
from tuisim.tasks.goals.judgement import Judgement
from tuisim.tasks.goals.spec import Goal

Value = str | float | int | bool
"""Value of a parameter."""

MAX_JOBS = 1000
"""Most worker processes of a batch."""
TIME_LIMIT_S = 120.0
"""Simulated seconds that a program may take that is marked, if nobody says otherwise."""
OUTPUT_CHARACTERS = 2000
"""A result contains at most this much of the program's output."""


class Keep(StrEnum):
    """Which runs of a batch are stored."""

    ALL = "all"
    FAILED = "failed"
    """Those that raised an exception, were stopped, or missed a goal."""
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Task:
    """A task of a batch: one run, with its goals and limits."""

    index: int
    """Place of the task in the batch, from 0."""
    program: Program
    spec: RunSpec
    options: RunOptions = field(default_factory=RunOptions)
    goals: tuple[Goal, ...] = ()
    parameters: Mapping[str, Value] = field(default_factory=dict)
    """Values that distinguish the task from others of the batch, by name."""
    keep: Keep = Keep.NONE
    isolate: bool = False
    """Whether the program runs through bubblewrap, without network and without the user's files."""
    is_replayed: bool = False
    """Whether the run is replayed from the program's commands, and the replay judged, not its own recording."""
    returns_files: bool = False
    """Whether the result contains the files of the recording."""
    tags: tuple[str, ...] = ()
    """The tags of the run in the store, each a single word."""
    real_time_limit_s: float = 0.0
    """Real seconds, without those in which it waits for a processor, after which it is stopped; 0 is no limit."""


@dataclass(frozen=True, slots=True)
class VariableStatistics:
    """Statistics of the samples that a run printed of one variable, in the variable's unit."""

    last: float
    count: int
    mean: float
    std: float
    """Of a sample, as in pandas (`ddof=1`); 0 for one value."""
    min: float
    max: float


@dataclass(frozen=True, slots=True)
class Result:
    """The result of a task: how its run ended, and its recording.

    The result does not depend on the process in which the task was executed.
    """

    index: int
    parameters: Mapping[str, Value]
    end: str
    """A value of `engine.protocol.End`; empty if the run could not be started or judged."""
    exit_code: int
    summary: str
    error: str
    """The program's traceback, or why the run could not be started."""
    error_line: int = 0
    ticks: int = 0
    time_s: float = 0.0
    x_mm: float = math.nan
    y_mm: float = math.nan
    heading_deg: float = math.nan
    variables: Mapping[str, VariableStatistics] = field(default_factory=dict)
    """Statistics by name of sample, in the order of the first samples."""
    judgements: tuple[Judgement, ...] = ()
    output: str = ""
    """The beginning of the program's output on stdout."""
    waited_for: str = ""
    """What the program waited for in vain, in words; see `tasks.reasons.waited`."""
    plugged: str = ""
    """The parts that were plugged in, in words; see `programs.plugged_words`."""
    run_id: str = ""
    """Id of the run in the store; empty if it was not kept."""
    files: Mapping[str, bytes] = field(default_factory=dict)
    """The files of the recording by name, if the task wants them."""
