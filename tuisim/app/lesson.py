"""The app's side of lessons: opens one, sees what the student does, checks the step, and keeps the progress."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, assert_never

from tuisim.app import background
from tuisim.app.earlier_run import find_last_like
from tuisim.app.panels import PANELS, PanelPlace
from tuisim.app.snapshot import RunPhase
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.engine.core.spec import RunSpec, WorldSpec
from tuisim.engine.core.values import values_of
from tuisim.engine.protocol import End, PauseReason
from tuisim.engine.runs.store import load_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import settings_of
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.goals.spec import LogCondition, PrintCondition
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons import progress as stored
from tuisim.tasks.lessons.catalogue import find_lesson, lesson_paths
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
    good_runs,
    is_met,
    met_by,
    note_fault,
    unready,
    wanted_form,
)
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import LessonProgress, StepState
from tuisim.tasks.lessons.spec import (
    SEEABLE,
    BreakCheck,
    Check,
    ExportCheck,
    Lesson,
    LessonStep,
    NoteCheck,
    QuestionCheck,
    RunCheck,
    ShowCheck,
    VisitCheck,
    WatchCheck,
    list_place,
    list_world,
)
from tuisim.tasks.lessons.story import story

if TYPE_CHECKING:
    from tuisim.app.debugger import DebugController
    from tuisim.app.goals import GoalsController
    from tuisim.app.host import LabHost
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.panels.lesson import LessonPanel
    from tuisim.app.render.lesson import LessonView
    from tuisim.app.run_controller import RunController
    from tuisim.engine.runs.recorded_run import Recording

NOTES_PERIOD_S = 0.5
"""Least time between two looks at the notes of a run."""
_ROOMY_ROWS = 33
"""In a lower terminal the text of a lesson needs the space of the instrumentation panel."""


def goals_of(lesson: Lesson) -> GoalsFile:
    """Return the goals of a lesson for the goals panel."""
    return GoalsFile(lesson.path, lesson.title, lesson.goals, lesson.settings)


class LessonController:
    """The lesson that is open in the app, if any.

    Args:
        app: Shows notices.
        run_controller: Has the run in view.
        panel_area: Has the lesson panel.
        goals: Judges the runs by the goals of the lesson.
        loader: Loads the lesson's world and the student's program.
        debugger: Knows where the program is paused, and what is watched.
        lesson: The lesson that was opened at the start, if any; its world and program are loaded already.
        folder: The folder of own lessons, if one was named.
    """

    def __init__(
        self,
        app: LabHost,
        run_controller: RunController,
        panel_area: PanelArea,
        goals: GoalsController,
        loader: Loader,
        debugger: DebugController,
        lesson: Lesson | None,
        folder: str | None,
    ) -> None:
        self._app, self._run_controller, self._panel_area = app, run_controller, panel_area
        self._goals, self._loader, self._debugger = goals, loader, debugger
        self.lesson = lesson
        self.folder = folder
        self.progress = LessonProgress()
        self._at: int | None = None
        """Index of the step to do; None when none is open."""
        self._events: list[Event] = []
        """What the student has done since the step began."""
        self._before = ""
        """Id of the run that was in view when the step began, which does not count."""
        self.judgements: tuple[Judgement, ...] = ()
        self._done: LessonStep | None = None
        """The step that has just been done."""
        self._elsewhere: RunSpec | None = None
        """What a run was that did not begin in the lesson's world; None if the last one did."""
        self._counted = ""
        """Id of the last run that was counted as a try."""
        self._next_look_s = 0.0
        self._seen: set[str] = set()
        """What of `SEEABLE` was on the screen since the step began."""
        self._remark = ""
        """Why the last note, or the last program in another world, does not pass."""
        self._story = ""
        """What the run that has just passed a step did."""
        self._tried = ""
        """Id of the run whose program was last tried in other worlds."""
        self._beside: LessonPanel | None = None
        """The panel beside a log that is open above the app."""

    # Opening

    def begin(self) -> None:
        """Begin with the lesson that was opened at the start."""
        if self.lesson is not None:
            self._goals.judges_always = True
            self._enter(self.lesson)

    def open(self, name: str) -> None:
        """Open another lesson, given by name; errors are shown."""
        try:
            lesson = load_lesson(find_lesson(name, self.folder))
            self._load(lesson)
        except TuisimError as error:
            self._app.complain(error)
            return
        self._enter(lesson)

    def _load(self, lesson: Lesson, anew: bool = False) -> None:
        path = stored.prepare_program(lesson, anew)
        self._loader.open_task(str(path), lesson.settings, goals_of(lesson))
        self._goals.judges_always = True
        # What the last run has shown belongs to another lesson.
        self._run_controller.close()
        self._run_controller.companion = None
        self._app.run_changed()

    def _enter(self, lesson: Lesson) -> None:
        self.lesson = lesson
        try:
            self.progress = stored.load_progress().get(lesson.name, LessonProgress())
        except ConfigError as error:
            self.progress = LessonProgress()
            self._app.complain(error)
        self._keep(replace(self.progress, opened_at=stored.now()))
        self._panel_area.request(self._panels_for(lesson))
        if self._panel_area.world:
            # After typing in the program before, the arrow keys would still move in it, and not the robot.
            self._panel_area.world.focus()
        self._done = None
        self._begin_step()
        runs = self._run_controller
        if runs.program is None or runs.in_run:
            return
        if run := find_last_like(runs.program, runs.next_run.spec):
            self._before = run.id
            self._loader.open_run(run)

    def _panels_for(self, lesson: Lesson) -> dict[str, bool | None]:
        """Return which panels to show and hide: the text gets the side column, but for readings where there is room."""
        beside = [info.id for info in PANELS.values() if info.place is PanelPlace.SIDE]
        usual: dict[str, None] = {}
        if self._panel_area.size.height >= _ROOMY_ROWS:
            beside.remove("instrumentation")
        elif not any(step.check == ShowCheck("chart") for step in lesson.steps):
            # A chart that was opened in another lesson would be in the place of the output that this one speaks of.
            usual = dict.fromkeys(("output", "chart"))
        asked = dict.fromkeys((*lesson.settings.get("panels_on", ()), "code", "lesson"), True)
        return {**dict.fromkeys(beside, False), **usual, **asked}

    def _begin_step(self) -> None:
        assert self.lesson is not None
        self._at = self.progress.current(self.lesson)
        self._events, self.judgements, self._elsewhere = [], (), None
        self._seen, self._remark = set(), ""
        recording = self._run_controller.timeline.recording
        self._before = recording.run_id if recording else ""
        match self.step.check if self.step is not None else None:
            case ShowCheck(panel=panel):
                # The student is to open it.
                self._panel_area.request({panel: False})
            case QuestionCheck(at_x_mm=(_, *_)):
                # The arrow keys are to move the robot, not the lines of the program.
                self._panel_area.leave_code()
        self.show()
        self._app.situation_changed()

    @property
    def step(self) -> LessonStep | None:
        """The step to do; None if no lesson is open, or all of its steps are done or skipped."""
        return (
            self.lesson.steps[self._at]
            if self.lesson is not None and self._at is not None
            else None
        )

    def lessons(self) -> list[Lesson]:
        """Return all lessons that can be read, in their order."""
        found = []
        for path in lesson_paths(self.folder).values():
            try:
                found.append(load_lesson(path))
            except ConfigError as error:
                self._app.complain(error)
        return found

    @property
    def next_name(self) -> str:
        """The name of the lesson after this one; empty if there is none."""
        names = list(lesson_paths(self.folder))
        if self.lesson is None or self.lesson.name not in names:
            return ""
        return next(iter(names[names.index(self.lesson.name) + 1 :]), "")

    def _next_title(self) -> str:
        try:
            return (
                load_lesson(find_lesson(self.next_name, self.folder)).title
                if self.next_name
                else ""
            )
        except ConfigError:
            # The menu reports it.
            return ""

    # What the student asks for

    def answer(self, text: str) -> None:
        """Check a typed answer.

        Raises:
            TuisimError: it is wrong.
        """
        step = self.step
        if step is None or not isinstance(step.check, QuestionCheck):
            return
        check = step.check
        if not text:
            raise TuisimError("Type an answer")
        if wanted := wanted_form(check, text):
            raise TuisimError(f"{text}: type {wanted}")
        typed = self._typed(check, text)
        # What is measured elsewhere is not wrong, it is about something else.
        if first := unready(check, typed):
            raise TuisimError(first)
        if not self._take(typed):
            self._keep(
                self.progress.with_step(step.name, tries=self.progress.of(step.name).tries + 1)
            )
            self.show()
            left = len(step.hints) - self.progress.of(step.name).hints
            raise TuisimError(
                f"{text} is not right. Try again{': escape, then Y shows a hint' if left > 0 else ''}"
            )

    def _typed(self, check: QuestionCheck, text: str) -> Typed:
        """Return an answer with what has happened before it."""
        self._look()
        recording = self._run_controller.timeline.recording
        # A run may have printed millions of lines, which most questions are not about.
        printed: tuple[str, ...] = ()
        if recording is not None and check.printed:
            printed = tuple(row.text for row in load_run(recording.folder).output.all_rows())
        return Typed(
            text,
            self._run_controller.pose.x_mm,
            frozenset(self._seen),
            printed,
            recording is not None,
        )

    def _look(self) -> None:
        """Note what is on the screen."""
        self._seen |= {panel for panel in SEEABLE if self._panel_area.shown(panel)}
        if self._beside is not None:
            self._seen.add("analyser")

    def hint(self) -> None:
        """Show the next hint of the step."""
        step = self.step
        if step is None:
            return
        shown = self.progress.of(step.name).hints
        if shown >= len(step.hints):
            self._app.say(
                "There are no more hints. M skips the step" if shown else "This step has no hints"
            )
            return
        self._keep(self.progress.with_step(step.name, hints=shown + 1))
        self.show()

    def skip_step(self) -> None:
        """Leave the step undone and go on to the next."""
        if step := self.step:
            self._leave_step(step, StepState.SKIPPED)
            self._app.say(f"Skipped: {step.title}. Start over to do it again")

    def start_over(self) -> None:
        """Forget the progress on the lesson, and begin with its program again; the student's program is kept aside."""
        if self.lesson is None:
            return
        try:
            self._load(self.lesson, anew=True)
        except TuisimError as error:
            self._app.complain(error)
            return
        self._keep(LessonProgress(opened_at=stored.now()))
        self._done = None
        self._begin_step()

    @property
    def step_before(self) -> LessonStep | None:
        """The step before the one to do, or the last one at the end of the lesson."""
        at = len(self.lesson.steps) if self.lesson is not None and self._at is None else self._at
        return self.lesson.steps[at - 1] if self.lesson is not None and at else None

    def show_step_before(self) -> None:
        """Turn back to the step before, and let the arrow keys turn the pages."""
        self._panel_area.request({"lesson": True})
        self._app.call_after_refresh(self._turn_back)

    def _turn_back(self) -> None:
        if panel := self._panel_area.lesson:
            panel.focus()
            panel.action_turn(-1)

    def exported(self, path: Path) -> None:
        """Note that the log was exported to a file."""
        self._take(Exported(path.name))

    # What the student does

    def update(self) -> None:
        """Check the step by what has happened; never blocks."""
        if self.step is not None:
            self._look()
            try:
                for event in self._observed(self.step):
                    if self._take(event):
                        break
            except TuisimError as error:
                self._next_look_s = time.monotonic() + 10
                self._app.complain(error)
            if self._elsewhere:
                # What a run from elsewhere needs depends on whether it is over.
                self.show()

    def _observed(self, step: LessonStep) -> Iterator[Event]:
        match step.check:
            case RunCheck():
                yield from self._judged_run(step)
            case WatchCheck():
                if self._debugger.view is not None:
                    watches = self._debugger.view.inspected.watches
                    yield from (
                        ExpressionWatched(watch.text) for watch in watches if not watch.error
                    )
            case BreakCheck():
                view = self._debugger.view
                if view is not None and not view.past and view.paused.reason is PauseReason.BREAK:
                    yield BreakMet(view.paused.detail)
            case VisitCheck():
                timeline = self._run_controller.timeline
                if timeline.at is not None and timeline.recording is not None:
                    yield Visited(timeline.at / timeline.recording.spec.profile.tick_hz)
            case ShowCheck(panel=panel):
                if self._panel_area.shown(panel):
                    yield Shown(panel, self._run_controller.state is RunPhase.PAUSED)
            case NoteCheck():
                yield from self._notes(step.check)
            case QuestionCheck() | ExportCheck():
                # The student's keys tell.
                pass
            case _:
                assert_never(step.check)

    def _judged_run(self, step: LessonStep) -> Iterator[Event]:
        recording, judgements = self._goals.judged
        if recording is None or recording.run_id == self._before or judgements is self.judgements:
            return
        self.judgements = judgements
        met = frozenset(each.goal.name for each in judgements if each.state is GoalState.MET)
        is_from_start = list_world(self._wanted_spec()) == list_world(recording.spec)
        self._elsewhere = None if is_from_start else recording.spec
        yield JudgedRun(recording.run_id, recording.spec.seed, met, is_from_start)
        if self.step is step:
            self._count_try(step, recording, judgements)
            self._try_elsewhere(step.check, recording)
            self.show()

    def _error(self) -> str:
        """Return how the run has failed that the goals were judged on; empty if it has not."""
        run, (recording, _) = self._run_controller.run, self._goals.judged
        if (
            not self.judgements
            or run is None
            or recording is None
            or run.run_id != recording.run_id
        ):
            return ""
        return (
            run.ended.summary.rstrip(".")
            if run.ended is not None and run.ended.end is End.RAISED
            else ""
        )

    def _try_elsewhere(self, check: Check, recording: Recording) -> None:
        """Try the program of a good run in the other worlds of the step, in the background."""
        assert isinstance(check, RunCheck)
        lesson, run_id = self.lesson, recording.run_id
        is_good = any(run.run_id == run_id for run in met_by(check, self._events))
        is_over = self._run_controller.state is RunPhase.ENDED
        if lesson is None or not (is_good and is_over and check.also) or self._tried == run_id:
            return
        self._tried, self._remark = (
            run_id,
            f"Your program is now also tried {check.also[0].where} …",
        )

        def work() -> list[tuple[TrialWorld, tuple[Judgement, ...]]]:
            from tuisim.tasks.lessons.trial import tried_elsewhere

            return tried_elsewhere(lesson, check, load_run(recording.folder))

        then = partial(self._tried_elsewhere, check, run_id)
        background.run(self._panel_area, work, then, self._app.complain, group="lesson")

    def _tried_elsewhere(
        self, check: RunCheck, run_id: str, found: list[tuple[TrialWorld, tuple[Judgement, ...]]]
    ) -> None:
        """Take in how the program did in other worlds, unless the student has gone on meanwhile."""
        if self.step is None or self.step.check is not check:
            return
        # The student may have begun another run meanwhile: this one counts, but what is told is about that one.
        is_newest, remark = self._tried == run_id, ""
        for other, judgements in found:
            met = frozenset(each.goal.name for each in judgements if each.state is GoalState.MET)
            if self._take(TriedElsewhere(run_id, other.where, met)):
                return
            missed = [
                each
                for each in judgements
                if each.goal.name in other.goals and each.goal.name not in met
            ]
            if missed and not remark:
                remark = f"Also tried {other.where}, it does not work{_at_start(other)}: {_why_elsewhere(missed[0])}"
        if is_newest:
            self._remark = remark
        self.show()

    def _count_try(
        self, step: LessonStep, recording: Recording, judgements: tuple[Judgement, ...]
    ) -> None:
        """Count a run that has ended without passing as a try."""
        assert isinstance(step.check, RunCheck)
        states = [each.state for each in judgements if each.goal.name in step.check.goals]
        is_over = self._run_controller.state is RunPhase.ENDED and GoalState.OPEN not in states
        if is_over and GoalState.MISSED in states and self._counted != recording.run_id:
            self._counted = recording.run_id
            self._keep(
                self.progress.with_step(step.name, tries=self.progress.of(step.name).tries + 1)
            )

    def _wanted_spec(self) -> RunSpec:
        assert self.lesson is not None
        return build_run_spec(settings_of(self.lesson.settings))

    def _elsewhere_words(self) -> str:
        """Return why the last run does not count, in a sentence, and what to do; empty if it does."""
        if self._elsewhere is None:
            return ""
        wanted = self._wanted_spec().world
        if list_place(self._elsewhere.world) == list_place(wanted):
            noise, drift = wanted.noise, values_of(WorldSpec)["drift"].to_text(wanted.drift)
            levels = f"light {noise.light}, motors {noise.motor} (panel Noise, z), drift {drift} (panel Settings, Z)"
            return f"This run had other noise or drift: the lesson's is {levels}."
        if self._run_controller.in_run:
            return "This run began elsewhere."
        if self._run_controller.pose == wanted.start:
            return "This run began elsewhere. The robot is back at its start: R runs the program."
        return "This run began elsewhere: m moves the robot to its start, then R."

    def _notes(self, check: NoteCheck) -> Iterator[Event]:
        recording = self._run_controller.timeline.recording
        if recording is None or time.monotonic() < self._next_look_s:
            return
        self._next_look_s = time.monotonic() + NOTES_PERIOD_S
        notes = list(noted(recording.folder))
        yield from notes
        remark = (
            note_fault(check, notes[-1]) if notes and self.step and self.step.check is check else ""
        )
        if remark != self._remark:
            self._remark = remark
            self.show()

    def _take(self, event: Event) -> bool:
        """Add what has happened. Return whether the step is done now."""
        step = self.step
        if step is None or event in self._events:
            return False
        if isinstance(event, JudgedRun):
            self._events = [one for one in self._events if not _is_of(one, event.run_id)]
        self._events.append(event)
        if not is_met(step.check, self._events):
            return False
        self._leave_step(step, StepState.DONE)
        over = self.step is None
        self._app.say(f"✓ {step.title}" + (" · the lesson is done" if over else ""))
        return True

    def _leave_step(self, step: LessonStep, state: StepState) -> None:
        goals = step.check.goals if isinstance(step.check, RunCheck) else ()
        self._story = story(each for each in self.judgements if each.goal.name in goals)
        self._keep(self.progress.with_step(step.name, state=state, at=stored.now()))
        self._done = step if state is StepState.DONE else None
        self._begin_step()

    def _keep(self, progress: LessonProgress) -> None:
        self.progress = progress
        if self.lesson is not None:
            try:
                stored.save_progress(self.lesson.name, progress)
            except ConfigError as error:
                self._app.complain(error)

    # The panel

    def show(self) -> None:
        """Update the panel, which may have just been mounted."""
        for panel in (self._panel_area.lesson, self._beside):
            if panel is not None:
                panel.show_lesson(self.view())

    def beside_log(self) -> LessonPanel | None:
        """Return a panel with the step for a log that is opened above the app; None if no lesson is open."""
        if self.lesson is None:
            return None
        from tuisim.app.panels.lesson import LessonPanel

        self._beside = LessonPanel(is_brief=True)
        self._beside.border_title = PANELS["lesson"].title
        self._beside.show_lesson(self.view())
        return self._beside

    def log_closed(self) -> None:
        """Forget the panel beside the log, which has been closed."""
        self._beside = None

    def view(self) -> LessonView:
        """Return the content of the panel."""
        from tuisim.app.render.lesson import LessonView

        if self.lesson is None:
            return LessonView()
        step = self.step
        good = (
            good_runs(step.check, self._events) if step and isinstance(step.check, RunCheck) else 0
        )
        return LessonView(
            lesson=self.lesson,
            states=tuple(self.progress.of(each.name).state for each in self.lesson.steps),
            at=self._at,
            hints=self.progress.of(step.name).hints if step else 0,
            judgements=self.judgements,
            good_runs=good,
            elsewhere=self._elsewhere_words(),
            done=self._done,
            story=self._story if self._done else "",
            error=self._error(),
            remark=self._remark,
            next_title="" if step else self._next_title(),
        )


