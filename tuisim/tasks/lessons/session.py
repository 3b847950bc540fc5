"""A student's way through a lesson: the step to do, what was done since it began, and what is to follow."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from enum import StrEnum
from pathlib import Path
from typing import TypeAlias, assert_never

from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import RunSpec, WorldSpec
from tuisim.engine.core.values import list_values
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import load_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.goals.spec import LogCondition, PrintCondition
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons.events import (
    BreakMet,
    Event,
    Exported,
    ExpressionWatched,
    JudgedRun,
    Noted,
    Shown,
    TriedElsewhere,
    Typed,
    Visited,
    count_good_runs,
    describe_form,
    explain_unready,
    explain_wrong,
    find_passed_runs,
    is_met,
    note_fault,
)
from tuisim.tasks.lessons.progress import (
    LessonProgress,
    StepState,
    format_now,
    load_progress,
    save_progress,
)
from tuisim.tasks.lessons.spec import (
    BreakCheck,
    ExportCheck,
    Lesson,
    LessonStep,
    NoteCheck,
    QuestionCheck,
    RunCheck,
    ShowCheck,
    VisitCheck,
    WatchCheck,
)
from tuisim.tasks.lessons.story import build_story

WorldJudgements: TypeAlias = list[tuple[TrialWorld, tuple[Judgement, ...]]]
"""Other worlds, each with the judgements of a program in it."""
NOTES_PERIOD_S = 0.5
"""The least time between two readings of the notes of a run."""
_PAUSE_S = 10.0
"""The least time to the next reading after notes that could not be read."""


class Change(StrEnum):
    """The action that the caller of a `LessonSession` must take after an event."""

    NONE = "none"
    SHOW = "show"
    """The display of the step must be updated."""
    TRY = "try"
    """Also, `Attempt.trial` must be run in the background, and its result passed to `take_trial`."""
    GO_ON = "go on"
    """The step is over: call `begin_step`."""


@dataclass(frozen=True, slots=True)
class Sight:
    """The panels, the run and the state of the debugger that a student sees at one moment."""

    panels: frozenset[str]
    """The panels in `SEEABLE` that are on the screen."""
    recording: Recording | None = None
    """The run in view."""
    is_paused: bool = False
    is_over: bool = False
    judged: Recording | None = None
    """The run that was judged last."""
    judgements: tuple[Judgement, ...] = ()
    watches: tuple[str, ...] = ()
    """Expressions of which a paused program shows the value."""
    break_met: str | None = None
    """The breakpoint at which the program has stopped; None if it has not."""
    past_s: float | None = None
    """The past instant in view, if it is one."""


@dataclass(frozen=True, slots=True)
class WorldTrial:
    """The program of a run that has met a step's goals, to be tried in the other worlds of the step."""

    lesson: Lesson
    check: RunCheck
    run_id: str
    folder: Path

    def run(self) -> WorldJudgements:
        """Run the program in each of the other worlds, and return the judgements. This blocks.

        Raises:
            TuisimError: the run is damaged, or the program's magic line is wrong in another world.
        """
        from tuisim.tasks.lessons.trial import try_elsewhere

        return try_elsewhere(self.lesson, self.check, load_run(self.folder))


@dataclass(slots=True)
class Attempt:
    """A student's attempt at a step: what has happened since the step began."""

    run_before: str = ""
    """Id of the run that was in view, which does not count."""
    events: list[Event] = field(default_factory=list)
    seen: set[str] = field(default_factory=set)
    """The panels in `SEEABLE` that were on the screen."""
    judgements: tuple[Judgement, ...] = ()
    """The judgements of the last run."""
    elsewhere: RunSpec | None = None
    """Specification of the last run, if it did not begin in the lesson's world; otherwise None."""
    run_counted: str = ""
    """Id of the last run that was counted as a try."""
    trial: WorldTrial | None = None
    """The program that is to be tried in other worlds, or was tried last."""
    remark: str = ""
    """Why the last note, or the last program in another world, does not pass."""


