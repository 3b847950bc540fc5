"""The app of the lab, which connects panels, keys and one run at a time."""

from __future__ import annotations

import time
from dataclasses import field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.driver import Driver
from textual.timer import Timer
from textual.widgets import Input

from tuisim.app import reasons
from tuisim.app.action import (
    CLICKED_KEYS,
    FIELD_KEYS,
    TYPING_KEYS,
    KeyFooter,
    KeyWord,
    build_bindings,
    find_panel_keys,
)
from tuisim.app.actions import ActionContext, time_travel
from tuisim.app.actions.files import greet
from tuisim.app.actions.keys import (
    ACTIONS,
    PAGES,
    RUN_KEYS,
    TEXT_KEYS,
    list_footer_actions,
    list_working,
)
from tuisim.app.actions.lesson import accept_page_keys, has_more_text
from tuisim.app.background import enter, leave
from tuisim.app.branch import build_branch_message
from tuisim.app.debugger import DebugController
from tuisim.app.editor.document import Document
from tuisim.app.error_words import find_remedy
from tuisim.app.feed import PanelFeed
from tuisim.app.file_watch import PERIOD_S
from tuisim.app.goals import GoalsController
from tuisim.app.keymap import apply_keys, check_theme
from tuisim.app.lesson import LessonController
from tuisim.app.loader import Loader
from tuisim.app.notebook_cells import do_asked
from tuisim.app.panel_area import PanelArea
from tuisim.app.panel_messages import PanelMessages, has_button_calls
from tuisim.app.run_controller import ROWS_A_POLL, RunController
from tuisim.app.run_update import RunUpdate
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.mat import PATIENCE_S
from tuisim.app.snapshot import (
    AT_REST,
    GOOD_ENDS,
    AppState,
    RunPhase,
    Situation,
    Snapshot,
    end_words,
)
from tuisim.app.speech import Voice
from tuisim.app.terminal_app import picture_mode_at_start
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import Answer, Ended
from tuisim.engine.runs.child.process import start_warm_process
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.programs.program_settings import Decided
from tuisim.settings.options import DEFAULT_FPS, Settings
from tuisim.settings.user_config import FILE, UserConfig
from tuisim.terminal.pacer import PAGE_QUEUED_S, Pacer
from tuisim.terminal.picture_mode import PictureMode
from tuisim.terminal.picture_options import AUTO
from tuisim.terminal.probe import is_in_browser
from tuisim.terminal.textual_internals import is_leaving

if TYPE_CHECKING:
    from tuisim.app.panels.output import Output
    from tuisim.tasks.goals.files import GoalsFile
    from tuisim.tasks.lessons.spec import Lesson
    from tuisim.terminal.app import ServerAsks
    from tuisim.terminal.pixels import Pixels

FIRST_PAINT_DELAY_S = 0.05
"""Seconds after the start until large data, such as the mat, is drawn: before, the screen is painted repeatedly."""
MAX_PROBLEMS = 3
"""Maximum number of errors in `config.toml` that the app shows; further ones are not shown."""
_CURSOR_QUERY = "\x1b[6n"
_REST_GAP_S = 0.25
"""Seconds between two polls of the run while no frames are drawn, because nothing happens."""
_WARM_UP_AFTER_S = 0.3
"""Seconds after a start until the process that forks runs is started: the first frame needs the processor."""
_STARTING_S = 0.25
_START_GAP_S = 0.004
"""Seconds between two polls of a starting run, for at most `_STARTING_S`, so that its first tick is drawn without a
delay."""
_AWAKE_S = 1.0
"""Seconds for which a run that goes on is polled at the full frame rate after something has happened."""
_SETTLE_S = 0.1
"""The same if no run goes on: after this time, the screen shows all that the user has changed."""


