"""Keys of the group Files: open, save, export, compare, analyse, edit."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.actions.time_travel import to_tick
from tuisim.app.setup import next_run as plans

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.runs.diff import RunDiff
    from tuisim.runs.recording import Recording


def clear_log(lab: LabApp) -> None:
    """Clear the logged data from the output and the chart; the run keeps its log."""
    lab.panel_area.clear_log()
    lab.say("Output and chart are clear; the run keeps its log: l analyses it, e exports it")


def open_program(lab: LabApp) -> None:
    """Ask for a program and open it."""
    from tuisim.app.dialogs.chooser import program_chooser

    def take(path: str | None) -> None:
        if path:
            lab.loader.open_file(path)

    lab.push_screen(program_chooser(), take)


def save_robot(lab: LabApp) -> None:
    """Ask for a file and write the robot to it."""
    from tuisim.app.dialogs.save import SaveDialog
    from tuisim.config.robots import save_robot as write

    def save(path: Path) -> None:
        write(plans.robot_to_save(lab.run_controller.next_run), path)
        lab.loader.saved(path)

    proposed = lab.run_controller.next_run.words.get("robot", "")
    name = proposed if proposed.endswith(".toml") else f"{lab.run_controller.next_run.robot_choice.spec.name}.toml"
    lab.push_screen(SaveDialog("robot", name, save))


def save_obstacles(lab: LabApp) -> None:
    """Ask for a file and write the obstacles to it."""
    from tuisim.app.dialogs.save import SaveDialog
    from tuisim.config.obstacles import save_obstacles as write

    def save(path: Path) -> None:
        write(lab.run_controller.next_run.spec.world.obstacles, path)
        lab.loader.saved(path)

    proposed = lab.run_controller.next_run.words.get("obstacles", "")
    lab.push_screen(SaveDialog("obstacles", proposed if proposed.endswith(".toml") else "obstacles.toml", save))


def save_world(lab: LabApp) -> None:
    """Ask for a file and write the world to it, with the program that is open."""
    from tuisim.app.dialogs.save import SaveDialog
    from tuisim.config.worlds import save_world as write

    def save(path: Path) -> None:
        program = lab.run_controller.program
        plan = lab.run_controller.next_run
        write(plan.spec, path, program.path if program and program.path else None, plan.settings.arguments)
        lab.loader.saved_world(path)

    lab.push_screen(SaveDialog("world", str(lab.loader.world_file or "lab.toml"), save))


def export(lab: LabApp) -> None:
    """Ask for a file and write the log to it."""
    from tuisim.app.dialogs.save import ExportDialog

    run_id = lab.run_controller.run_id
    program = lab.run_controller.program
    if run_id and program:
        lab.push_screen(ExportDialog(run_id, program.name))


def edit(lab: LabApp) -> None:
    """Show the code, and start typing in it."""
    if not lab.panel_area.shown("code"):
        lab.panel_area.toggle("code")
    lab.call_after_refresh(_type, lab)


def _type(lab: LabApp) -> None:
    if lab.panel_area.shown("code") and (code := lab.panel_area.code):
        # A newly mounted panel has not received the program yet.
        lab.document.introduce()
        code.start_typing(at_error=True)


def new_program(lab: LabApp) -> None:
    """Start a new program in the code panel."""
    if not lab.panel_area.shown("code"):
        lab.panel_area.toggle("code")
    lab.call_after_refresh(lab.document.new)


def compare(lab: LabApp) -> None:
    """Ask for a run and show where the current one differs from it."""
    from tuisim.app.dialogs.runs import RunChooser

    recording = lab.run_controller.timeline.recording
    if recording is None:
        return

    def take(run_id: str | None) -> None:
        if run_id:
            work, show = partial(_diff, recording.run_id, run_id), partial(_show, lab, recording)
            background.run(lab, work, show, lab.complain, group="diff", exclusive=True)

    lab.push_screen(RunChooser(recording), take)


def _diff(run_id: str, other_id: str) -> tuple[str, RunDiff]:
    """Return the name of the other run, and the differences. Reads both runs."""
    from tuisim.runs.diff import diff_runs
    from tuisim.runs.store import RunStore

    store = RunStore()
    other = store.load_run(other_id)
    return f"run {other.number}", diff_runs(store.load_run(run_id), other)


def _show(lab: LabApp, recording: Recording, compared: tuple[str, RunDiff]) -> None:
    from tuisim.app.dialogs.runs import Differences

    other, diff = compared

    def go(there: bool | None) -> None:
        if there and diff.tick and lab.run_controller.timeline.recording is recording:
            to_tick(lab, diff.tick.tick)

    lab.push_screen(Differences(recording.name.capitalize(), other, diff), go)


def analyse(lab: LabApp) -> None:
    """Open the log of the current run in the analyser."""
    # The analyser is slow to import, and many sessions never use it.
    from tuisim.analysis.source import LogRequest
    from tuisim.app.analyser.screen import Analyser

    lab.push_screen(Analyser(LogRequest(runs=(lab.run_controller.run_id,))))
