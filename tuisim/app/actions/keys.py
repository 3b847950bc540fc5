"""The table of the app's keys: what each one does, its name, and when it is available.

To add a key: write its function in the file of this folder that holds its group, and add a line to `ACTIONS`. Binding,
footer, help and command palette follow from the line.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from typing import TypeAlias

from tuisim.app.action import Action
from tuisim.app.actions import ActionContext, app, files, lesson, program, robot, time_travel
from tuisim.app.actions.files import open_analyser
from tuisim.app.keymap import apply_keys, check_theme
from tuisim.app.layout.arrangement import Preset
from tuisim.app.panels import PANELS
from tuisim.app.snapshot import IN_RUN, RunPhase, Situation
from tuisim.engine.protocol import LineStep
from tuisim.settings.user_config import UserConfig

PROGRAM = "Program"
DEBUG = "Debugging"
TIME = "Time"
ROBOT = "Robot"
PANEL = "Panels"
FILES = "Files"
LESSON = "Lesson"
APP = "App"


LabAction: TypeAlias = Action[ActionContext, Situation]
"""An action of the lab's screen, such as a line of `ACTIONS`."""


def _can_run(now: Situation) -> str:
    if not now.has_program:
        return "No program yet: {open} opens one"
    if now.in_past or now.state is RunPhase.PAUSED:
        return ""
    return "The program is already running: {stop} stops it" if now.state in IN_RUN else ""


def _describe_run_key(now: Situation) -> str:
    return "{run} runs the program" if now.has_program else "{open} opens a program, {run} runs it"


def _can_stop(now: Situation) -> str:
    return "" if now.state in IN_RUN else f"Nothing is running: {_describe_run_key(now)}"


def _can_pause(now: Situation) -> str:
    return "" if now.in_past else _can_stop(now)


def _can_step(now: Situation) -> str:
    if now.state == RunPhase.PAUSED or now.in_past:
        return ""
    if now.state in IN_RUN:
        return "Works only while paused: {pause} pauses"
    return "The run has ended: {back} goes back" if now.has_run else _can_stop(now)


def _can_look_back(now: Situation) -> str:
    return "" if now.has_run else f"No run yet: {_describe_run_key(now)}"


def _can_ask_why(now: Situation) -> str:
    # The key also explains why a program cannot run at all, before its first run.
    return "" if now.has_program else _can_look_back(now)


def _can_go_forward(now: Situation) -> str:
    return "" if now.in_past else _can_look_back(now) or "This is the latest instant"


def _can_come_back(now: Situation) -> str:
    return "" if now.looks_back else _can_go_forward(now)


def _can_change_world(now: Situation) -> str:
    return "Not available during a run: {stop} stops it" if now.state in IN_RUN else ""


def _can_export(now: Situation) -> str:
    return "" if now.has_run else f"No log yet: {_describe_run_key(now)}"


def _can_undo(now: Situation) -> str:
    return "" if now.can_undo else "Nothing to undo"


def _can_draw_pixels(now: Situation) -> str:
    return "" if now.has_pixels else "This terminal does not report that it can draw pixels"


def _can_nudge(now: Situation) -> str:
    # Only a running program prevents moves by keys: a waiting one may have asked the user to place the robot.
    if now.looks_back or now.state not in (RunPhase.STARTING, RunPhase.RUNNING):
        return ""
    return "{pause} pauses the program, then keys move the robot; the mouse does at any time"


def _build_nudge(key: str, words: str, forward: tuple[float, float]) -> LabAction:
    do = partial(robot.move_slightly, right_mm=forward[0], up_mm=forward[1], turn_deg=0.0)
    return Action(
        f"nudge-{key.replace('+', '-')}", key, f"Move the robot {words}", ROBOT, do, _can_nudge
    )


def _build_turn(letter: str, arrow: str, words: str, turn_deg: float) -> LabAction:
    # Some terminals send ctrl and an arrow as the arrow alone, so a letter turns the robot, too.
    do = partial(robot.move_slightly, right_mm=0.0, up_mm=0.0, turn_deg=turn_deg)
    return Action(
        f"nudge-ctrl-{arrow}",
        f"{letter},ctrl+{arrow}",
        f"Turn the robot {words}",
        ROBOT,
        do,
        _can_nudge,
    )