@dataclass(frozen=True, slots=True)
class AppSettings:
    """Everything that the command line decides about the app."""

    spec: RunSpec
    settings: Settings | None = None
    """The options that `spec` was built from; None if they are not known."""
    world_file: Path | None = None
    """The world file that was opened; the app watches it, and saves to it. None without one."""
    program: Program | None = None
    """The program to open; None to open no program."""
    goals: GoalsFile | None = None
    """The goals that runs are judged by; None without goals."""
    lesson: Lesson | None = None
    """The lesson to open; None without one. `program`, `settings` and `goals` are then those of the lesson."""
    lessons_folder: str | None = None
    """Folder of own lessons that the user has named; None if the user has named none."""
    welcomes: bool = False
    """Whether to show the welcome (only at the first start, or if there is recent work): nothing was named to open."""
    replay: StoredRun | None = None
    """A stored run to show; None for none. `spec` and `program` are then those of the stored run."""
    panels_on: frozenset[str] = field(default_factory=frozenset)
    """Ids of the panels that options, a lesson or goals show, whatever the size of the terminal."""
    panels_off: frozenset[str] = field(default_factory=frozenset)
    """Ids of the panels that options hide, whatever the size of the terminal."""
    autorun: bool = False
    """Whether to run the program as soon as the mat is ready."""
    quiet: bool = False
    """Whether never to play sounds or speech."""
    rays: bool = False
    """Whether to draw the ultrasonic rays."""
    speed: float = 1.0
    """Speed of runs: 1.0 is real time, 0 as fast as possible."""
    fps: int = DEFAULT_FPS
    """Maximum number of frames per second."""
    colors: str = "auto"
    """Colour depth, one of `COLOR_DEPTHS`; it must be set before the terminal is opened."""
    cells: str | None = None
    """Set of glyphs, one of `CELLS`; None for the user's earlier choice, else the best one."""
    pixels: str = AUTO
    """Whether pictures have pixels, one of `PIXELS`."""
    from_config: tuple[str, ...] = ()
    """The settings of the run that come from `config.toml`, each in words."""
    decided: Decided = field(default_factory=Decided)
    """The settings of the run that the text of the program decides."""


