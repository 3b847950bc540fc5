"""Keys of the group Files: open, save, export, compare, analyse, edit."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.actions import lesson
from tuisim.app.actions.time_travel import go_to_tick
from tuisim.app.editor.document import NEW_NAME
from tuisim.app.editor.text_file import find_draft
from tuisim.app.setup import next_run as plans
from tuisim.base.errors import TuisimError
from tuisim.base.folders import programs_folder, user_path
from tuisim.engine.obstacles import save_obstacles as write
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import RunStore
from tuisim.settings.options import Settings
from tuisim.settings.preferences import get_preference, keep

_LOGGING_MAT = "Grey_bands"
"""The mat of a new program if the user would have the empty mat, on which there is nothing to log."""

if TYPE_CHECKING:
    from tuisim.analysis.source import LogRequest
    from tuisim.app.actions import ActionContext
    from tuisim.app.setup.recent import Recent
    from tuisim.engine.runs.diff import RunDiff


def clear_log(context: ActionContext) -> None:
    """Remove the logged data from the output and the chart; the log of the run is not changed."""
    context.panels.clear_log()
    if context.runs.timeline.recording is not None:
        context.app.offer_undo(context.app.show_log_again)
    context.app.say(
        "Output and chart cleared. The run keeps its log: {analyse} analyses it, {export} exports it"
    )


def open_program(context: ActionContext) -> None:
    """Ask for a file with a program, a world, goals or a log, and open it."""
    from tuisim.app.dialogs.chooser import build_program_chooser, is_log

    def handle_choice(path: str | None) -> None:
        if path and is_log(path):
            open_log(context, str(user_path(path)))
        elif path:
            open_path(context, path)

    context.app.push_screen(build_program_chooser(), handle_choice)


def open_path(context: ActionContext, path: str) -> None:
    """Open a program, a world or goals; if the open program has unsaved changes, ask the user first."""

    def load() -> None:
        context.loader.open_file(path)
        context.document.open_at_mistake()

    context.document.run_when_saved(load)


_OPENABLE_SUFFIXES = frozenset({".py", ".toml"})
"""Suffixes of programs and worlds; the app opens a file with any other suffix as a log."""


def open_brought(context: ActionContext, path: Path) -> None:
    """Open a file that the user has uploaded in the web page: a program, a world, goals, or a log to be analysed.

    During a run, a program, a world or goals are not opened; a notice names the key that opens them later.
    """
    if path.suffix in _OPENABLE_SUFFIXES and context.runs.in_run:
        context.app.say(
            f"{path.name} has arrived; you can open it when the run has ended: {{open}} opens it"
        )
    elif path.suffix in _OPENABLE_SUFFIXES:
        open_path(context, str(path))
    else:
        open_log(context, str(path))


_WELCOMED_PREFERENCE = "welcomed"
"""Name of the stored preference that says that the user has seen the welcome."""
EXAMPLE = "log_greys.py"
"""File name of the example program that the welcome offers to open."""


def greet(context: ActionContext) -> None:
    """Show the welcome at the first start; at a later start, show it only if there is recent work to continue."""
    show_welcome(context, is_greeting=bool(get_preference(_WELCOMED_PREFERENCE)))


def show_welcome(context: ActionContext, *, is_greeting: bool = False) -> None:
    """Show the welcome, with ways to begin and recent work to continue.

    Args:
        context: The parts of the app.
        is_greeting: Whether to show it only if there is recent work.
    """
    from tuisim.app.setup.recent import list_recent

    def show_entries(entries: list[Recent]) -> None:
        # The dialog opens only when all entries are known, so that Enter always chooses the entry that looks selected.
        if entries or not is_greeting:
            _push_welcome(context, entries)
        context.app.has_greeted = True

    background.run(context.panels, partial(list_recent, NEW_NAME), show_entries, group="welcome")


def _push_welcome(context: ActionContext, recent: Sequence[Recent]) -> None:
    from tuisim.app.dialogs.welcome import Begin, Welcome
    from tuisim.app.setup.recent import Recent

    def handle_choice(what: Begin | Recent | None) -> None:
        # If the preference cannot be stored, the welcome only appears again at the next start.
        with suppress(OSError):
            keep(_WELCOMED_PREFERENCE, True)
        match what:
            case Begin.NEW:
                start_program(context)
            case Begin.EXAMPLE:
                open_path(context, str(programs_folder() / EXAMPLE))
                context.app.start_run()
            case Begin.LEARN:
                lesson.show_menu(context)
            case Begin.OPEN:
                open_program(context)
            case Recent():
                context.document.run_when_saved(partial(_resume_recent, context, what))

    context.app.push_screen(
        Welcome(not get_preference(_WELCOMED_PREFERENCE), recent), handle_choice
    )


def _resume_recent(context: ActionContext, what: Recent) -> None:
    from tuisim.app.setup.recent import Kind

    match what.kind:
        case Kind.DRAFT:
            if draft := find_draft(what.word):
                context.document.restore(draft)
                edit(context)
        case Kind.PROGRAM:
            open_path(context, what.word)
        case Kind.RUN:
            context.loader.open_run(what.word)


def save_robot(context: ActionContext) -> None:
    """Ask for a file, and write the robot of the next run to it."""
    from tuisim.settings.robots import save_robot as write

    runs = context.runs
    name = f"{runs.next_run.robot_choice.spec.name}.toml"
    _save(context, "robot", name, lambda path: write(plans.build_saved_robot(runs.next_run), path))


def save_obstacles(context: ActionContext) -> None:
    """Ask for a file, and write the obstacles of the next run to it."""
    runs = context.runs
    _save(
        context,
        "obstacles",
        "obstacles.toml",
        lambda path: write(runs.next_run.spec.world.obstacles, path),
    )


def _save(context: ActionContext, what: str, name: str, write: Callable[[Path], None]) -> None:
    from tuisim.app.dialogs.save import SaveDialog

    def save(path: Path) -> None:
        write(path)
        context.loader.note_saved(path)

    # Propose the file from which the robot or the obstacles were loaded, if there is one.
    word = context.runs.next_run.words.get(what, "")
    context.app.push_screen(SaveDialog(what, word if word.endswith(".toml") else name, save))


def save_world(context: ActionContext) -> None:
    """Ask for a file, and write the world of the next run to it, with the open program's path and arguments."""
    from tuisim.app.dialogs.save import SaveDialog
    from tuisim.settings.worlds import save_world as write

    def save(path: Path) -> None:
        program = context.runs.program
        plan = context.runs.next_run
        write(
            plan.spec,
            path,
            program.path if program and program.path else None,
            plan.settings["arguments"],
        )
        context.loader.note_saved_world(path)

    context.app.push_screen(SaveDialog("world", str(context.loader.world_file or "lab.toml"), save))


