"""Tries a lesson out for its author: model answers must pass their steps, wrong programs must not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.programs.program_file import parse_program
from tuisim.programs.program_settings import build_program_settings
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.presses import press_actions
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons.spec import Lesson, LessonStep, RunCheck, Way
from tuisim.tasks.pool import run_many
from tuisim.tasks.task import Result, Task

TIME_LIMIT_S = 180.0
"""Simulated seconds that a program of a lesson may take."""
_Key = tuple[str, int, str]
"""The text of a program, the seed, and which other world of the step it is; empty for the lesson's world."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A program in a lesson's file, to be tried on a step."""

    step: LessonStep
    text: str
    line: int
    """Where it begins in the lesson's file; 0 for the model answer."""
    passes: bool
    """Whether it must pass."""
    seed: int
    way: Way | None = None
    """The kind of its fault, if the lesson's file gives it."""


def list_trials(lesson: Lesson) -> list[Trial]:
    """Return the programs of a lesson that are to be tried on its steps.

    Each model answer is tried as often as its step requires runs, with different seeds; each wrong program once.
    """
    trials_to_run = []
    seed = build_run_spec(Settings.merge(lesson.settings)).seed
    for step in lesson.steps:
        if isinstance(step.check, RunCheck):
            trials_to_run += [
                Trial(step, step.answer, 0, True, seed + more) for more in range(step.check.times)
            ]
            trials_to_run += [
                Trial(step, wrong.text, wrong.line, False, seed, wrong.way)
                for wrong in step.wrong_programs
            ]
    return trials_to_run


def build_task(
    lesson: Lesson, text: str, seed: int, index: int = 0, other: TrialWorld | None = None
) -> Task:
    """Return the task that runs a program in the lesson's world or in another world of a step.

    Args:
        lesson: The lesson.
        text: The program.
        seed: The seed of the run.
        index: Index of the task in its batch.
        other: The other world; None for the lesson's.

    Raises:
        ConfigError: the program's magic line, or the world, is wrong.
    """
    source = parse_program(text, f"{lesson.name}.py")
    world_settings = {**lesson.settings, **(other.settings if other else {})}
    resolved = build_program_settings(source, world_settings, {"seed": seed})
    spec = build_run_spec(resolved.settings)
    goals = (*lesson.goals, *(other.own_goals if other else ()))
    actions = press_actions(resolved.settings["press"], spec.profile.tick_hz)
    options = RunOptions(time_limit_s=TIME_LIMIT_S, actions=actions)
    return Task(index, source.program, spec, options, goals)


def try_elsewhere(
    lesson: Lesson, check: RunCheck, run: StoredRun
) -> list[tuple[TrialWorld, tuple[Judgement, ...]]]:
    """Run the program of a run in the other worlds of a check; return each world with its judgements. This blocks.

    Raises:
        ConfigError: the program's magic line is wrong in another world.
    """
    text = run.program.text
    seed = run.spec.seed
    tasks = [build_task(lesson, text, seed, index, other) for index, other in enumerate(check.also)]
    return [(check.also[result.index], result.judgements) for result in run_many(tasks, jobs=1)]


def run_model(lesson: Lesson, step: LessonStep | None) -> Recording:
    """Run the model answer of a step in the lesson's world, and return its recording. This blocks meanwhile.

    The run is not stored.

    Args:
        lesson: The lesson.
        step: The step; None, or one without a model answer, for the last model answer of the lesson.

    Raises:
        TuisimError: the program cannot run.
    """
    text = (step.answer if step else "") or lesson.model_answer
    task = build_task(lesson, text, build_run_spec(Settings.merge(lesson.settings)).seed)
    with create_temporary_home() as home:
        handle = start_run(task.program, task.spec, task.options, RunStore(home))
        try:
            handle.wait()
            run = handle.stored()
            # The whole recording is read now, since the run's folder is removed afterwards.
            run.telemetry.hold()
            run.output.hold()
            return Recording(run, name="the model answer")
        finally:
            handle.close()


def find_faults(lesson: Lesson) -> list[str]:
    """Run all programs of a lesson, and return the faults of the lesson as texts of one line. This blocks.

    Raises:
        ConfigError: a program's magic line, or the world, is wrong.
    """
    tried = list_trials(lesson)
    tasks: dict[_Key, Task] = {}
    for trial in tried:
        for key, other in _list_worlds(trial):
            if key not in tasks:
                tasks[key] = build_task(lesson, trial.text, trial.seed, len(tasks), other)
    keys = list(tasks)
    results = {keys[result.index]: result for result in run_many(list(tasks.values()), jobs=1)}
    return [fault for trial in tried for fault in _find_trial_faults(lesson, trial, results)]


def _list_worlds(trial: Trial) -> list[tuple[_Key, TrialWorld | None]]:
    """Return a pair for each world in which a program is tried: the key of the run's result, and the world.

    The world is None for the lesson's own world.
    """
    check = trial.step.check
    assert isinstance(check, RunCheck)
    others = [
        ((trial.text, trial.seed, f"{trial.step.name} {other.where}"), other)
        for other in check.also
    ]
    return [((trial.text, trial.seed, ""), None), *others]


def _find_trial_faults(
    lesson: Lesson, trial: Trial, results: Mapping[_Key, Result]
) -> Iterator[str]:
    """Yield a line if a model answer does not pass its step, or a wrong program passes it."""
    check = trial.step.check
    assert isinstance(check, RunCheck)
    tried = [(results[key], other) for key, other in _list_worlds(trial)]
    missed = [
        (result, _find_missed(other.goals if other else check.goals, result), other)
        for result, other in tried
    ]
    result, reasons, other = next((miss for miss in missed if miss[1]), missed[0])
    if trial.passes and reasons:
        error = (
            f"; it ended with: {source_lines(result.error.strip())[-1]}"
            if result.error.strip()
            else ""
        )
        where = f" {other.where}" if other else ""
        yield (
            f"{lesson.path}, line {trial.step.line}: the model answer does not pass “{trial.step.title}”{where}: "
            f"{'; '.join(reasons)}{error}"
        )
    elif not trial.passes and not reasons:
        way = f" ({trial.way})" if trial.way else ""
        yield f"{lesson.path}, line {trial.line}: this wrong program{way} passes “{trial.step.title}”"


def _find_missed(goals: Sequence[str], result: Result) -> list[str]:
    """Return which of the named goals a run has missed, each with the reason, as text."""
    by_name = {each.goal.name: each for each in result.judgements}
    return [
        f"{name}: {by_name[name].reason}"
        for name in goals
        if by_name[name].state is not GoalState.MET
    ]