class LabApp(PanelMessages):
    """The app with the robot lab: panels, keys, and one run at a time.

    Args:
        settings: What the command line decided.
        picture_mode: How pictures are drawn.
    """

    CSS_PATH = "tuisim.tcss"
    ACTIONS = ACTIONS
    BINDINGS: ClassVar[list[BindingType]] = [
        *build_bindings(ACTIONS.values()),
        ("escape", "leave_field", "Leave a field"),
    ]

    def __init__(self, settings: AppSettings, picture_mode: PictureMode | None = None) -> None:
        super().__init__(picture_mode)
        self.settings = settings
        self._config_problems = self._take_config(UserConfig.load())
        self.pixels = settings.pixels
        first = plans.build_first_plan(
            settings.spec, settings.settings, settings.decided, settings.program
        )
        self.run_controller = RunController(settings.program, first, settings.speed)
        self.panel_area = PanelArea(settings.panels_on, settings.panels_off)
        self.key_footer = KeyFooter()
        self.pacer = Pacer(settings.fps, most_queued_s=PAGE_QUEUED_S if is_in_browser() else None)
        self.picture_mode.is_slow, self.picture_mode.is_idle = (
            lambda: self.pacer.is_slow,
            lambda: self.pacer.is_idle,
        )
        self.voice = Voice(settings.quiet)
        self.feed = PanelFeed(self.panel_area, self.run_controller)
        self._drawn: tuple[Any, ...] = ((None,),)
        self._footed: tuple[Any, ...] = ()
        """The part of the app's state from which the footer was last drawn."""
        runs = self.run_controller
        panels = self.panel_area
        self.goals = GoalsController(self, runs, panels, settings.goals)
        self.loader = Loader(self, runs, panels, self.goals, settings.world_file)
        self.document = Document(self, runs, panels, self.loader)
        self.debugger = DebugController(self, runs, panels, self.document.lines)
        of_lesson = self.goals, self.loader, self.debugger, settings.lesson, settings.lessons_folder
        self.lesson = LessonController(self, runs, panels, *of_lesson)
        self.context = ActionContext(
            self, runs, panels, self.document, self.loader, self.debugger, self.lesson
        )
        runs.propose = partial(time_travel.propose_action, self.context)
        self._run_when_ready = settings.autorun and settings.replay is None
        self._frame_timer: Timer | None = None
        self._awake_until_s = 0.0
        self._starting_until_s = 0.0
        """While a run starts, the monotonic time until which its first tick is awaited; else 0."""
        self._last_words = ""
        """How the run ended, in words; the output panel adds them after its last row. Empty once they are added."""

    def _take_config(self, config: UserConfig) -> tuple[ConfigError, ...]:
        """Bind the keys in the user's settings; return the errors in these settings."""
        problems = [*config.problems]
        try:
            self.take_keys(apply_keys(ACTIONS, config))
        except ConfigError as error:
            problems.append(error)
        try:
            check_theme(config)
        except ConfigError as error:
            problems.append(error)
        return tuple(problems)

    def complain(self, error: TuisimError) -> None:
        """Show an error in the app; if a cell of a notebook controls the app, also show it below that cell."""
        self.tell_server("problem", text=str(error))
        super().complain(error)

    def _tell_config(self) -> None:
        """Show the errors in `config.toml`; say which settings come from this file or from the program's text."""
        for error in self._config_problems[:MAX_PROBLEMS]:
            self.complain(error)
        if self.settings.from_config:
            self.say(f"From {FILE}: {', '.join(self.settings.from_config)}")
        self.loader.tell(self.settings.decided)

    # Lifecycle

    def compose(self) -> ComposeResult:
        yield self.panel_area
        yield self.key_footer

    def on_ready(self) -> None:
        if self.is_headless:
            self.pacer.asks = False
        self.notices.leave_rows = self.panel_area.leave_rows
        self.handle_situation_change()
        self.set_timer(FIRST_PAINT_DELAY_S, self._begin)

    def _begin(self) -> None:
        if is_leaving(self):
            return
        self.panel_area.ensure("world", "output", "chart")
        if self.settings.replay:
            self.loader.open_run(self.settings.replay)
        else:
            self.loader.prepare_mat()
            self.loader.begin()
        self.document.begin(asks=not self.settings.welcomes)
        # Breakpoints apply, and are saved, whether or not a panel shows the program.
        self.debugger.load_breaks(self.run_controller.program)
        self.lesson.begin()
        self._tell_config()
        if self.settings.welcomes:
            greet(self.context)
        self._set_frame_gap(1 / self.settings.fps)
        self.set_interval(_REST_GAP_S, self._run_seldom)
        self.set_interval(PERIOD_S, self.check_files)
        self.set_timer(_WARM_UP_AFTER_S, start_warm_process)
        self.tell_server("ready", program=self._program_name)

    @property
    def _program_name(self) -> str:
        program = self.run_controller.program
        return program.name if program else ""

    def check_files(self) -> None:
        """Reload files that have changed on disk; if one has unsaved edits in the app, ask which version to keep."""
        self.loader.check_files(self.document.check_conflict)

    def go_to_now(self) -> None:
        """Return from the past to the newest instant."""
        time_travel.go_to_now(self.context)

    def _waits(self, event: events.Event) -> bool:
        """Return whether an event must wait until the app can handle it.

        A key that needs a run, for example, waits until the mat is prepared.
        """
        if self.settings.welcomes and not self.has_greeted:
            return True
        needs_mat = getattr(event, "key", "") in RUN_KEYS and len(self.screen_stack) == 1
        return super()._waits(event) or (
            needs_mat and self.loader.is_preparing and not self.is_typed_into
        )

    def prepare_suspension(self) -> None:
        """Pause the run and playback before the app is suspended, so that nothing resumes by itself."""
        time_travel.stop_time(self.context)

    def on_unmount(self) -> None:
        self.document.save_draft()
        self.debugger.close()
        self.run_controller.close()
        self.voice.stop()

    # The world

    def show_mat(self, pixels: Pixels | None) -> None:
        """Show the image of the prepared mat; then start the run that was waiting for the mat, if any.

        Args:
            pixels: The image; None if the world panel shows it already.
        """
        if pixels is not None and (world := self.panel_area.world):
            world.set_mat(pixels)
        self.draw(force=True)
        if self._run_when_ready:
            self._run_when_ready = False
            if self.run_controller.program:
                self.start_run()

    def show_next_run(self) -> None:
        """Show the changed plan of the next run in the panels."""
        self._show_program()
        self.panel_area.show_next_run(self.run_controller.next_run)
        self.draw(force=True)

    # The following methods start runs, and process what a run sends.

    def start_run(self, paused: bool = False) -> bool:
        """Start the program; if the mat is not prepared yet, start it when the mat is.

        Return whether it has started now.

        Args:
            paused: Whether the program pauses at its first line.
        """
        if not self.loader.mat_is_ready:
            self._run_when_ready = not paused
            self.loader.prepare_mat_again()
            self.set_timer(PATIENCE_S, self.loader.tell_waiting)
            return False
        if not self.document.apply():
            return False
        if self.lesson.lesson:
            self.document.save_own()
        try:
            self.run_controller.start(self.debugger.texts, paused)
        except TuisimError as error:
            self.complain(error)
            return False
        self.tell_server("run", id=self.run_controller.run_id, program=self._program_name)
        self._starting_until_s = time.monotonic() + _STARTING_S
        self._set_frame_gap(_START_GAP_S)
        self.set_timer(_WARM_UP_AFTER_S, self.run_controller.prepare_next)
        self.run_changed()
        if self.run_controller.program and has_button_calls(self.run_controller.program.text):
            self.suggest_brick("reads the brick's buttons")
        return True

    def run_changed(self, last_words: str = "", error_line: int = 0) -> None:
        """Prepare the panels for another run.

        Args:
            last_words: How the run ended, if it has ended already; shown below the output of the run.
            error_line: The line at which the run ended with an error, 0 for none.
        """
        self.undo = None
        self._last_words = last_words
        self.feed.run_changed()
        self.panel_area.release_buttons()
        self.document.run_changed()
        self.document.mark_failure(error_line)
        self.debugger.run_changed()
        self.handle_situation_change()

    def _on_frame_timer(self) -> None:
        """Process what the run has sent, and draw a frame if the terminal has shown the previous frame."""
        try:
            news = self.run_controller.poll()
            self._process(news)
            if self.run_controller.timeline.playing:
                time_travel.advance_playback(self.context)
            if (
                self.debugger.view is not None
                or self.debugger.replay.run is not None
                or self.debugger.looks_back
            ):
                self.debugger.poll()
            if self.goals.file is not None:
                self.goals.update()
            if self.lesson.lesson is not None:
                self.lesson.update()
            # A frame that has to wait counts as drawn, so that the timer keeps the rate of frames.
            drew = self._is_starting() or not self.pacer.ready() or self.draw()
            if drew or news or self.debugger.busy:
                self._wake()
        except TuisimError as error:
            # A run that cannot be read now cannot be read at the next frame either, so it is closed.
            self.run_controller.close()
            self.complain(error)
            self.handle_situation_change()
        if self._frame_timer is not None and not self._is_awake:
            self._frame_timer.pause()

    def _set_frame_gap(self, gap_s: float) -> None:
        """From now on, poll the run and draw a frame every `gap_s` seconds."""
        if self._frame_timer is not None:
            self._frame_timer.stop()
        self._frame_timer = self.set_interval(gap_s, self._on_frame_timer)

    def _is_starting(self) -> bool:
        """Return whether the run is starting; once it has started, set the usual frame rate again.

        A frame that is drawn while the run starts would delay the frame with the first tick.
        """
        if not self._starting_until_s:
            return False
        runs = self.run_controller
        recording = self.run_controller.timeline.recording
        ticked = recording is not None and recording.telemetry.count > 1
        goes_on = runs.state in (RunPhase.STARTING, RunPhase.RUNNING)
        if goes_on and not ticked and time.monotonic() < self._starting_until_s:
            return True
        self._starting_until_s = 0.0
        self._set_frame_gap(1 / self.settings.fps)
        return False

    def _run_seldom(self) -> None:
        # While frames are drawn, an extra call between two of them would leave no time for the next one.
        if not self._is_awake:
            self._on_frame_timer()
        reasons.look(self.context)

    @property
    def _is_awake(self) -> bool:
        return time.monotonic() < self._awake_until_s

    def _wake(self) -> None:
        """Poll the run at the full frame rate for a time, since something has happened."""
        runs = self.run_controller
        goes_on = runs.in_run or runs.timeline.playing
        self._awake_until_s = time.monotonic() + (_AWAKE_S if goes_on else _SETTLE_S)
        if self._frame_timer:
            self._frame_timer.resume()

    async def on_event(self, event: events.Event) -> None:
        if isinstance(event, events.InputEvent):
            self._wake()
        await super().on_event(event)

    def _process(self, news: RunUpdate) -> None:
        for sound in news.spoken:
            self.voice.play(sound)
        for event in news.pauses:
            self.debugger.handle(event)
        if news.rows:
            self.feed.add_rows(news.rows)
        if not self.has_hinted and any(
            row.stream in (Stream.DISPLAY, Stream.CONSOLE) for row in news.rows
        ):
            self.suggest_brick("uses the brick's display")
        if output := self.panel_area.output:
            for remark in news.remarks:
                output.note(self.fill_keys(remark))
            if news.prompt is not None and not output.asking:
                self._ask_user(news.prompt)
            elif news.prompt is None and output.asking:
                output.stop_asking()
        if news.branched and (recording := self.run_controller.timeline.recording):
            self.say(build_branch_message(news.branched, recording))
            self.handle_situation_change()
        if news.ended:
            self._handle_end(news.ended, news.stood)
        if self._last_words and len(news.rows) < ROWS_A_POLL and self.panel_area.output:
            self.panel_area.output.note(self._last_words)
            self._last_words = ""

    def show_log_again(self) -> None:
        """Show the output and the logged data of the run in view again, after they were cleared."""
        self.feed.begin_again()
        self.draw(force=True)

    def _ask_user(self, prompt: str) -> None:
        self.panel_area.bring("output")
        if self.panel_area.output:
            self.panel_area.output.ask(prompt)

    def _handle_end(self, ended: Ended, stood: str) -> None:
        self.tell_server("ended", id=self.run_controller.run_id)
        self.panel_area.release_buttons()
        good = ended.end in GOOD_ENDS
        if not good:
            self.panel_area.bring("output")
        notice, last = end_words(ended, stood)
        self._last_words = last if good else f"{last}: {self.fill_keys(find_remedy(ended.summary))}"
        self.document.mark_failure(ended.error_line, "" if good else notice)
        # If the output is shown, it ends with the same words, so no notice is needed.
        if not self.panel_area.is_shown("output"):
            self.notify(notice, severity="information" if good else "error")
        self.debugger.handle_end()
        self.handle_situation_change()
        self.check_files()

    # The following methods draw the panels and the footer.

    def draw(self, force: bool = False) -> bool:
        """Show the instant in view in every panel. Return whether the panels have changed.

        Args:
            force: Whether to draw the panels even if nothing has changed.
        """
        run = self.run_controller.build_snapshot()
        now = (
            (run.state, run.instant, run.line, run.speed, run.pen_down, run.stalled),
            (run.spec, run.next_spec, run.past, run.now_tick),
            (run.face, run.pressed),
        )
        if now == self._drawn and not force and not self.feed.is_behind:
            return False
        self._drawn = now
        self.feed.show()
        self.panel_area.show(run)
        state = self._build_state(run)
        if force or self._footed != _list_footer_state(state):
            self._show_footer(state)
        self.pacer.drawn()
        return True

    def handle_painted(self, size: int) -> None:
        """Ask the terminal to report when it has shown the frame that was sent; its answer is a `CursorPosition` event.

        Args:
            size: Length of the codes of the frame, in characters.
        """
        if self.pacer.record_painted(size) and self.own_driver is not None:
            self.own_driver.write(_CURSOR_QUERY)

    def on_cursor_position(self, event: events.CursorPosition) -> None:
        self.pacer.record_answer()

    @on(Driver.SignalResume)
    def pace_again(self) -> None:
        """Stop waiting for the terminal to report a frame as shown.

        To be called when the report may never come, for example because the app was suspended.
        """
        self.pacer.record_interruption()

    def handle_situation_change(self) -> None:
        """Update the footer after the state of the app has changed.

        If the run has just stopped, draw the panels together with the footer.
        """
        self._wake()
        state = self._build_state(self.run_controller.build_snapshot())
        has_stopped = state.run.state in AT_REST and self._drawn[0][0] not in (
            None,
            state.run.state,
        )
        if not has_stopped or not self.draw():
            self._show_footer(state)

    def find_situation(self) -> Situation:
        """Return the state of the app that decides which keys are available."""
        return self._build_situation(self.run_controller.state)

    def _build_situation(self, phase: RunPhase) -> Situation:
        runs = self.run_controller
        code = self.panel_area.code
        timeline = runs.timeline
        facts = runs.program is not None, timeline.recording is not None, timeline.at is not None
        reads_code = code is not None and code.is_read
        return Situation(
            phase,
            *facts,
            self.debugger.is_away,
            reads_code,
            self.has_pixels,
            self.context.reasons.has_gone_wrong(runs),
            self.undo is not None,
            self.lesson.step_actions,
        )

    def action_target(self) -> ActionContext:
        return self.context

    def _build_state(self, run: Snapshot) -> AppState:
        """Return everything that the panels and the footer show, at the instant in view."""
        playing = self.run_controller.timeline.playing
        return AppState(run, self._build_situation(run.state), self.debugger.looks_back, playing)

    def _show_footer(self, state: AppState) -> None:
        self._footed = _list_footer_state(state)
        names = list_working(state.situation)
        if self.panel_area.is_single:
            names = ("panel-next", *names)
        actions = list_footer_actions(self.ACTIONS, names, state.situation, state.playing)
        if "esc" in dict(keys := self._field_keys()):
            # The focused field takes letters as text, so that no action has a key.
            actions = []
        self.key_footer.show(actions, state.status, keys, state.failed)

    def _field_keys(self) -> tuple[KeyWord, ...]:
        """Return the keys of the focused text field or panel, for the footer; empty if it has no keys of its own."""
        # The focus may already be gone while the app ends.
        focused = self.focused if self.screen_stack else None
        if isinstance(focused, Input):
            return getattr(focused.parent, "field_keys", FIELD_KEYS)
        if code := self.panel_area.code:
            if code.awaits_letters:
                return CLICKED_KEYS
            if code.typing and focused and code in focused.ancestors:
                return TYPING_KEYS
        return find_panel_keys(focused)

    # Panels

    def on_panel_area_added(self, message: PanelArea.Added) -> None:
        if message.panel == "world" and (world := self.panel_area.world):
            world.show_rays = self.settings.rays
            world.time_bar.marks = self.run_controller.timeline.list_marks
            if self.run_controller.mat:
                world.set_mat(self.run_controller.mat.pixels)
            if self.focused is None:
                world.focus()
        if message.panel in ("code", "controls"):
            self._show_program()
        if message.panel in ("code", "debug"):
            self.debugger.mark()
            self.debugger.show()
        if message.panel == "goals":
            self.goals.show()
        if message.panel == "lesson":
            self.lesson.show()
        self.panel_area.show_next_run(self.run_controller.next_run)
        self.call_after_refresh(self.draw, force=True)

    def on_panel_area_rearranged(self) -> None:
        self.mark_box()
        self.call_after_refresh(self.draw, force=True)

    def _show_program(self) -> None:
        self.document.show_program()
        self.debugger.load_breaks(self.run_controller.program)

    # The following methods handle what the user does.

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Return whether a key runs an action of the app now; if not, the focused widget gets the key.

        The page keys, for example, run an action only while the text of the lesson or the code can be scrolled.
        """
        if action == "act" and parameters[0] in PAGES:
            return accept_page_keys(self.panel_area)
        if action == "act" and parameters[0] in TEXT_KEYS:
            return has_more_text(self.panel_area)
        return super().check_action(action, parameters)

    def action_leave_field(self) -> None:
        """Move the focus from a field to the world; if no field has the focus, return from the past to the present."""
        if self.debugger.is_away and self.focused in (None, self.panel_area.world):
            self.go_to_now()
        self.panel_area.focus_world()

    def on_output_answered(self, message: Output.Answered) -> None:
        self.run_controller.send(Answer(message.text))
        self.action_leave_field()

    def on_server_asks(self, message: ServerAsks) -> None:
        """Do what the web server that shows the app in a browser requests; `do_asked` lists the requests."""
        do_asked(self.context, message.asked)


def _list_footer_state(state: AppState) -> tuple[Any, ...]:
    """Return those values of the app's state on which the footer depends."""
    run = state.run
    return (
        state.situation,
        state.playing,
        state.looks_back and run.time_s,
        state.looks_back,
        run.speed,
        run.end,
    )


def run_app(settings: AppSettings) -> int:
    """Run the app in this terminal until the user quits; return the exit code."""
    enter()
    lab = LabApp(settings, picture_mode_at_start(settings.cells, settings.colors))
    lab.run()
    return leave(lab.return_code or 0)