class LessonSession:
    """A lesson that a student does: call `resume`, then for each step `begin_step` and a method for each event.

    Attributes:
        lesson: The lesson.
        progress: The student's progress; `save` stores it.
        done: The previous step if it was done; None if it was skipped, or if there is none.
        attempt: What has happened since the present step began.
        story: What happened in the run that passed the previous step; empty if that step was not about a run.
    """

    def __init__(self, lesson: Lesson) -> None:
        self.lesson = lesson
        self.progress = LessonProgress()
        self.done: LessonStep | None = None
        self.story = ""
        self._saved = self.progress
        self.attempt = Attempt()
        self._next_look_s = 0.0

    def resume(self) -> None:
        """Load the student's progress on the lesson.

        Raises:
            ConfigError: the file with the progress is damaged; after this, the lesson begins at its first step.
        """
        try:
            self.progress = load_progress().get(self.lesson.name, LessonProgress())
        finally:
            self.progress = replace(self.progress, opened_at=format_now())

    def start_over(self) -> None:
        """Discard the student's progress on the lesson, so that the lesson begins at its first step."""
        self.progress = LessonProgress(opened_at=format_now())
        self.done = None

    def save(self) -> None:
        """Store the student's progress if it has changed.

        Raises:
            ConfigError: the file cannot be written.
        """
        if self.progress is not self._saved:
            self._saved = self.progress
            save_progress(self.lesson.name, self.progress)

    def begin_step(self, run_id: str) -> None:
        """Begin the next step of the lesson.

        Args:
            run_id: Id of the run that is in view now, which cannot pass the step.
        """
        self.attempt = Attempt(run_id)

    # What is known

    @property
    def at(self) -> int | None:
        """Index of the step to do; None when all steps are done or skipped."""
        return self.progress.current(self.lesson)

    @property
    def step(self) -> LessonStep | None:
        """The step to do; None when all steps are done or skipped."""
        return None if self.at is None else self.lesson.steps[self.at]

    @property
    def step_before(self) -> LessonStep | None:
        """The previous step; after the end of the lesson, its last step. None at the first step."""
        index = len(self.lesson.steps) if self.at is None else self.at
        return self.lesson.steps[index - 1] if index else None

    @property
    def hints(self) -> int:
        """The number of hints of the present step that are shown."""
        return self.progress.of(self.step.name).hints if self.step else 0

    @property
    def good_runs(self) -> int:
        """The number of runs that have passed the present step's check so far."""
        step = self.step
        if step is None or not isinstance(step.check, RunCheck):
            return 0
        return count_good_runs(step.check, self.attempt.events)

    def describe_elsewhere(self, pose: Pose, *, in_run: bool) -> str:
        """Return why the last run does not count for the step, and what to do, as sentences; empty if it counts.

        Args:
            pose: The robot's present pose.
            in_run: Whether a run is going on.
        """
        elsewhere = self.attempt.elsewhere
        if elsewhere is None:
            return ""
        world = self._build_spec().world
        if _list_place(elsewhere.world) == _list_place(world):
            noise = world.noise
            drift = list_values(WorldSpec)["drift"].format_text(world.drift)
            levels = f"light {noise.light}, motors {noise.motor} (panel Noise, z), drift {drift} (panel Settings, Z)"
            return f"This run had different noise or drift: the lesson has {levels}."
        if in_run:
            return "This run began elsewhere."
        if pose == world.start:
            return "This run began elsewhere. The robot is back at its start: R runs the program."
        return "This run began elsewhere: m moves the robot to its start, then R."

    def _build_spec(self) -> RunSpec:
        return build_run_spec(Settings.merge(self.lesson.settings))

    # What the student does

    def answer(self, text: str, x_mm: float, sight: Sight) -> Change:
        """Check a typed answer to the present step's question; return what the caller must do.

        Args:
            text: The answer.
            x_mm: The x coordinate of the robot's present position.
            sight: What the app shows.

        Raises:
            TuisimError: the answer is wrong, or the student must do something else first.
        """
        step = self.step
        if step is None or not isinstance(step.check, QuestionCheck):
            return Change.NONE
        check = step.check
        if not text:
            raise TuisimError("Type an answer")
        if form := describe_form(check, text):
            raise TuisimError(f"{text}: type {form}")
        self.attempt.seen |= sight.panels
        # The output, which may be millions of lines, is read only for questions about it.
        printed: tuple[str, ...] = ()
        if sight.recording is not None and check.printed:
            output = load_run(sight.recording.folder).output
            printed = tuple(row.text for row in output.read_all_rows())
        seen = frozenset(self.attempt.seen)
        typed = Typed(text, x_mm, seen, printed, sight.recording is not None)
        # An answer given too early or at another place is not counted as a wrong one.
        if first := explain_unready(check, typed):
            raise TuisimError(first)
        if self._take(typed):
            return Change.GO_ON
        self._count_try(step)
        hint = ". Escape, then Y shows a hint" if len(step.hints) > self.hints else ""
        raise TuisimError(f"{explain_wrong(check, step.wrong, text)}{hint}")

    def _count_try(self, step: LessonStep) -> None:
        tries = self.progress.of(step.name).tries + 1
        self.progress = self.progress.update_step(step.name, tries=tries)

    def show_hint(self) -> None:
        """Count one more hint of the present step as shown; the step must have one."""
        if self.step:
            self.progress = self.progress.update_step(self.step.name, hints=self.hints + 1)

    def skip_step(self) -> LessonStep | None:
        """Skip the present step, and return it; None if all steps are done or skipped."""
        step = self.step
        if step is not None:
            self._leave_step(step, StepState.SKIPPED)
        return step

    def take_export(self, name: str) -> Change:
        """Check whether an exported log passes the present step; return what the caller must do.

        Args:
            name: The name of the exported file.
        """
        return Change.GO_ON if self._take(Exported(name)) else Change.NONE

    def look(self, sight: Sight) -> Change:
        """Check whether what the app shows passes the present step; return what the caller must do.

        Raises:
            TuisimError: the notes on the run, or its recording, are damaged.
        """
        step = self.step
        if step is None:
            return Change.NONE
        self.attempt.seen |= sight.panels
        events: Sequence[Event] = ()
        match step.check:
            case RunCheck():
                return self._look_at_run(step, step.check, sight)
            case NoteCheck():
                return self._look_at_notes(step.check, sight)
            case WatchCheck():
                events = [ExpressionWatched(text) for text in sight.watches]
            case BreakCheck():
                events = [] if sight.break_met is None else [BreakMet(sight.break_met)]
            case VisitCheck():
                events = [] if sight.past_s is None else [Visited(sight.past_s)]
            case ShowCheck(panel=panel):
                events = [Shown(panel, sight.is_paused)] if panel in sight.panels else []
            case QuestionCheck() | ExportCheck():
                # `answer` and `take_export` check these.
                pass
            case _:
                assert_never(step.check)
        return Change.GO_ON if any(map(self._take, events)) else Change.NONE

    def _look_at_run(self, step: LessonStep, check: RunCheck, sight: Sight) -> Change:
        attempt = self.attempt
        run = sight.judged
        judgements = sight.judgements
        if run is None or run.run_id == attempt.run_before or judgements is attempt.judgements:
            return Change.NONE
        attempt.judgements = judgements
        is_from_start = _list_world(self._build_spec()) == _list_world(run.spec)
        attempt.elsewhere = None if is_from_start else run.spec
        if self._take(JudgedRun(run.run_id, run.spec.seed, _list_met(judgements), is_from_start)):
            return Change.GO_ON
        # A run that has ended without passing the step counts as a try.
        states = {each.state for each in judgements if each.goal.name in check.goals}
        is_missed = GoalState.MISSED in states and GoalState.OPEN not in states
        if sight.is_over and is_missed and attempt.run_counted != run.run_id:
            attempt.run_counted = run.run_id
            self._count_try(step)
        is_good = any(good.run_id == run.run_id for good in find_passed_runs(check, attempt.events))
        is_tried = attempt.trial is not None and attempt.trial.run_id == run.run_id
        if not (is_good and sight.is_over and check.also) or is_tried:
            return Change.SHOW
        attempt.trial = WorldTrial(self.lesson, check, run.run_id, run.folder)
        attempt.remark = f"Your program now also runs {check.also[0].where} …"
        return Change.TRY

    def take_trial(self, trial: WorldTrial, judged: WorldJudgements) -> Change:
        """Check whether a program's results in other worlds pass the present step; return what the caller must do.

        Results for a step that the student has left in the meantime are ignored.

        Args:
            trial: The program that was tried.
            judged: Its judgements in each world.
        """
        if self.step is None or self.step.check is not trial.check:
            return Change.NONE
        remark = ""
        for other, judgements in judged:
            met = _list_met(judgements)
            if self._take(TriedElsewhere(trial.run_id, other.where, met)):
                return Change.GO_ON
            missed = [
                each
                for each in judgements
                if each.goal.name in other.goals and each.goal.name not in met
            ]
            if missed and not remark:
                remark = f"Also tried {other.where}, it does not work{_tell_start(other)}: {_explain_miss(missed[0])}"
        # If the student has begun another run meanwhile, the remark on this one is no longer shown.
        if self.attempt.trial is trial:
            self.attempt.remark = remark
        return Change.SHOW

    def _look_at_notes(self, check: NoteCheck, sight: Sight) -> Change:
        if sight.recording is None or time.monotonic() < self._next_look_s:
            return Change.NONE
        self._next_look_s = time.monotonic() + _PAUSE_S
        notes = list(_read_notes(sight.recording.folder))
        self._next_look_s = time.monotonic() + NOTES_PERIOD_S
        if any(map(self._take, notes)):
            return Change.GO_ON
        remark = note_fault(check, notes[-1]) if notes else ""
        is_new = remark != self.attempt.remark
        self.attempt.remark = remark
        return Change.SHOW if is_new else Change.NONE

    def _take(self, event: Event) -> bool:
        """Add an event to the student's attempt at the present step; return whether the step is done now."""
        step = self.step
        events = self.attempt.events
        if step is None or event in events:
            return False
        if isinstance(event, JudgedRun):
            events[:] = [earlier for earlier in events if not _is_about_run(earlier, event.run_id)]
        events.append(event)
        if not is_met(step.check, events):
            return False
        self._leave_step(step, StepState.DONE)
        return True

    def _leave_step(self, step: LessonStep, state: StepState) -> None:
        goals = step.check.goals if isinstance(step.check, RunCheck) else ()
        self.story = build_story(
            each for each in self.attempt.judgements if each.goal.name in goals
        )
        self.progress = self.progress.update_step(step.name, state=state, at=format_now())
        self.done = step if state is StepState.DONE else None