def export(context: ActionContext) -> None:
    """Ask for a file, and write the log of the run to it."""
    from tuisim.app.dialogs.save import ExportDialog

    def handle_export(target: Path | None) -> None:
        if target:
            context.lesson.note_export(target)

    run_id = context.runs.run_id
    program = context.runs.program
    if run_id and program:
        context.app.push_screen(ExportDialog(run_id, program.name), handle_export)


def edit(context: ActionContext) -> None:
    """Show the code panel, and put the focus in its text so that letters are typed into the program."""
    if not context.panels.is_shown("code"):
        context.panels.toggle("code")
    context.app.call_after_refresh(_type, context)


def _type(context: ActionContext) -> None:
    if context.panels.is_shown("code") and (code := context.panels.code):
        # A newly mounted panel has not received the program yet.
        context.document.show_program()
        code.show(context.runs.build_snapshot())
        code.start_typing(at_error=True)


def save_program(context: ActionContext) -> None:
    """Save the program to its file; if it has none, ask for a file."""
    context.document.save()


def edit_in_own_editor(context: ActionContext) -> None:
    """Save unsaved changes, and open the program's file in the editor that the variable `VISUAL` or `EDITOR` names."""
    context.document.run_with_file(partial(_open_in_own_editor, context))


def _open_in_own_editor(context: ActionContext, path: Path) -> None:
    try:
        context.app.run_in_terminal([*own_editor(), str(path)])
    except TuisimError as error:
        context.app.complain(error)


def start_program(context: ActionContext) -> None:
    """Ask for the mat, sensor and skeleton of a new program, and show the text of the new program in the code panel."""
    context.document.run_when_saved(partial(_ask_new_program, context))