def _build_nudges() -> list[LabAction]:
    ways = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "up": (0.0, 1.0), "down": (0.0, -1.0)}
    coarse = [_build_nudge(key, f"10 mm {key}", (10 * x, 10 * y)) for key, (x, y) in ways.items()]
    fine = [_build_nudge(f"shift+{key}", f"1 mm {key}", (x, y)) for key, (x, y) in ways.items()]
    turns = [
        _build_turn("a", "left", "5° counter-clockwise", 5.0),
        _build_turn("f", "right", "5° clockwise", -5.0),
    ]
    return coarse + fine + turns


def _build_toggles() -> list[LabAction]:
    return [
        Action(
            f"panel-{p.id}",
            p.key,
            f"Show or hide {p.title}",
            PANEL,
            partial(app.toggle, panel=p.id),
            footer=p.id,
        )
        for p in PANELS.values()
    ]


_PRESETS = {
    Preset.DRIVE: ("f6", "Layout to drive: large world, readings"),
    Preset.DEBUG: ("f7", "Layout to debug: code, variables, world, output"),
    Preset.ANALYSE: ("f8", "Layout to analyse: large chart, world"),
}


_NEXT_LAYOUT = "Next layout: drive, debug, analyse, standard"


def _build_layouts() -> list[LabAction]:
    return [
        *(
            Action(f"layout-{preset}", key, title, PANEL, partial(app.choose_preset, preset=preset))
            for preset, (key, title) in _PRESETS.items()
        ),
        Action("layout-next", "f9", _NEXT_LAYOUT, PANEL, app.show_next_preset, footer="layout"),
        Action(
            "layout-keep", "shift+f9", "Keep the layout for the next start", PANEL, app.keep_layout
        ),
        Action(
            "panel-next",
            "f2",
            "Next panel",
            PANEL,
            partial(app.focus_next_panel, by=1),
            footer="panel",
        ),
        Action(
            "panel-before",
            "shift+f2",
            "Previous panel",
            PANEL,
            partial(app.focus_next_panel, by=-1),
        ),
    ]


def _can_branch(now: Situation) -> str:
    return "" if now.in_past else "A branch starts in the past: {back} goes back"


def _can_debug(now: Situation) -> str:
    return "" if now.has_program or now.has_run else "No program yet: {open} opens one"


_BREAK = "Breakpoint on this line, or the cursor's"


def _build_debug_actions() -> list[LabAction]:
    can = _can_debug
    over = LineStep.OVER
    into = LineStep.INTO
    out = LineStep.OUT
    line_back = "N", "Step back one line", DEBUG
    return [
        Action(
            "next-line",
            "n",
            "Step over: next line",
            DEBUG,
            lambda lab: lab.debugger.step(over),
            can,
            "next",
        ),
        Action(
            "step-into",
            "s",
            "Step into a function call",
            DEBUG,
            lambda lab: lab.debugger.step(into),
            can,
            "into",
        ),
        Action(
            "step-out",
            "u",
            "Step out of this function",
            DEBUG,
            lambda lab: lab.debugger.step(out),
            can,
            "out",
        ),
        Action(
            "line-back",
            *line_back,
            lambda lab: lab.debugger.step_back(),
            _can_look_back,
            "line back",
        ),
        Action("break", "t", _BREAK, DEBUG, program.toggle_break, can, "break"),
        Action(
            "breaks",
            "T",
            "Breakpoints: add, edit, disable, delete",
            DEBUG,
            program.list_breaks,
            can,
        ),
        Action(
            "watches", "w", "Watches: expressions to evaluate", DEBUG, program.list_watches, can
        ),
        Action(
            "to-cursor",
            "L",
            "Run to the cursor's line",
            DEBUG,
            program.run_to_cursor,
            can,
            "to cursor",
        ),
    ]