def _is_about_run(event: Event, run_id: str) -> bool:
    return isinstance(event, JudgedRun) and event.run_id == run_id


def _list_met(judgements: Sequence[Judgement]) -> frozenset[str]:
    return frozenset(each.goal.name for each in judgements if each.state is GoalState.MET)


def _list_world(spec: RunSpec) -> tuple[object, ...]:
    """Return the values that a run's world must share with the lesson's.

    They are mat, start, obstacles, noise and drift. A run with other values does not count for the step.
    """
    return (*_list_place(spec.world), spec.world.noise, spec.world.drift)


def _list_place(world: WorldSpec) -> tuple[object, ...]:
    """Return mat, start and obstacles of a world."""
    return world.background, world.start, world.obstacles


def _explain_miss(missed: Judgement) -> str:
    """Return why a goal is missed in another world, without numbers and words that would give the answer away."""
    if any(isinstance(part, LogCondition | PrintCondition) for part in missed.goal.parts):
        return "the program does not print the robot's readings at the places where the robot reads them."
    return missed.reason


def _tell_start(other: TrialWorld) -> str:
    """Return where the robot starts in another world, for a sentence; empty if the world has the lesson's start."""
    coordinates = {axis: other.settings.get(f"start.{axis}_mm") for axis in "xy"}
    places = [f"{axis} = {value:g} mm" for axis, value in coordinates.items() if value is not None]
    return f" (start {', '.join(places)})" if places else ""


def _read_notes(folder: Path) -> Iterator[Noted]:
    """Yield an event for each note on a stored run, with the mean of the samples in the note's band.

    The mean is None if there are no such samples.

    Raises:
        LogError: the notes or the recording are damaged.
    """
    from tuisim.analysis.source import NOTES_FILE, read_notes
    from tuisim.engine.runs.samples import list_samples

    notes = read_notes(folder / NOTES_FILE)
    if not notes:
        return
    samples = list_samples(load_run(folder).output.read_all_rows())
    for note in notes:
        values = [
            sample.value
            for sample in samples
            if note.start_s <= sample.time_s <= note.stop_s
            and sample.name == (note.variable or sample.name)
        ]
        yield Noted(note.text, sum(values) / len(values) if values else None)