def _ask_new_program(context: ActionContext) -> None:
    from tuisim.app.dialogs.new_program import NewProgramDialog
    from tuisim.engine.mats import mats

    plan = context.runs.next_run
    known = mats(plan.settings["mats"])
    current = next(
        (name for name, mat in known.items() if mat.find_spec_name() == plan.spec.world.background),
        "",
    )
    # The list has no mats from the user's own files: if the current mat is one, offer it, too.
    own = {} if current else {plan.spec.world.background: Path(plan.spec.world.background).name}
    laid = current or plan.spec.world.background
    if laid == Settings()["background"] and _LOGGING_MAT in known:
        laid = _LOGGING_MAT

    def handle_choice(text: str | None) -> None:
        if text is not None:
            if not context.panels.is_shown("code"):
                context.panels.toggle("code")
            context.app.call_after_refresh(context.document.start_new, text)

    context.app.push_screen(
        NewProgramDialog(own | {name: name for name in known}, laid), handle_choice
    )


def compare(context: ActionContext) -> None:
    """Ask for a stored run, and show how the run in view differs from it; do nothing if no run is in view."""
    from tuisim.app.dialogs.runs import RunChooser

    recording = context.runs.timeline.recording
    if recording is None:
        return

    def handle_choice(run_id: str | None) -> None:
        if run_id:
            work, show = (
                partial(_load_diff, recording.run_id, run_id),
                partial(_show, context, recording),
            )
            background.run(
                context.panels, work, show, context.app.complain, group="diff", exclusive=True
            )

    context.app.push_screen(RunChooser(recording), handle_choice)


def _load_diff(run_id: str, other_id: str) -> tuple[Recording, RunDiff]:
    """Read two stored runs; return the run `other_id` and the differences between both."""
    from tuisim.engine.runs.diff import diff_runs

    store = RunStore()
    other = store.load_run(other_id)
    return Recording(other), diff_runs(store.load_run(run_id), other)


def _show(
    context: ActionContext, recording: Recording, compared: tuple[Recording, RunDiff]
) -> None:
    from tuisim.app.dialogs.runs import Differences

    other, diff = compared

    def go(there: bool | None) -> None:
        if there and diff.tick and context.runs.timeline.recording is recording:
            go_to_tick(context, diff.tick.tick)

    if context.runs.timeline.recording is recording:
        context.runs.show_earlier(other)
    context.app.push_screen(Differences(recording.name.capitalize(), other.name, diff), go)


def open_analyser(context: ActionContext) -> None:
    """Open the log of the current run in the analyser."""
    from tuisim.analysis.source import LogRequest

    _push_analyser(context, LogRequest(runs=(context.runs.run_id,)))


def open_log(context: ActionContext, file: str) -> None:
    """Open the log in a file, given by its path, in the analyser."""
    from tuisim.analysis.source import LogRequest

    _push_analyser(context, LogRequest.restore(file))


def _push_analyser(context: ActionContext, request: LogRequest) -> None:
    # The analyser is slow to import, and many sessions never use it.
    from tuisim.app.analyser.app import Analyser

    controller = context.lesson
    context.app.push_screen(
        Analyser(request, controller.build_log_panel()), lambda _: controller.log_closed()
    )


def choose_run(context: ActionContext) -> None:
    """Ask for a stored run and open it."""
    from tuisim.app.dialogs.runs import RunChooser

    def handle_choice(run_id: str | None) -> None:
        if run_id:
            context.document.run_when_saved(lambda: context.loader.open_run(run_id))

    def ask() -> None:
        context.app.push_screen(RunChooser(), handle_choice)

    context.document.run_when_saved(ask)


VARIABLES = ("VISUAL", "EDITOR")
"""Environment variables that name the user's editor; the first one that is set counts."""


def own_editor(environment: Mapping[str, str] = os.environ) -> list[str]:
    """Return the command of the user's editor as a list of words, without the file to edit.

    Raises:
        TuisimError: neither `VISUAL` nor `EDITOR` is set, or the command in it cannot be read.
    """
    for variable in VARIABLES:
        named = environment.get(variable, "")
        try:
            if command := shlex.split(named):
                return command
        except ValueError as error:
            raise TuisimError(f"{variable}={named}: {error}") from None
    raise TuisimError(
        "No editor is chosen: VISUAL and EDITOR are not set",
        "export EDITOR=nano before tuisim starts",
    )
