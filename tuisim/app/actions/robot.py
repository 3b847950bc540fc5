"""Keys of the group Robot and world: pose, pen, mat, robot, profile, obstacles."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from tuisim.app.actions.panel import _world
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.core.geometry import Pose
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.dialogs.chooser import Chooser


def pen(lab: LabApp) -> None:
    """Put the pen up or down."""
    lab.run_controller.set_pen(not lab.run_controller.pen_down)


def home(lab: LabApp) -> None:
    """Put the robot back to the start pose of the mat or the command line."""
    lab.run_controller.place(lab.run_controller.home)


def nudge(lab: LabApp, right_mm: float, up_mm: float, turn_deg: float) -> None:
    """Move the robot a little."""
    pose = lab.run_controller.pose
    lab.run_controller.place(Pose(pose.x_mm + right_mm, pose.y_mm + up_mm, pose.heading_deg + turn_deg))


def clear_trace(lab: LabApp) -> None:
    """Clear the pen trace."""
    if world := _world(lab):
        world.clear_trace()
        lab.draw(force=True)


def random_place(lab: LabApp) -> None:
    """Put the robot at a random place on the field."""
    from random import Random

    from tuisim.app.setup.poses import random_pose

    if pose := random_pose(lab.run_controller.spec, Random()):
        lab.run_controller.place(pose)
    else:
        lab.say("No free place was found: there are many obstacles, or the robot is large")


def saved_poses(lab: LabApp) -> None:
    """Show the dialog of the saved poses."""
    from tuisim.app.dialogs.poses import SavedPoses

    def go(pose: Pose | None) -> None:
        if pose:
            lab.run_controller.place(pose)

    lab.push_screen(SavedPoses(lab.run_controller.pose), go)


def choose_mat(lab: LabApp) -> None:
    """Ask for a mat and set it."""
    from tuisim.app.dialogs.chooser import MatPicker
    from tuisim.config.mats import mats

    folder = lab.run_controller.next_run.settings.mats
    try:
        known = mats(folder)
    except TuisimError as error:
        lab.complain(error)
        return

    def lay(name: str | None) -> None:
        if name:
            lab.loader.change_mat(name)

    lab.push_screen(MatPicker(lab.run_controller.spec.world.background, known, folder), lay)


def _choose(lab: LabApp, chooser: Chooser, take: Callable[[NextRun, str], NextRun]) -> None:
    """Ask for a name or a file, and apply the choice to the plan."""

    def chosen(word: str | None) -> None:
        if word:
            lab.loader.attempt(lambda plan: take(plan, word))

    lab.push_screen(chooser, chosen)


def choose_robot(lab: LabApp) -> None:
    """Ask for a robot."""
    from tuisim.app.dialogs.chooser import robot_chooser

    _choose(lab, robot_chooser(lab.run_controller.next_run), plans.with_robot)


def choose_profile(lab: LabApp) -> None:
    """Ask for a profile."""
    from tuisim.app.dialogs.chooser import profile_chooser

    _choose(lab, profile_chooser(lab.run_controller.next_run), plans.with_profile)


def choose_obstacles(lab: LabApp) -> None:
    """Ask for a set of obstacles."""
    from tuisim.app.dialogs.chooser import obstacle_chooser

    _choose(lab, obstacle_chooser(lab.run_controller.next_run), plans.with_obstacle_set)


def reset_robot(lab: LabApp) -> None:
    """Undo the edits of the robot."""
    if lab.run_controller.next_run.robot_is_edited:
        lab.loader.attempt(plans.with_robot_as_chosen)
    else:
        lab.say("Nothing of the robot is edited")