def _build_travel_actions() -> list[LabAction]:
    back = _can_look_back
    on = _can_go_forward
    keys = "< >"
    go = time_travel
    second_back, second_on = (partial(go.skip_seconds, by=by) for by in (-1, 1))
    sample_before, next_sample = (
        partial(go.go_to_sample, words=words) for words in ("sample back", "sample")
    )
    return [
        Action(
            "ten-ticks",
            "colon",
            "Ten ticks forward, while paused",
            TIME,
            partial(go.step_ticks, ticks=10),
            _can_step,
        ),
        Action(
            "now",
            "end",
            "Return to the present (also escape)",
            TIME,
            go.go_to_now,
            _can_come_back,
            "now",
        ),
        Action(
            "second-back",
            "less_than_sign",
            "One second back",
            TIME,
            second_back,
            back,
            "1 s",
            "",
            keys,
        ),
        Action("second-on", "greater_than_sign", "One second forward", TIME, second_on, on),
        Action("sample-before", "left_parenthesis", "Previous sample", TIME, sample_before, back),
        Action("next-sample", "right_parenthesis", "Next sample", TIME, next_sample, on),
        Action(
            "go-to",
            "g",
            "Go to a time, tick, line, sample or print",
            TIME,
            go.ask_instant,
            back,
            "go to",
        ),
        Action(
            "branch",
            "y",
            "Branch from this instant",
            TIME,
            go.propose_branch,
            _can_branch,
            "branch",
        ),
        Action(
            "went-wrong",
            "exclamation_mark",
            "Where did it go wrong? Again: the next reason",
            TIME,
            go.go_wrong,
            _can_ask_why,
            "wrong?",
        ),
        Action("start-of-run", "home", "Start of the run", TIME, go.go_to_start, back),
    ]


def _scroll(name: str, key: str, where: str, by: int) -> LabAction:
    return Action(
        name,
        key,
        f"Text of the lesson, {where}",
        LESSON,
        partial(lesson.scroll, by=by),
        comes_first=True,
    )


_UNDO = "Undo a move, a cleared trace or log"
_SCREENSHOT = "Save a screenshot: SVG and PNG (also F12)"
_TICK_BACK = partial(time_travel.skip_ticks, ticks=-1)
_SLOWER, _FASTER = (partial(program.change_speed, by=by) for by in (-1, 1))

_WORDS: Mapping[str, str] = {
    "rays": "ultrasound beam distance sonar",
    "zoom": "larger smaller magnify view mat",
    "cells": "cells blocks half quadrant sextant octant braille characters font resolution",
    "pixels": "graphics sixel kitty image",
    "clear": "path drawing line erase delete",
    "pen": "draw path trace line",
    "branch": "past fork other continue",
    "now": "present past end timeline",
    "start-of-run": "first beginning past timeline",
    "slower": "speed pace slow down simulation time",
    "faster": "speed pace speed up simulation time",
    "save-world": "write mat pose scene",
    "mats": "map background field floor world grey bands line",
    "edit": "write change the program text code editor",
    "save-program": "write file keep text code",
    "own-editor": "vim nano emacs external editor",
    "open": "load file",
    "run": "start play go execute",
    "stop": "end abort kill cancel",
    "obstacles": "walls boxes objects",
    "robot": "wheels sensors model",
    "profile": "rules noise drift realism",
    "export": "save data csv excel table",
    "theme": "colours colors dark appearance",
    "settings": "options preferences configuration",
    "quit": "exit close leave end",
    "help": "help manual documentation shortcuts",
    "clear-log": "erase delete graph",
    "runs": "runs history earlier old load log",
    "compare": "difference earlier",
    "home": "reset place position home",
    "random": "place position anywhere",
    "poses": "mark a position place",
    "lesson-menu": "learn tutorial course",
    "panel-world": "mat map path robot picture",
    "panel-lesson": "learn tutorial",
    "panel-instrumentation": "sensors values readings motors gyro",
    "panel-output": "print console log text",
    "panel-arrays": "light grey colour discs rings pixels threshold",
    "panel-code": "program source editor text",
    "panel-chart": "graph plot curve diagram",
    "panel-controls": "speed faster slower time clock",
    "panel-positioning": "pose place move coordinates start",
    "panel-noise": "random error drift seed",
    "panel-debug": "variables values watches",
    "panel-brick": "buttons screen lights display",
    "panel-obstacles": "walls boxes objects ultrasonic",
    "panel-goals": "tasks marks points",
    "panel-settings": "robot wheels sensors pen options",
    "earlier": "grey ghost robot run before previous compare",
    "went-wrong": "why reason error mistake lost line wall blocked goal missed first difference ghost grey",
    "analyse": "graph plot data statistics grey bands values level",
    "palette": "search find commands",
    "break": "pause halt stop at line",
    "next-line": "step debug",
    "go-to": "jump search find time past instant sensor column first",
    "enlarge": "maximise full screen zoom",
    "screenshot": "picture image capture",
    "copy": "clipboard output error readings chart value panel picture text",
    "new": "create template skeleton",
}
"""Further words by which the command palette finds actions, by id."""

