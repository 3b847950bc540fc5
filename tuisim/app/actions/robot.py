"""Keys of the group Robot: pose, pen, mat, robot, profile, obstacles; zoom and rays of the world."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from tuisim.app.setup import next_run as plans
from tuisim.config.mats import mats
from tuisim.core.geometry import Pose
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.panels.world import World
    from tuisim.app.workspace import Workspace


def pen(workspace: Workspace) -> None:
    """Put the pen up or down."""
    runs = workspace.run_controller
    runs.set_pen(not runs.pen_down)
    if not runs.in_past:
        kind = runs.spec.robot.pen
        workspace.app.say(f"Pen down: {kind.color}, {kind.width_mm:g} mm" if runs.pen_down else "Pen up")


def home(workspace: Workspace) -> None:
    """Put the robot back to the start pose of the mat or the command line."""
    workspace.run_controller.place(workspace.run_controller.home)


def nudge(workspace: Workspace, right_mm: float, up_mm: float, turn_deg: float) -> None:
    """Move the robot a little."""
    pose = workspace.run_controller.pose
    workspace.run_controller.place(Pose(pose.x_mm + right_mm, pose.y_mm + up_mm, pose.heading_deg + turn_deg))


def clear_trace(workspace: Workspace) -> None:
    """Clear the pen trace."""
    if world := world_panel(workspace):
        world.clear_trace()
        workspace.app.draw(force=True)


def random_place(workspace: Workspace) -> None:
    """Put the robot at a random place on the field."""

    from tuisim.app.setup.poses import random_pose

    if pose := random_pose(workspace.run_controller.spec, Random()):
        workspace.run_controller.place(pose)
    else:
        workspace.app.say("No free position found: there are too many obstacles, or the robot is too large")


def saved_poses(workspace: Workspace) -> None:
    """Show the dialog of the saved poses."""
    from tuisim.app.dialogs.entries import SavedPoses

    def go(pose: Pose | None) -> None:
        if pose:
            workspace.run_controller.place(pose)

    workspace.app.push_screen(SavedPoses(workspace.run_controller.pose), go)


def choose_mat(workspace: Workspace) -> None:
    """Ask for a mat and set it."""
    from tuisim.app.dialogs.chooser import MatPicker

    folder = workspace.run_controller.next_run.settings["mats"]
    try:
        known = mats(folder)
    except TuisimError as error:
        workspace.app.complain(error)
        return

    def lay(name: str | None) -> None:
        if name:
            workspace.loader.change_mat(name)

    workspace.app.push_screen(MatPicker(workspace.run_controller.spec.world.background, known, folder), lay)


def choose(workspace: Workspace, what: str) -> None:
    """Ask for a robot, a profile or a set of obstacles, and apply the choice to the plan."""
    from tuisim.app.dialogs.chooser import OF_PROGRAM, obstacle_chooser, profile_chooser, robot_chooser

    chooser, change = {
        "robot": (robot_chooser, plans.with_robot),
        "profile": (profile_chooser, plans.with_profile),
        "obstacles": (obstacle_chooser, plans.with_obstacle_set),
    }[what]

    def chosen(word: str | None) -> None:
        if word == OF_PROGRAM:
            workspace.loader.attempt(plans.with_program_robot)
        elif word:
            workspace.loader.attempt(lambda plan: change(plan, word))

    workspace.app.push_screen(chooser(workspace.run_controller.next_run), chosen)


def reset_robot(workspace: Workspace) -> None:
    """Undo the edits of the robot."""
    if workspace.run_controller.next_run.robot_is_edited:
        workspace.loader.attempt(plans.with_robot_as_chosen)
    else:
        workspace.app.say("The robot has no changes to undo")


def zoom(workspace: Workspace) -> None:
    """Switch the world to the next zoom."""
    if world := world_panel(workspace):
        world.cycle_zoom()
        workspace.app.draw(force=True)


def world_panel(workspace: Workspace) -> World | None:
    """Return the world panel; None, with a notice, if it is hidden."""
    if workspace.panel_area.shown("world"):
        return workspace.panel_area.world
    workspace.app.say("The world is hidden: {panel-world} shows it")
    return None


def rays(workspace: Workspace) -> None:
    """Switch the ultrasonic rays on or off."""
    if world := world_panel(workspace):
        world.show_rays = not world.show_rays
        workspace.app.draw(force=True)
