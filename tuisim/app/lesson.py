"""The app's side of lessons: opens one, tells the session what the student sees, and shows what follows."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.earlier_run import find_similar_run
from tuisim.app.panels import PANELS, PanelPlace
from tuisim.app.snapshot import RunPhase
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.engine.protocol import End, PauseReason
from tuisim.tasks.lessons.catalogue import find_lesson, find_lesson_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import prepare_program
from tuisim.tasks.lessons.session import Change, LessonSession, Sight
from tuisim.tasks.lessons.spec import SEEABLE, Lesson, LessonStep, QuestionCheck, ShowCheck

if TYPE_CHECKING:
    from tuisim.app.debugger import DebugController
    from tuisim.app.goals import GoalsController
    from tuisim.app.host import LabHost
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.panels.lesson import LessonPanel
    from tuisim.app.render.lesson import LessonView
    from tuisim.app.run_controller import RunController
    from tuisim.tasks.lessons.session import WorldJudgements, WorldTrial

_ROOMY_ROWS = 33
"""In an area with fewer rows than this, the text of a lesson takes the space of the instrumentation panel."""


class LessonController:
    """The lesson that is open in the app, if any: its progress, its panel, and a panel with its step beside a log.

    Args:
        app: Shows notices.
        run_controller: Has the run in view.
        panel_area: Has the lesson panel.
        goals: Judges the runs by the goals of the lesson.
        loader: Loads the lesson's world and the student's program.
        debugger: Knows where the program is paused, and which expressions are watched.
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
        self._app = app
        self._run_controller = run_controller
        self._panel_area = panel_area
        self._goals = goals
        self._loader = loader
        self._debugger = debugger
        self.session = LessonSession(lesson) if lesson is not None else None
        self.folder = folder
        self._beside: LessonPanel | None = None
        """The panel with the lesson beside an open log, on a screen above the app's; None without one."""

    @property
    def lesson(self) -> Lesson | None:
        """The lesson that is open; None if none is."""
        return self.session.lesson if self.session is not None else None

    @property
    def step(self) -> LessonStep | None:
        """The step that the student has to do; None if no lesson is open, or if all its steps are done or skipped."""
        return self.session.step if self.session is not None else None

    # Opening

    @property
    def step_actions(self) -> tuple[str, ...]:
        """Ids of the actions that help in the present step, the most useful first; empty without a lesson."""
        if self.lesson is None:
            return ()
        if (step := self.step) is None:
            return ("lesson-menu",)
        answer = ("answer",) if isinstance(step.check, QuestionCheck) else ()
        return (*answer, "hint", "lesson-menu")

    def begin(self) -> None:
        """Show the lesson with which the app was started, if there is one."""
        if self.session is not None:
            self._goals.judges_always = True
            self._enter(self.session)

    def open(self, name: str) -> None:
        """Open another lesson, given by its name; show an error if that fails."""
        try:
            lesson = load_lesson(find_lesson(name, self.folder))
            self._load(lesson)
        except TuisimError as error:
            self._app.complain(error)
            return
        self._enter(LessonSession(lesson))

    def _load(self, lesson: Lesson, anew: bool = False) -> None:
        path = prepare_program(lesson, anew)
        self._loader.open_task(str(path), lesson.settings, lesson.task)
        self._goals.judges_always = True
        # The last run belongs to another lesson.
        self._run_controller.close()
        self._run_controller.companion = None
        self._app.run_changed()

    def _enter(self, session: LessonSession) -> None:
        self.session = session
        try:
            session.resume()
        except ConfigError as error:
            self._app.complain(error)
        self._save(session)
        self._panel_area.request(self._choose_panels(session.lesson))
        if self._panel_area.world:
            # The world gets the focus: if the student has typed in the former program, the arrow keys would otherwise
            # move its cursor, not the robot.
            self._panel_area.world.focus()
        self._begin_step(session)
        runs = self._run_controller
        if runs.program is None or runs.in_run:
            return
        if run := find_similar_run(runs.program, runs.next_run.spec):
            session.begin_step(run.id)
            self._loader.open_run(run)

    def _choose_panels(self, lesson: Lesson) -> dict[str, bool | None]:
        """Return which panels a lesson shows (True), hides (False) or leaves to the size of the terminal (None).

        The lesson fills the side column; in a high area, the readings stay in that column, too.
        """
        beside = [info.id for info in PANELS.values() if info.place is PanelPlace.SIDE]
        usual: dict[str, None] = {}
        if self._panel_area.size.height >= _ROOMY_ROWS:
            beside.remove("instrumentation")
        elif not any(step.check == ShowCheck("chart") for step in lesson.steps):
            # A chart that another lesson has opened would take the place of the output, which this lesson needs.
            usual = dict.fromkeys(("output", "chart"))
        panels = dict.fromkeys((*lesson.settings.get("panels_on", ()), "code", "lesson"), True)
        return {**dict.fromkeys(beside, False), **usual, **panels}

    def _begin_step(self, session: LessonSession) -> None:
        recording = self._run_controller.timeline.recording
        session.begin_step(recording.run_id if recording else "")
        match session.step.check if session.step is not None else None:
            case ShowCheck(panel=panel):
                # The student has to open this panel. In a low terminal, the text needs the rows of panels that were
                # opened for earlier steps.
                is_low = self._panel_area.size.height < _ROOMY_ROWS
                former = session.lesson.steps[: session.at] if is_low else ()
                asked = [step.check.panel for step in former if isinstance(step.check, ShowCheck)]
                self._panel_area.request(dict.fromkeys((*asked, panel), False))
            case QuestionCheck(at_x_mm=(_, *_)):
                # The arrow keys are to move the robot, not the lines of the program.
                self._panel_area.leave_code()
        self.show()
        self._app.handle_situation_change()

    def list_lessons(self) -> list[Lesson]:
        """Return all lessons that can be read, in the order in which they are to be done."""
        lessons = []
        for path in find_lesson_paths(self.folder).values():
            try:
                lessons.append(load_lesson(path))
            except ConfigError as error:
                self._app.complain(error)
        return lessons

    @property
    def next_name(self) -> str:
        """The name of the lesson after the open one; empty if there is none."""
        names = list(find_lesson_paths(self.folder))
        if self.lesson is None or self.lesson.name not in names:
            return ""
        return next(iter(names[names.index(self.lesson.name) + 1 :]), "")

    def _find_next_title(self) -> str:
        try:
            return (
                load_lesson(find_lesson(self.next_name, self.folder)).title
                if self.next_name
                else ""
            )
        except ConfigError:
            # The menu of lessons reports a lesson that cannot be read.
            return ""

    # The following methods handle what the student does.

    def answer(self, text: str) -> None:
        """Check a typed answer to the question of the step.

        Raises:
            TuisimError: the answer is wrong.
        """
        if self.session is not None:
            change = Change.SHOW
            try:
                x_mm = self._run_controller.pose.x_mm
                change = self.session.answer(text, x_mm, self._look())
            except TuisimError as error:
                raise TuisimError(self._app.fill_keys(str(error))) from error
            finally:
                self._follow(change)

    def describe_missing_step(self) -> str:
        """Return in words why there is no step now, and which key helps."""
        return (
            "The lesson is done: {lesson-menu} opens another"
            if self.lesson
            else "No lesson is open: {lesson-menu} opens one"
        )

    def show_hint(self) -> None:
        """Show the next hint for the step of the lesson."""
        session = self.session
        step = self.step
        if session is None or step is None:
            self._app.say(self.describe_missing_step())
            return
        if session.hints < len(step.hints):
            session.show_hint()
            self._follow(Change.SHOW)
        else:
            self._app.say(
                "There are no more hints. {lesson-menu} skips the step"
                if session.hints
                else "This step has no hints"
            )

    def skip_step(self) -> None:
        """Go on to the next step; the present step stays undone."""
        if self.session is not None and (step := self.session.skip_step()):
            self._continue_session(self.session)
            self._app.say(f"Skipped: {step.title}. Start over to do it again")

    def restart_lesson(self) -> None:
        """Delete the progress of the lesson, and open the program with which the lesson begins.

        A copy of the student's program is stored.
        """
        session = self.session
        if session is None:
            return
        try:
            self._load(session.lesson, anew=True)
        except TuisimError as error:
            self._app.complain(error)
            return
        session.start_over()
        self._continue_session(session)

    def show_former_step(self) -> None:
        """Show the page of the previous step; from then on, the arrow keys turn the pages."""
        self._panel_area.request({"lesson": True})
        self._app.call_after_refresh(self._turn_back)

    def _turn_back(self) -> None:
        if panel := self._panel_area.lesson:
            panel.focus()
            panel.action_turn(-1)

    def note_export(self, path: Path) -> None:
        """Record that the student has exported the log to a file, which a step may require."""
        if self.session is not None:
            self._follow(self.session.take_export(path.name))

    def update(self) -> None:
        """Check whether the step is done by what the student has done so far; never blocks."""
        session = self.session
        if session is None or session.step is None:
            return
        change = Change.NONE
        try:
            change = session.look(self._look())
        except TuisimError as error:
            self._app.complain(error)
        # The words about a run that started elsewhere depend on whether it is over: show the lesson again.
        self._follow(Change.SHOW if change is Change.NONE and session.attempt.elsewhere else change)

    def _look(self) -> Sight:
        """Return the facts by which a step is checked: panels, the run in view, judgements, the debugger's state."""
        runs = self._run_controller
        view = self._debugger.view
        panels = {panel for panel in SEEABLE if self._panel_area.is_shown(panel)}
        if self._beside is not None:
            panels.add("analyser")
        recording = runs.timeline.recording
        tick = runs.timeline.at
        judged, judgements = self._goals.judged
        at_break = view is not None and not view.past and view.paused.reason is PauseReason.BREAK
        return Sight(
            panels=frozenset(panels),
            recording=recording,
            is_paused=runs.state is RunPhase.PAUSED,
            is_over=runs.state is RunPhase.ENDED,
            judged=judged,
            judgements=judgements,
            watches=tuple(watch.text for watch in view.inspected.watches if not watch.error)
            if view
            else (),
            break_met=view.paused.detail if view and at_break else None,
            past_s=tick / recording.spec.profile.tick_hz
            if recording and tick is not None
            else None,
        )

    def _follow(self, change: Change) -> None:
        """Do what the session of the lesson requires after an event.

        Args:
            change: What it requires. `GO_ON` begins the next step. `SHOW` saves the session and updates the panel.
                `TRY` also runs the program in other worlds, in the background.
        """
        session = self.session
        if session is None or change is Change.NONE:
            return
        if change is Change.GO_ON:
            self._continue_session(session)
            over = " · the lesson is done" if session.step is None else ""
            if session.done:
                self._app.say(f"✓ {session.done.title}{over}")
            return
        self._save(session)
        if change is Change.TRY and (trial := session.attempt.trial):
            then = partial(self._take_trial, session, trial)
            background.run(self._panel_area, trial.run, then, self._app.complain, group="lesson")
        self.show()

    def _take_trial(
        self, session: LessonSession, trial: WorldTrial, judged: WorldJudgements
    ) -> None:
        if self.session is session:
            self._follow(session.take_trial(trial, judged))

    def _continue_session(self, session: LessonSession) -> None:
        self._save(session)
        self._begin_step(session)

    def _save(self, session: LessonSession) -> None:
        try:
            session.save()
        except ConfigError as error:
            self._app.complain(error)

    def _find_error(self, session: LessonSession) -> str:
        """Return the error with which the judged run ended; empty if it ended without an error."""
        run, (recording, _) = self._run_controller.run, self._goals.judged
        if (
            not session.attempt.judgements
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

    # The panel

    def show(self) -> None:
        """Show the lesson in its panel."""
        for panel in (self._panel_area.lesson, self._beside):
            if panel is not None:
                panel.show_lesson(self.view())

    def build_log_panel(self) -> LessonPanel | None:
        """Return a panel with the step of the lesson, to be shown beside a log; None if no lesson is open."""
        if self.session is None:
            return None
        from tuisim.app.panels.lesson import LessonPanel

        self._beside = LessonPanel(is_brief=True)
        self._beside.border_title = PANELS["lesson"].title
        self._beside.show_lesson(self.view())
        return self._beside

    def log_closed(self) -> None:
        """Forget the panel with the step beside a log, because the log was closed."""
        self._beside = None

    def view(self) -> LessonView:
        """Return the content of the lesson panel."""
        from tuisim.app.render.lesson import LessonView

        session = self.session
        if session is None:
            return LessonView()
        runs = self._run_controller
        return LessonView(
            lesson=session.lesson,
            states=tuple(session.progress.of(step.name).state for step in session.lesson.steps),
            at=session.at,
            hints=session.hints,
            judgements=session.attempt.judgements,
            good_runs=session.good_runs,
            elsewhere=session.describe_elsewhere(runs.pose, in_run=runs.in_run),
            done=session.done,
            story=session.story if session.done else "",
            error=self._find_error(session),
            remark=session.attempt.remark,
            next_title="" if session.step else self._find_next_title(),
        )
