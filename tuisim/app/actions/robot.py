"""Keys of the group Robot: pose, pen, mat, robot, profile, obstacles; zoom and rays of the world."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from tuisim.app.setup import next_run as plans
from tuisim.base.errors import TuisimError
from tuisim.base.folders import user_path
from tuisim.engine.core.geometry import Pose
from tuisim.engine.mats import mats

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext
    from tuisim.app.panels.world import World


def switch_pen(context: ActionContext) -> None:
    """Lift the pen if it is down; else put it down."""
    runs = context.runs
    # A live run obeys later, so that its pen is still the former one here.
    down = not runs.pen_down
    runs.set_pen(down)
    if not context.debugger.is_away:
        kind = runs.spec.robot.pen
        context.app.say(f"Pen down: {kind.color}, {kind.width_mm:g} mm" if down else "Pen up")


def home(context: ActionContext) -> None:
    """Put the robot at its start pose, which the mat or the command line defines."""
    _move(context, context.runs.home)


def _move(context: ActionContext, pose: Pose) -> None:
    """Place the robot at a pose; the undo key returns the robot to its former pose."""
    before = context.runs.pose
    context.runs.place(pose)
    if not context.debugger.is_away:
        context.app.offer_undo(lambda: context.runs.place(before))


def move_slightly(context: ActionContext, right_mm: float, up_mm: float, turn_deg: float) -> None:
    """Move the robot by a distance along the axes of the mat, and turn it counter-clockwise by an angle."""
    pose = context.runs.pose
    context.runs.place(Pose(pose.x_mm + right_mm, pose.y_mm + up_mm, pose.heading_deg + turn_deg))


def clear_trace(context: ActionContext) -> None:
    """Remove the pen trace from the world panel."""
    if world := find_world_panel(context):
        pieces = world.clear_trace()
        context.app.draw(force=True)
        context.app.offer_undo(lambda: world.restore_trace(pieces))


def place_randomly(context: ActionContext) -> None:
    """Put the robot at a random place on the field where it touches no obstacle; if none is found, show a notice."""

    from tuisim.app.setup.poses import choose_random_pose

    if pose := choose_random_pose(context.runs.spec, Random()):
        _move(context, pose)
    else:
        context.app.say(
            "No free position found: there are too many obstacles, or the robot is too large"
        )


def list_poses(context: ActionContext) -> None:
    """Open the dialog of the saved poses."""
    from tuisim.app.dialogs.entries import SavedPoses

    def go(pose: Pose | None) -> None:
        if pose:
            context.runs.place(pose)

    context.app.push_screen(SavedPoses(context.runs.pose), go)


def choose_mat(context: ActionContext) -> None:
    """Ask for a mat, and use it for the next run."""
    from tuisim.app.dialogs.chooser import MatPicker

    folder = context.runs.next_run.settings["mats"]
    try:
        known = mats(folder)
    except TuisimError as error:
        context.app.complain(error)
        return

    def lay(name: str | None) -> None:
        if name:
            context.loader.change_mat(name)
            _propose_write(context, name if name in known else str(user_path(name).absolute()))

    context.app.push_screen(MatPicker(context.runs.spec.world.background, known, folder), lay)


def _propose_write(context: ActionContext, mat: str) -> None:
    """Ask whether to write a mat, given by name, into the magic line of the open program.

    Do not ask if the line already names this mat, if there is no magic line to write to, or while a lesson is open.
    """
    from tuisim.app.dialogs.question import Question

    document = context.document
    if context.lesson.lesson or (named := document.named_mat) is None or named == mat:
        return

    def handle_answer(answer: str | None) -> None:
        if answer == "w":
            document.write_mat(mat)

    text = f"{document.name} begins with {f'the mat {named}' if named else 'a first line without a mat'}."
    answers = (("k", "Keep it"), ("w", f"Write {mat} there"))
    context.app.push_screen(
        Question("The program's mat", text, answers, "keeps the program as it is"), handle_answer
    )


def choose(context: ActionContext, what: str) -> None:
    """Ask for a robot, a profile or a set of obstacles, and use the choice for the next run.

    Args:
        context: The parts of the app.
        what: `robot`, `profile` or `obstacles`.
    """
    from tuisim.app.dialogs.chooser import build_obstacle_chooser, build_profile_chooser
    from tuisim.app.dialogs.robots import PROGRAM_ROBOT, build_robot_picker

    chooser, change = {
        "robot": (build_robot_picker, plans.change_robot),
        "profile": (build_profile_chooser, plans.change_profile),
        "obstacles": (build_obstacle_chooser, plans.change_obstacle_set),
    }[what]

    def handle_choice(word: str | None) -> None:
        if word == PROGRAM_ROBOT:
            context.loader.try_change(plans.follow_program_robot)
        elif word:
            context.loader.try_change(lambda plan: change(plan, word))

    context.app.push_screen(chooser(context.runs.next_run), handle_choice)


def reset_robot(context: ActionContext) -> None:
    """Undo the user's changes of the robot's parts; a notice says if there are none."""
    if context.runs.next_run.robot_is_edited:
        context.loader.try_change(plans.undo_robot_edits)
    else:
        context.app.say("The robot has no changes to undo")


def zoom(context: ActionContext) -> None:
    """Switch the world panel to its next zoom factor."""
    if world := find_world_panel(context):
        world.cycle_zoom()
        context.app.draw(force=True)


def find_world_panel(context: ActionContext) -> World | None:
    """Return the world panel; if it is hidden, show a notice and return None."""
    if context.panels.is_shown("world"):
        return context.panels.world
    context.app.say("The world is hidden: {panel-world} shows it")
    return None


def switch_earlier(context: ActionContext) -> None:
    """Show or hide the robot of an earlier run, which is drawn in grey beside the robot of the run in view."""
    runs = context.runs
    runs.shows_earlier = not runs.shows_earlier
    if runs.earlier is None:
        when = (
            "From the next run on, the run before is"
            if runs.shows_earlier
            else "Earlier runs are not"
        )
        context.app.say(f"{when} drawn beside a run")
    context.app.draw(force=True)


def switch_rays(context: ActionContext) -> None:
    """Show the rays of the ultrasonic sensor; if they are shown already, hide them."""
    if world := find_world_panel(context):
        world.show_rays = not world.show_rays
        context.app.draw(force=True)
