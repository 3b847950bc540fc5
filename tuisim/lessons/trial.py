"""Tries a lesson out for its author: model answers must pass their steps, wrong programs must not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from tuisim.batch.pool import run_many
from tuisim.batch.task import Result, Task
from tuisim.config.build import build_run_spec
from tuisim.config.options import settings_of
from tuisim.config.program_file import parse_program
from tuisim.config.program_settings import program_settings
from tuisim.core.geometry import Pose
from tuisim.core.spec import RunSpec
from tuisim.goals.judgement import GoalState, Judgement
from tuisim.lessons.spec import Lesson, Question, Run, Step, Way
from tuisim.runs.handle import RunOptions
from tuisim.runs.run_folder import StoredRun
from tuisim.source import source_lines

TIME_LIMIT_S = 180.0
"""Simulated seconds that a program of a lesson may take."""
Start = tuple[float, float, float]
"""x, y and heading of the robot at the beginning."""
_Key = tuple[str, int, Start | None]
"""The text of a program, the seed, and the start; None for that of the lesson."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A program that is tried on a step."""

    step: Step
    text: str
    line: int
    """Where it begins in the lesson's file; 0 for the model answer."""
    passes: bool
    """Whether it must pass."""
    seed: int
    way: Way | None = None
    """The wrong way that it goes, if it is said."""


def trials(lesson: Lesson) -> list[Trial]:
    """Return what has to be tried: each model answer as often as its step asks for, and each wrong program once."""
    found = []
    seed = build_run_spec(settings_of(lesson.settings)).seed
    for step in lesson.steps:
        if isinstance(step.check, Run):
            found += [Trial(step, step.answer, 0, True, seed + more) for more in range(step.check.times)]
            found += [Trial(step, wrong.text, wrong.line, False, seed, wrong.way) for wrong in step.wrong_programs]
    return found


def task_of(lesson: Lesson, text: str, seed: int, index: int = 0, start: Start | None = None) -> Task:
    """Return the run of a program in the world of a lesson, with a seed, perhaps from another start.

    Raises:
        ConfigError: its magic line, or the world, is wrong.
    """
    source = parse_program(text, f"{lesson.name}.py")
    of_lesson = bool(lesson.settings)
    found = program_settings(source, lesson.settings, {"seed": seed}, in_world=of_lesson, of_task=of_lesson)
    spec = build_run_spec(found.settings)
    return Task(index, source.program, _from(spec, start), RunOptions(time_limit_s=TIME_LIMIT_S), lesson.goals)


def _from(spec: RunSpec, start: Start | None) -> RunSpec:
    return spec if start is None else replace(spec, world=replace(spec.world, start=Pose(*start)))


def tried_from(lesson: Lesson, check: Run, run: StoredRun) -> list[tuple[Start, tuple[Judgement, ...]]]:
    """Try the program of a run from the other starts of a check, and judge that; blocks meanwhile."""
    options = RunOptions(time_limit_s=TIME_LIMIT_S)
    tasks = [
        Task(index, run.program, _from(run.spec, start), options, lesson.goals)
        for index, start in enumerate(check.also_from)
    ]
    return [(check.also_from[result.index], result.judgements) for result in run_many(tasks, jobs=1)]


def faults(lesson: Lesson) -> list[str]:
    """Try a lesson out, and return what is wrong, each as a line; blocks while its programs run.

    Raises:
        ConfigError: a program's magic line, or the world, is wrong.
    """
    tried = trials(lesson)
    keys: list[_Key] = list(dict.fromkeys(key for trial in tried for key in _keys(trial)))
    tasks = [task_of(lesson, text, seed, index, start) for index, (text, seed, start) in enumerate(keys)]
    results = {keys[result.index]: result for result in run_many(tasks, jobs=1)}
    return [fault for trial in tried for fault in _faults_of(lesson, trial, [results[key] for key in _keys(trial)])]


def _keys(trial: Trial) -> list[_Key]:
    assert isinstance(trial.step.check, Run)
    return [(trial.text, trial.seed, start) for start in (None, *trial.step.check.also_from)]


def warnings(lesson: Lesson) -> list[str]:
    """Return what a lesson lacks, each as a line: wrong ways that are not tried, and answers without a reason."""
    found = []
    for step in lesson.steps:
        at = f"{lesson.path}, line {step.line}"
        found += [f"{at}: no wrong way “{way}” is tried on “{step.title}”, nor excluded" for way in step.missing_ways()]
        if isinstance(step.check, Question | Run) and not step.why:
            found.append(f"{at}: no `why` says why what passes “{step.title}” is right")
    return found


def _faults_of(lesson: Lesson, trial: Trial, results: Sequence[Result]) -> Iterator[str]:
    """Yield what is wrong with a trial, of which there is a result for each start."""
    result = next((one for one in results if _missed(trial.step, one.judgements)), results[0])
    missed = _missed(trial.step, result.judgements)
    if trial.passes and missed:
        reasons = "; ".join(f"{each.goal.name}: {each.reason}" for each in missed)
        error = f"; it ended with: {source_lines(result.error.strip())[-1]}" if result.error.strip() else ""
        yield f"{lesson.path}, line {trial.step.line}: the model answer does not pass “{trial.step.title}”: " + (
            f"{reasons}{error}"
        )
    elif not trial.passes and not missed:
        way = f" ({trial.way})" if trial.way else ""
        yield f"{lesson.path}, line {trial.line}: this wrong program{way} passes “{trial.step.title}”"


def _missed(step: Step, judgements: Sequence[Judgement]) -> list[Judgement]:
    assert isinstance(step.check, Run)
    met = {each.goal.name for each in judgements if each.state is GoalState.MET}
    by_name = {each.goal.name: each for each in judgements}
    return [by_name[name] for name in step.check.goals if name not in met]