# The footer shows the actions in this order, as many as fit; it always shows `help` and `quit`.
ACTIONS: Mapping[str, LabAction] = {
    action.id: replace(action, words=_WORDS.get(action.id, ""))
    for action in (
        Action(
            "run",
            "R,ctrl+r",
            "Run the program",
            PROGRAM,
            program.run,
            _can_run,
            "run",
            shown_key="R",
        ),
        Action(
            "stop", "S", "Stop the program", PROGRAM, lambda lab: lab.runs.stop(), _can_stop, "stop"
        ),
        Action(
            "pause",
            "space",
            "Pause or resume; play back the past",
            PROGRAM,
            program.pause,
            _can_pause,
            "pause",
        ),
        Action(
            "tick",
            "full_stop",
            "One tick forward, while paused",
            TIME,
            partial(time_travel.step_ticks, ticks=1),
            _can_step,
            "tick",
        ),
        Action("back", "comma", "One tick back", TIME, _TICK_BACK, _can_look_back, "back"),
        *_build_debug_actions(),
        *_build_travel_actions(),
        Action(
            "open",
            "o",
            "Open a program, a world, goals or a log",
            FILES,
            files.open_program,
            _can_change_world,
            "open",
        ),
        Action(
            "begin",
            "f4",
            "Begin: a new program, or continue one",
            FILES,
            files.show_welcome,
            _can_change_world,
        ),
        Action("edit", "d", "Edit the program", FILES, files.edit, footer="edit"),
        Action(
            "save-program",
            "f3",
            "Save the program (also ctrl+s in the code)",
            FILES,
            files.save_program,
        ),
        Action(
            "own-editor", "ctrl+e", "Edit the program in $EDITOR", FILES, files.edit_in_own_editor
        ),
        Action(
            "new",
            "ctrl+t",
            "New program: mat, sensor, text",
            FILES,
            files.start_program,
            _can_change_world,
            "new",
        ),
        Action("mats", "b", "Choose a mat", ROBOT, robot.choose_mat, _can_change_world, "mats"),
        Action(
            "home",
            "m",
            "Move the robot to its start pose",
            ROBOT,
            robot.home,
            footer="start",
        ),
        Action("random", "j", "Move the robot to a random pose", ROBOT, robot.place_randomly),
        Action("poses", "P", "Saved poses: go to, save, delete", ROBOT, robot.list_poses),
        Action(
            "robot",
            "r",
            "Choose a robot",
            ROBOT,
            partial(robot.choose, what="robot"),
            _can_change_world,
            "robot",
        ),
        Action(
            "reset-robot",
            "ctrl+n",
            "Undo changes to the robot",
            ROBOT,
            robot.reset_robot,
            _can_change_world,
        ),
        Action(
            "obstacles",
            "k",
            "Choose obstacles",
            ROBOT,
            partial(robot.choose, what="obstacles"),
            _can_change_world,
        ),
        Action(
            "profile",
            "F",
            "Choose a profile",
            ROBOT,
            partial(robot.choose, what="profile"),
            _can_change_world,
        ),
        Action("pen", "p", "Pen up or down", ROBOT, robot.switch_pen, footer="pen"),
        Action(
            "slower",
            "left_square_bracket",
            "Slower",
            PROGRAM,
            _SLOWER,
            footer="speed",
            footer_key="[ ]",
        ),
        Action("faster", "right_square_bracket", "Faster", PROGRAM, _FASTER),
        Action(
            "compare",
            "equals_sign",
            "Compare this run with another",
            FILES,
            files.compare,
            _can_look_back,
        ),
        Action(
            "runs", "h", "Open a stored run", FILES, files.choose_run, _can_change_world, "runs"
        ),
        Action(
            "analyse",
            "l",
            "Analyse the log: table, chart, bands, notes",
            FILES,
            open_analyser,
            _can_export,
            "analyse",
        ),
        Action(
            "export", "e", "Export the log to a file", FILES, files.export, _can_export, "export"
        ),
        Action(
            "save-world",
            "ctrl+s",
            "Save the world to a file",
            FILES,
            files.save_world,
            footer="save",
        ),
        Action("save-robot", "ctrl+b", "Save the robot to a file", FILES, files.save_robot),
        Action(
            "save-obstacles", "ctrl+o", "Save the obstacles to a file", FILES, files.save_obstacles
        ),
        Action("zoom", "v", "Zoom the world", ROBOT, robot.zoom, footer="zoom"),
        Action(
            "earlier", "minus", "Show or hide the earlier run's robot", ROBOT, robot.switch_earlier
        ),
        Action(
            "rays", "U", "Show or hide the ultrasonic rays", ROBOT, robot.switch_rays, footer="rays"
        ),
        Action(
            "pixels",
            "number_sign",
            "Characters or pixels",
            APP,
            app.switch_pixels,
            _can_draw_pixels,
            "cells",
        ),
        Action("clear", "C", "Clear the pen trace", ROBOT, robot.clear_trace, footer="clear"),
        Action(
            "clear-log",
            "x",
            "Clear output and chart; the run keeps its log",
            FILES,
            files.clear_log,
        ),
        *_build_toggles(),
        *_build_layouts(),
        Action(
            "lesson-menu",
            "M",
            "Lessons: open, go back, skip, start over",
            LESSON,
            lesson.show_menu,
            _can_change_world,
            "lessons",
        ),
        Action(
            "answer",
            "Q",
            "Answer the question of the lesson",
            LESSON,
            lesson.answer,
            footer="answer",
        ),
        Action(
            "hint",
            "Y",
            "Next hint of the lesson",
            LESSON,
            lambda lab: lab.lesson.show_hint(),
            footer="hint",
        ),
        _scroll("lesson-up", "pageup", "or the code: up", -8),
        _scroll("lesson-down", "pagedown", "or the code: down", 8),
        _scroll("lesson-back", "ctrl+up", "also while you type: up", -4),
        _scroll("lesson-on", "ctrl+down", "also while you type: down", 4),
        Action("enlarge", "plus", "Enlarge the focused panel, or restore it", PANEL, app.enlarge),
        *_build_nudges(),
        Action(
            "help",
            "question_mark,f1",
            "Guide: about the focused panel, keys, pages, search",
            APP,
            app.show_help,
            footer="help",
            shown_key="?",
        ),
        Action(
            "palette",
            "ctrl+p",
            "Commands: all of them, by name",
            APP,
            app.open_palette,
            footer="all",
            footer_key="^p",
        ),
        Action("cells", "V", "Glyphs of the world: choose by eye", APP, app.choose_cells),
        Action("theme", "f10", "Theme: light, high contrast and others", APP, app.choose_theme),
        Action("settings", "asterisk", "Settings: your own defaults", APP, app.open_settings),
        Action("undo", "backspace", _UNDO, APP, app.undo, _can_undo, "undo"),
        Action("copy", "ctrl+c", "Copy the text of the panel with the focus", APP, app.copy),
        Action("redraw", "ctrl+l", "Redraw a screen that other output overwrote", APP, app.redraw),
        Action("screenshot", "I,f12", _SCREENSHOT, APP, app.save_screen, shown_key="I"),
        Action("suspend", "ctrl+z", "Suspend; fg in the shell resumes", APP, app.suspend),
        Action("quit", "q", "Quit", APP, app.leave, footer="quit"),
    )
}
"""The actions by id."""
RUN_KEYS = frozenset(
    key
    for action in ACTIONS.values()
    if action.group in (PROGRAM, DEBUG, TIME)
    for key in action.key.split(",")
)
"""Keys of the actions that start a run or need one."""


