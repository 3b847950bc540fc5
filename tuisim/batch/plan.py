"""The plan of a batch: its programs, their settings, and the tasks of all combinations."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import field, replace
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.batch.parameters import SEED, Choice, Grid, build_grid, check_seeds
from tuisim.batch.table import check_expressions
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tree import dump_run
from tuisim.engine.runs.handle import RunOptions
from tuisim.programs.program_settings import require_library
from tuisim.settings.build import build_run_spec, list_ineffective
from tuisim.settings.options import Settings
from tuisim.settings.overrides import resolve_keys
from tuisim.settings.presses import press_actions
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.task import Keep, Task, Value


@dataclass(frozen=True, slots=True)
class Subject:
    """One program of a batch, with the settings that the parameters change."""

    program: Program
    settings: Settings
    given: frozenset[str] = frozenset()
    """The paths of the settings that were chosen for all runs, and that no parameter may change."""
    name: str = ""
    """The name in the table; empty for the program's own name."""

    @property
    def label(self) -> str:
        """The name of the program in the batch's table."""
        return self.name or self.program.name


@dataclass(frozen=True, slots=True)
class Plan:
    """All runs of a batch: every program with every combination of parameters, in this order.

    Raises:
        ConfigError: a parameter is unknown, or one of its values is wrong; nothing was run.
    """

    subjects: tuple[Subject, ...]
    choices: Mapping[str, Choice]
    """The values of each parameter; the last one varies fastest."""
    path: Path = Path("--set")
    """The file to blame for wrong parameters; paths in them are relative to its folder."""
    goals: tuple[Goal, ...] = ()
    keep: Keep = Keep.NONE
    returns_files: bool = False
    """Whether results include the files of their runs' recordings."""
    options: RunOptions = field(default_factory=RunOptions)
    """How a run is executed; what is pressed by hand is added from the settings of its program."""
    grid: Grid = field(init=False)
    _specs: dict[tuple[object, ...], RunSpec] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        # A worker may run in another folder, so the program keeps the working directory of this process.
        subjects = tuple(
            replace(each, program=each.program.add_surroundings()) for each in self.subjects
        )
        object.__setattr__(self, "subjects", subjects)
        first = self.subjects[0]

        def is_whole(name: str, inside: float) -> bool:
            try:
                resolve_keys({name: inside}, first.settings, self.path)
            except ConfigError:
                resolve_keys({name: math.ceil(inside)}, first.settings, self.path)
                return True
            return False

        object.__setattr__(self, "grid", build_grid(self.choices, is_whole))
        if isinstance(seeds := self.choices.get(SEED), tuple):
            check_seeds(seeds, SEED)
        for subject in self.subjects:
            self._check(subject)

    def _check(self, subject: Subject) -> None:
        """Check the combinations of a program's parameters, except for the seeds.

        Raises:
            ConfigError: a combination has a wrong value.
        """
        own = [axis for axis in self.grid.axes if axis.names != (SEED,)]
        for name in self.choices:
            if name in subject.given:
                message = f"{name} varies what an option sets"
                raise ConfigError(
                    message, f"give the option, or the values of {name}", key=str(self.path)
                )
        for values in Grid(tuple(own)):
            spec = self.build_spec(subject, values)
            if "profile" in values:
                require_library(subject.program, spec.profile)

    def __len__(self) -> int:
        return len(self.subjects) * len(self.grid)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the parameters of the batch."""
        return self.grid.names

    @property
    def remarks(self) -> list[str]:
        """Sentences about chosen values that have no effect on the runs of the batch."""
        return [
            *dict.fromkeys(text for spec in self._specs.values() for text in list_ineffective(spec))
        ]

    def check_expressions(self, expressions: Mapping[str, str]) -> None:
        """Check the expressions for further columns of the table before any run starts.

        Args:
            expressions: The expressions by the name of their column.

        Raises:
            ConfigError: an expression cannot be parsed, names a column that the table will not have, or has the name of
                a column that the table will have.
        """
        check_expressions(expressions, self.names, [goal.name for goal in self.goals])

    def find_subject(self, index: int) -> Subject:
        """Return the program of a run, whose `index` counts from 0."""
        return self.subjects[index // len(self.grid)]

    def find_seed(self, index: int) -> int:
        """Return the seed of a run, whose `index` counts from 0."""
        seed = self.grid.find_values(index % len(self.grid)).get(
            SEED, self.find_subject(index).settings["seed"]
        )
        assert isinstance(seed, int)
        return seed

    def build_spec(self, subject: Subject, values: Mapping[str, Value]) -> RunSpec:
        """Return the specification of a run; runs that differ only in the seed share one that is built once.

        Args:
            subject: The program.
            values: The parameter values.

        Raises:
            ConfigError: a value is wrong.
        """
        own = {name: value for name, value in values.items() if name != SEED}
        key = (id(subject), *own.items(), *map(type, own.values()))
        if key not in self._specs:
            self._specs[key] = build_run_spec(self._merge_settings(subject, own))
        spec = self._specs[key]
        seed = values.get(SEED)
        return replace(spec, seed=seed) if isinstance(seed, int) else spec

    def _merge_settings(self, subject: Subject, values: Mapping[str, Value]) -> Settings:
        changes = resolve_keys(values, subject.settings, self.path)
        # A new mat unsets the start pose (None), so that its own applies, unless the pose was chosen for all runs.
        remaining = {
            key: value
            for key, value in changes.items()
            if value is not None or key not in subject.given
        }
        return subject.settings.changed(remaining)

    def _build_options(self, spec: RunSpec, subject: Subject) -> RunOptions:
        actions = press_actions(subject.settings["press"], spec.profile.tick_hz)
        return replace(self.options, actions=actions)

    def iterate_tasks(self, done: Collection[int] = ()) -> Iterator[Task]:
        """Yield the tasks whose index is not in `done`."""
        for index in range(len(self)):
            if index not in done:
                yield self.task(index)

    def count_seeds(self) -> int:
        """Return how many successive runs differ only in their seed.

        The result is 1 if another parameter than the seed varies fastest.
        """
        last = self.grid.axes[-1] if self.grid.axes else None
        return len(last.points) if last and last.names == (SEED,) else 1

    def task(self, index: int) -> Task:
        """Return the task of a run, whose `index` counts from 0."""
        subject = self.find_subject(index)
        values = self.grid.find_values(index % len(self.grid))
        spec = self.build_spec(subject, values)
        program = subject.program
        if "arguments" in values:
            program = replace(program, arguments=self._merge_settings(subject, values)["arguments"])
        if any(name.partition(".")[0] == "robot" for name in values):
            # The robot counts as named by the user, so its parts do not depend on the ports that the program shows.
            program = replace(program, shown_ports=None)
        return Task(
            index,
            program,
            spec,
            self._build_options(spec, subject),
            goals=self.goals,
            parameters=values,
            keep=self.keep,
            returns_files=self.returns_files,
        )

    def build_identity(self) -> dict[str, Any]:
        """Return a dict for JSON that is equal for batches with equal rows.

        The dict includes goals, but not expressions, since these are computed from the rows.
        """
        programs = [
            {
                "name": each.label,
                "sha256": each.program.sha256,
                "prelude": each.program.prelude,
                "arguments": list(each.program.arguments),
            }
            for each in self.subjects
        ]
        whole = hashlib.sha256()
        own = Grid(tuple(axis for axis in self.grid.axes if axis.names != (SEED,)))
        for subject in self.subjects:
            for values in own:
                spec = self.build_spec(subject, values)
                plain = [dump_run(spec), self._build_options(spec, subject).to_plain()]
                whole.update(json.dumps(plain, sort_keys=True).encode())
        whole.update(repr((programs, self.grid.axes, self.goals, str(self.keep))).encode())
        return {
            "programs": programs,
            "parameters": list(self.names),
            "runs": len(self),
            "sha256": whole.hexdigest(),
        }