def _is_of(event: Event, run_id: str) -> bool:
    return isinstance(event, JudgedRun) and event.run_id == run_id


def _why_elsewhere(missed: Judgement) -> str:
    """Return why a goal is missed in another world, without the numbers and words that are asked for there."""
    if any(isinstance(part, LogCondition | PrintCondition) for part in missed.goal.parts):
        return "what it prints is not what the robot sees there, at the places where it sees it."
    return missed.reason


def _at_start(other: TrialWorld) -> str:
    """Return where the robot starts in another world, for a sentence; empty if it is where the lesson starts."""
    found = {axis: other.settings.get(f"start.{axis}_mm") for axis in "xy"}
    places = [f"{axis} = {value:g} mm" for axis, value in found.items() if value is not None]
    return f" (start {', '.join(places)})" if places else ""


def noted(folder: Path) -> Iterator[Noted]:
    """Yield the notes on a run, each with the mean of the samples that it is about.

    Raises:
        LogError: the notes or the recording are damaged.
    """
    from tuisim.analysis.source import NOTES_FILE, read_notes
    from tuisim.engine.runs.samples import samples_of

    notes = read_notes(folder / NOTES_FILE)
    if not notes:
        return
    samples = samples_of(load_run(folder).output.all_rows())
    for note in notes:
        values = [
            one.value
            for one in samples
            if note.start_s <= one.time_s <= note.stop_s and one.name == (note.variable or one.name)
        ]
        yield Noted(note.text, sum(values) / len(values) if values else None)