def _find_next_steps(now: Situation) -> tuple[str, ...]:
    """Return the ids of the actions that the user is likely to need next, the most likely first."""
    code = ("to-cursor", "break") if now.reads_code else ()
    wrong = ("went-wrong",) if now.has_reasons else ()
    mended = ("edit",) if now.has_reasons else ()
    if now.can_undo:
        return ("undo", *_find_next_steps(replace(now, can_undo=False)))
    if now.looks_back:
        return ("now", *wrong, "branch", "line-back", "next-line", *code)
    if now.state == RunPhase.PAUSED:
        return ("stop", "pause", "next-line", "line-back", *code, *wrong)
    if now.state in IN_RUN:
        return ("stop", "pause", "went-wrong")
    if now.reads_code:
        results = ("analyse", "panel-chart") if now.has_run else ()
        return ("run", *now.lesson_actions, *wrong, *mended, *results, "edit", *code)
    if now.has_run:
        records = ("analyse", "export", "panel-chart")
        return ("run", *now.lesson_actions, *wrong, *mended, *records, "edit", "back")
    return ("run", *now.lesson_actions, "open", "edit", "mats")


PAGES = frozenset({"lesson-up", "lesson-down"})
"""Ids of the actions of PageUp and PageDown, which turn the pages of a lesson's text, or of the code."""
TEXT_KEYS = frozenset({"lesson-back", "lesson-on"})
"""Ids of the actions that scroll the text of the lesson, whatever widget has the focus."""


