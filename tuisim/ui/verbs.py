"""What the keys do: one function a verb, from the app to nothing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.core.geometry import Pose
from tuisim.errors import TuisimError
from tuisim.ui import plan as plans
from tuisim.ui.panels import PANELS
from tuisim.ui.plan import Plan

if TYPE_CHECKING:
    from tuisim.ui.app import Lab
    from tuisim.ui.panels.world import World
    from tuisim.ui.screens.choosing import Chooser

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 16.0, 0.0)
"""What `[` and `]` step through; 0 is as fast as possible."""


_END_LABELS = {"raised": "error", "time_limit": "time limit", "output_limit": "output limit", "disk_full": "disk full"}


def speed_label(speed: float) -> str:
    """Return a speed as people write it: ¼×, 2×, max."""
    return {0.0: "max", 0.25: "¼×", 0.5: "½×"}.get(speed, f"{speed:g}×")


def end_label(end: str) -> str:
    """Return how a run ended in words."""
    return _END_LABELS.get(end, end)


def stop(lab: Lab) -> None:
    """End the program."""
    lab.bridge.stop()


def _change_speed(lab: Lab, by: int) -> None:
    speed = lab.bridge.speed
    at = SPEEDS.index(speed) if speed in SPEEDS else min(range(6), key=lambda i: abs(SPEEDS[i] - speed))
    to = at + by
    if not 0 <= to < len(SPEEDS):
        lab.say(f"Speed is {speed_label(speed)} already: that is the {'slowest' if by < 0 else 'fastest'}")
        return
    lab.bridge.set_speed(SPEEDS[to])
    lab.situation_changed()


def slower(lab: Lab) -> None:
    """One step down in speed."""
    _change_speed(lab, -1)


def faster(lab: Lab) -> None:
    """One step up in speed."""
    _change_speed(lab, 1)


def pen(lab: Lab) -> None:
    """Pen up if it is down, down if it is up."""
    lab.bridge.set_pen(not lab.bridge.pen_down)


def home(lab: Lab) -> None:
    """Put the robot back to where the mat or the command line has it start."""
    lab.bridge.place(lab.bridge.home)


def nudge(lab: Lab, right_mm: float, up_mm: float, turn_deg: float) -> None:
    """Move the robot a little."""
    pose = lab.bridge.pose
    lab.bridge.place(Pose(pose.x_mm + right_mm, pose.y_mm + up_mm, pose.heading_deg + turn_deg))


def toggle(lab: Lab, panel: str) -> None:
    """Show a panel, which takes the focus, or hide it."""
    lab.desk.toggle(panel)
    lab.situation_changed()
    lab.call_after_refresh(lab.attend, panel)


def enlarge(lab: Lab) -> None:
    """Let the panel with the focus fill the desk, or give the others their places back."""
    focused = lab.focused
    panel = next(
        (name for name, widget in lab.desk.panels.items() if focused and widget in focused.ancestors_with_self), ""
    )
    if panel or lab.desk.alone:
        lab.desk.give_all("" if lab.desk.alone else panel)
    else:
        lab.say("No panel has the focus: tab or a click gives it to one")


def _world(lab: Lab) -> World | None:
    if lab.desk.shown("world"):
        return lab.desk.world
    lab.say(f"The world is hidden: {PANELS['world'].key} shows it")
    return None


def rays(lab: Lab) -> None:
    """Draw the ultrasonic rays, or not."""
    if world := _world(lab):
        world.show_rays = not world.show_rays
        lab.draw(force=True)


def zoom(lab: Lab) -> None:
    """Next zoom of the world."""
    if world := _world(lab):
        world.cycle_zoom()
        lab.draw(force=True)


def clear_trace(lab: Lab) -> None:
    """Wipe the pen's trace off."""
    if world := _world(lab):
        world.clear_trace()
        lab.draw(force=True)


def clear_log(lab: Lab) -> None:
    """Wipe what was logged off the output and the chart; the run keeps it."""
    lab.desk.clear_log()
    lab.say("Output and chart are clear; the run keeps its log: l analyses it, e exports it")


def random_place(lab: Lab) -> None:
    """Put the robot somewhere on the field."""
    from random import Random

    from tuisim.ui.placing import random_pose

    if pose := random_pose(lab.bridge.spec, Random()):
        lab.bridge.place(pose)
    else:
        lab.say("No free place was found: there are many obstacles, or the robot is large")


def saved_poses(lab: Lab) -> None:
    """Go to a saved pose, or save this one."""
    from tuisim.ui.screens.poses import SavedPoses

    def go(pose: Pose | None) -> None:
        if pose:
            lab.bridge.place(pose)

    lab.push_screen(SavedPoses(lab.bridge.pose), go)


