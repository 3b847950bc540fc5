"""Keys of the group Files: open, save, export, compare, analyse, edit."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.actions.time_travel import to_tick
from tuisim.app.editor.own_editor import own_editor
from tuisim.app.setup import next_run as plans
from tuisim.config.obstacles import save_obstacles as write
from tuisim.errors import TuisimError
from tuisim.runs.store import RunStore

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace
    from tuisim.runs.diff import RunDiff
    from tuisim.runs.recorded_run import Recording


def clear_log(workspace: Workspace) -> None:
    """Clear the logged data from the output and the chart; the run keeps its log."""
    workspace.panel_area.clear_log()
    workspace.app.say("Output and chart cleared. The run keeps its log: {analyse} analyses it, {export} exports it")


def open_program(workspace: Workspace) -> None:
    """Ask for a program and open it."""
    from tuisim.app.dialogs.chooser import program_chooser

    def opened(path: str | None) -> None:
        if path:
            open_path(workspace, path)

    workspace.app.push_screen(program_chooser(), opened)


def open_path(workspace: Workspace, path: str) -> None:
    """Open a program, a world or goals; if the open program has unsaved changes, a dialog asks first."""

    def opened() -> None:
        workspace.loader.open_file(path)
        workspace.document.open_at_mistake()

    workspace.document.when_safe(opened)


def save_robot(workspace: Workspace) -> None:
    """Ask for a file and write the robot to it."""
    from tuisim.config.robots import save_robot as write

    runs = workspace.run_controller
    name = f"{runs.next_run.robot_choice.spec.name}.toml"
    _save(workspace, "robot", name, lambda path: write(plans.robot_to_save(runs.next_run), path))


def save_obstacles(workspace: Workspace) -> None:
    """Ask for a file and write the obstacles to it."""
    runs = workspace.run_controller
    _save(workspace, "obstacles", "obstacles.toml", lambda path: write(runs.next_run.spec.world.obstacles, path))


def _save(workspace: Workspace, what: str, name: str, write: Callable[[Path], None]) -> None:
    from tuisim.app.dialogs.save import SaveDialog

    def save(path: Path) -> None:
        write(path)
        workspace.loader.saved(path)

    # The file that it came from, if it came from one.
    word = workspace.run_controller.next_run.words.get(what, "")
    workspace.app.push_screen(SaveDialog(what, word if word.endswith(".toml") else name, save))


def save_world(workspace: Workspace) -> None:
    """Ask for a file and write the world to it, with the program that is open."""
    from tuisim.app.dialogs.save import SaveDialog
    from tuisim.config.worlds import save_world as write

    def save(path: Path) -> None:
        program = workspace.run_controller.program
        plan = workspace.run_controller.next_run
        write(plan.spec, path, program.path if program and program.path else None, plan.settings["arguments"])
        workspace.loader.saved_world(path)

    workspace.app.push_screen(SaveDialog("world", str(workspace.loader.world_file or "lab.toml"), save))


def export(workspace: Workspace) -> None:
    """Ask for a file and write the log to it."""
    from tuisim.app.dialogs.save import ExportDialog

    def exported(target: Path | None) -> None:
        if target:
            workspace.lesson.exported(target)

    run_id = workspace.run_controller.run_id
    program = workspace.run_controller.program
    if run_id and program:
        workspace.app.push_screen(ExportDialog(run_id, program.name), exported)


def edit(workspace: Workspace) -> None:
    """Show the code, and start typing in it."""
    if not workspace.panel_area.shown("code"):
        workspace.panel_area.toggle("code")
    workspace.app.call_after_refresh(_type, workspace)


def _type(workspace: Workspace) -> None:
    if workspace.panel_area.shown("code") and (code := workspace.panel_area.code):
        # A newly mounted panel has not received the program yet.
        workspace.document.introduce()
        code.start_typing(at_error=True)


def edit_in_own_editor(workspace: Workspace) -> None:
    """Open the program's file in the editor that the environment names; unsaved changes are saved before."""
    workspace.document.when_in_file(partial(_open_in_own_editor, workspace))


def _open_in_own_editor(workspace: Workspace, path: Path) -> None:
    try:
        workspace.app.run_in_terminal([*own_editor(), str(path)])
    except TuisimError as error:
        workspace.app.complain(error)


def new_program(workspace: Workspace) -> None:
    """Start a new program in the code panel."""
    if not workspace.panel_area.shown("code"):
        workspace.panel_area.toggle("code")
    workspace.app.call_after_refresh(workspace.document.new)


def compare(workspace: Workspace) -> None:
    """Ask for a run and show where the current one differs from it."""
    from tuisim.app.dialogs.runs import RunChooser

    recording = workspace.run_controller.timeline.recording
    if recording is None:
        return

    def chosen(run_id: str | None) -> None:
        if run_id:
            work, show = partial(_diff, recording.run_id, run_id), partial(_show, workspace, recording)
            background.run(workspace.panel_area, work, show, workspace.app.complain, group="diff", exclusive=True)

    workspace.app.push_screen(RunChooser(recording), chosen)


def _diff(run_id: str, other_id: str) -> tuple[str, RunDiff]:
    """Return the name of the other run, and the differences. Reads both runs."""
    from tuisim.runs.diff import diff_runs

    store = RunStore()
    other = store.load_run(other_id)
    return f"run {other.number}", diff_runs(store.load_run(run_id), other)


def _show(workspace: Workspace, recording: Recording, compared: tuple[str, RunDiff]) -> None:
    from tuisim.app.dialogs.runs import Differences

    other, diff = compared

    def go(there: bool | None) -> None:
        if there and diff.tick and workspace.run_controller.timeline.recording is recording:
            to_tick(workspace, diff.tick.tick)

    workspace.app.push_screen(Differences(recording.name.capitalize(), other, diff), go)


def analyse(workspace: Workspace) -> None:
    """Open the log of the current run in the analyser."""
    # The analyser is slow to import, and many sessions never use it.
    from tuisim.analysis.source import LogRequest
    from tuisim.app.analyser.app import Analyser

    lesson = workspace.lesson
    request = LogRequest(runs=(workspace.run_controller.run_id,))
    workspace.app.push_screen(Analyser(request, lesson.beside_log()), lambda _: lesson.log_closed())


def choose_run(workspace: Workspace) -> None:
    """Ask for a stored run and open it."""
    from tuisim.app.dialogs.runs import RunChooser

    def chosen(run_id: str | None) -> None:
        if run_id:
            workspace.document.when_safe(lambda: workspace.loader.open_run(run_id))

    def ask() -> None:
        workspace.app.push_screen(RunChooser(), chosen)

    workspace.document.when_safe(ask)