def list_footer_actions(
    table: Mapping[str, LabAction], names: Iterable[str], now: Situation, playing: bool
) -> list[LabAction]:
    """Return actions with the words that the footer shows for them now; the word of the pause key depends on the run.

    These actions are left out: those of a lesson that do nothing in its current step, `run` while the program is
    paused, and `step-out` while the program is not paused.

    Args:
        table: The actions by id.
        names: Ids of the actions, in order.
        now: The state of the app.
        playing: Whether the past is played back.
    """
    word = ""
    is_paused = now.state == RunPhase.PAUSED
    if now.in_past:
        word = "" if playing else "play"
    elif is_paused:
        word = "go on"
    # In the footer of a paused program, the steps need the room of `run`, which is left out.
    steps = [
        name
        for name in names
        if (name != "run" or not is_paused or now.in_past)
        and (name != "step-out" or is_paused or now.looks_back)
    ]
    return [
        replace(table[name], footer=word) if word and name == "pause" else table[name]
        for name in steps
        if table[name].group != LESSON or name in now.lesson_actions
    ]


@lru_cache(maxsize=16)
def list_working(now: Situation) -> tuple[str, ...]:
    """Return the ids of the available actions: the likely next steps first, the others in the order of the table."""
    names = dict.fromkeys(name for name, action in ACTIONS.items() if not action.why_not(now))
    first = [step for step in _find_next_steps(now) if step in names]
    return tuple(dict.fromkeys((*first, *names)))


def check_config(config: UserConfig) -> None:
    """Check the keys and the name of the theme in the user's settings.

    The code that reads the settings cannot check these, because only the app knows which actions and themes exist.

    Raises:
        ConfigError: something in the settings is wrong.
    """
    apply_keys(ACTIONS, config)
    check_theme(config)