def choose_mat(lab: Lab) -> None:
    """Ask for a mat and lay it out."""
    from tuisim.own_mats import mats
    from tuisim.ui.screens.mats import MatPicker

    folder = lab.bridge.plan.settings.mats
    try:
        known = mats(folder)
    except TuisimError as error:
        lab.complain(error)
        return

    def lay(name: str | None) -> None:
        if name:
            lab.loading.change_mat(name)

    lab.push_screen(MatPicker(lab.bridge.spec.world.background, known, folder), lay)


def open_program(lab: Lab) -> None:
    """Ask for a program and open it."""
    from tuisim.ui.screens.choices import program_chooser

    def take(path: str | None) -> None:
        if path:
            lab.loading.open_file(path)

    lab.push_screen(program_chooser(), take)


def _choose(lab: Lab, chooser: Chooser, take: Callable[[Plan, str], Plan]) -> None:
    """Ask for a name or a file, and take what it stands for into the plan."""

    def chosen(word: str | None) -> None:
        if word:
            lab.loading.attempt(lambda plan: take(plan, word))

    lab.push_screen(chooser, chosen)


def choose_robot(lab: Lab) -> None:
    """Ask for a robot."""
    from tuisim.ui.screens.choices import robot_chooser

    _choose(lab, robot_chooser(lab.bridge.plan), plans.with_robot)


def choose_profile(lab: Lab) -> None:
    """Ask for a profile."""
    from tuisim.ui.screens.choices import profile_chooser

    _choose(lab, profile_chooser(lab.bridge.plan), plans.with_profile)


def choose_obstacles(lab: Lab) -> None:
    """Ask for a set of obstacles."""
    from tuisim.ui.screens.choices import obstacle_chooser

    _choose(lab, obstacle_chooser(lab.bridge.plan), plans.with_obstacle_set)


def reset_robot(lab: Lab) -> None:
    """Undo what was edited of the robot."""
    if lab.bridge.plan.robot_is_edited:
        lab.loading.attempt(plans.with_robot_as_chosen)
    else:
        lab.say("Nothing of the robot is edited")


def save_robot(lab: Lab) -> None:
    """Ask for a file and write the robot to it."""
    from tuisim.config import save_robot as write
    from tuisim.ui.screens.saving import SaveDialog

    def save(path: Path) -> None:
        write(plans.robot_to_save(lab.bridge.plan), path)
        lab.loading.saved(path)

    proposed = lab.bridge.plan.words.get("robot", "")
    name = proposed if proposed.endswith(".toml") else f"{lab.bridge.plan.robot_choice.spec.name}.toml"
    lab.push_screen(SaveDialog("robot", name, save))


def save_obstacles(lab: Lab) -> None:
    """Ask for a file and write the obstacles to it."""
    from tuisim.config import save_obstacles as write
    from tuisim.ui.screens.saving import SaveDialog

    def save(path: Path) -> None:
        write(lab.bridge.plan.spec.world.obstacles, path)
        lab.loading.saved(path)

    proposed = lab.bridge.plan.words.get("obstacles", "")
    lab.push_screen(SaveDialog("obstacles", proposed if proposed.endswith(".toml") else "obstacles.toml", save))


def save_world(lab: Lab) -> None:
    """Ask for a file and write the world to it, with the program that is open."""
    from tuisim.config import save_world as write
    from tuisim.ui.screens.saving import SaveDialog

    def save(path: Path) -> None:
        program = lab.bridge.program
        plan = lab.bridge.plan
        write(plan.spec, path, program.path if program and program.path else None, plan.settings.arguments)
        lab.loading.saved_world(path)

    lab.push_screen(SaveDialog("world", str(lab.loading.world_file or "lab.toml"), save))


def export(lab: Lab) -> None:
    """Ask for a file and write the log to it."""
    from tuisim.ui.screens.export import ExportDialog

    run_id = lab.bridge.run_id
    program = lab.bridge.program
    if run_id and program:
        lab.push_screen(ExportDialog(run_id, program.name))


def show_help(lab: Lab) -> None:
    """Show every key."""
    from tuisim.ui.screens.help import HelpScreen

    lab.push_screen(HelpScreen())


def suspend(lab: Lab) -> None:
    """Stop as a job of the shell, a run paused."""
    lab.action_suspend_process()


def leave(lab: Lab) -> None:
    """Quit, after a question if there are unsaved changes or a program runs."""
    lab.work.when_safe(lambda: _leave(lab))


def _leave(lab: Lab) -> None:
    if not lab.bridge.in_run:
        lab.exit()
        return
    from tuisim.ui.screens.leave import LeaveQuestion

    lab.push_screen(LeaveQuestion(), lambda yes: lab.exit() if yes else None)
