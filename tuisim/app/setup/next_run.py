"""The plan of the next run: choices, from which its specification is rebuilt after each change.

Choices stay as they were made: a robot as listed or in its file, not as modified by the current mat. So the effects of
one mat or preset do not outlast it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import BackgroundError, TuisimError
from tuisim.base.source import Program
from tuisim.engine.core import tree
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import EMPTY_MAT, NoiseSpec, Obstacle, RobotSpec, RunSpec
from tuisim.engine.obstacles import load_obstacles
from tuisim.engine.protocol import UserAction
from tuisim.programs.program_file import ProgramSource, build_program
from tuisim.programs.program_settings import (
    GROUND_PATHS,
    PROGRAM_PATHS,
    Decided,
    decide,
    has_brick_rules,
)
from tuisim.settings.build import build_run_spec, extract_settings, list_ineffective
from tuisim.settings.options import RESET_BY_MAT, RESET_BY_PROFILE, RUN_VALUES, START, Settings
from tuisim.settings.presses import press_actions
from tuisim.settings.profiles import load_profile
from tuisim.settings.robots import DEFAULT_ROBOT, RobotChoice

WORLD_PATHS = frozenset(
    {
        "background",
        "mats",
        "robot",
        "obstacles",
        "profile",
        "for_brick",
        "arguments",
        "press",
        *RUN_VALUES,
    }
)
"""The paths of settings that affect a run."""


@dataclass(frozen=True, slots=True)
class NextRun:
    """The plan of the next run: its settings, where these come from, and the specification that is built from them."""

    settings: Settings
    """The choices. Robot, obstacles and profile are objects, so that no later change depends on a file."""
    spec: RunSpec
    words: Mapping[str, str]
    """The name or file that robot, obstacles and profile came from, if known; by path."""
    robot: RobotChoice
    """The robot as it was chosen, before any edit."""
    from_program: Mapping[str, Any] = field(default_factory=dict)
    """Settings that the source of the program has decided, or may decide, by path: nobody has chosen them."""
    program_robot: RobotChoice | None = None
    """The robot that the program needs; None for the default one."""
    shown_ports: tuple[str, ...] | None = None
    """The ports that the panels show, as `Program.shown_ports`, while the robot follows the program."""

    @property
    def free(self) -> frozenset[str]:
        """The settings that the program has decided and nobody has changed since; another program may change them."""
        return frozenset(
            key for key, value in self.from_program.items() if self.settings[key] == value
        )

    @property
    def actions(self) -> tuple[UserAction, ...]:
        """The user actions of the next run, from the setting `press`."""
        return press_actions(self.settings["press"], self.spec.profile.tick_hz)

    @property
    def robot_is_edited(self) -> bool:
        """Whether the user has changed parts of the chosen robot."""
        return self.robot_choice != self.robot

    @property
    def robot_choice(self) -> RobotChoice:
        """The chosen robot with the user's changes, without the changes that the mat makes."""
        choice = self.settings["robot"]
        assert isinstance(choice, RobotChoice)
        return choice


def build_plan(settings: Settings, free: Iterable[str] = ()) -> NextRun:
    """Return the plan of a run with these settings.

    Args:
        settings: The settings.
        free: The settings that nobody has chosen, so that programs decide about them.

    Raises:
        ConfigError: a setting names something that does not exist, or an invalid file.
    """
    world, words = _resolve_choices({path: settings[path] for path in WORLD_PATHS})
    settings = settings.changed(world)
    following = {path: settings[path] for path in free}
    return NextRun(settings, build_run_spec(settings), words, world["robot"], following)


def build_first_plan(
    spec: RunSpec, settings: Settings | None, decided: Decided, program: Program | None
) -> NextRun:
    """Return the plan with which the app begins.

    Args:
        spec: The specification of the run.
        settings: The settings from which `spec` was built; None if they are unknown, as for a stored run.
        decided: The settings that the text of the program has decided.
        program: The program of the run.
    """
    if settings is None:
        return plan_rerun(spec, program)
    plan = build_plan(settings, decided.free)
    return replace(plan, program_robot=decided.robot, shown_ports=decided.shown_ports)


def plan_spec(spec: RunSpec) -> NextRun:
    """Return the plan of a run of which only the specification is known, but not the settings that led to it."""
    return replace(build_plan(Settings.merge(extract_settings(spec))), spec=spec)


def plan_rerun(spec: RunSpec, program: Program | None = None) -> NextRun:
    """Return the plan for repeating a run, with the arguments of its program.

    If the magic line of the program has the option `press`, the same buttons are pressed. The mat of the run may be
    missing; the caller must look for it before the start.
    """
    try:
        plan = plan_spec(spec)
    except BackgroundError:
        elsewhere = replace(spec, world=replace(spec.world, background=EMPTY_MAT))
        plan = replace(plan_spec(elsewhere), spec=spec)
    arguments = program.arguments if program else ()
    presses = read_first_line(program).get("press", ())
    return replace(plan, settings=plan.settings.changed({"arguments": arguments, "press": presses}))


def read_first_line(program: Program | None) -> Mapping[str, Any]:
    """Return the settings in the magic line of a program; empty without a program, or if that line is invalid."""
    if program is None:
        return {}
    try:
        path = Path(program.path) if program.path else None
        return build_program(program.text, path, program.name).options
    except TuisimError:
        return {}


def _resolve_choices(choices: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Load the robot, the obstacles and the profile that the choices give by name.

    Returns:
        The choices with the loaded objects in place of the names, and these names by setting.
    """
    resolved = dict(choices)
    words = {}
    for key, load in (
        ("robot", RobotChoice.load),
        ("obstacles", load_obstacles),
        ("profile", load_profile),
    ):
        if isinstance(word := resolved.get(key), str):
            resolved[key], words[key] = load(word), word
    return resolved, words


def change_values(plan: NextRun, values: Mapping[str, Any]) -> NextRun:
    """Return a plan with other values of some settings. This is not for settings that name a file.

    Args:
        plan: The current plan.
        values: The new values by the paths of their settings.

    Raises:
        ConfigError: the mat is missing, or a value is invalid.
    """
    settings = plan.settings.changed(values)
    return replace(plan, settings=settings, spec=build_run_spec(settings))


def apply_choices(plan: NextRun, choices: Mapping[str, Any]) -> NextRun:
    """Return a plan with the settings of a magic line or a world file; all other settings stay.

    Args:
        plan: The current plan.
        choices: Settings by path; those that do not concern the world are ignored.

    Raises:
        ConfigError: a setting names something that does not exist, or an invalid file.
    """
    world_choices, words = _resolve_choices(
        {path: value for path, value in choices.items() if path in WORLD_PATHS}
    )
    ground = {
        key: value
        for key, value in plan.from_program.items()
        if key in GROUND_PATHS and plan.settings[key] in (None, value)
    }
    if "background" in world_choices:
        world_choices = {**dict.fromkeys(RESET_BY_MAT), **ground, **world_choices}
    elif "profile" in world_choices and ground:
        world_choices |= (
            ground if has_brick_rules(world_choices["profile"]) else dict.fromkeys(ground)
        )
    elif world_choices.keys() & set(START):
        world_choices = {**dict.fromkeys(START), **world_choices}
    words_kept = {path: word for path, word in plan.words.items() if path not in world_choices}
    following = {key: value for key, value in plan.from_program.items() if key not in choices}
    built = change_values(plan, world_choices)
    return replace(
        built,
        words=words_kept | words,
        robot=world_choices.get("robot", plan.robot),
        from_program=following,
    )


def follow_program(plan: NextRun, source: ProgramSource) -> tuple[NextRun, Decided]:
    """Return a plan in which the text of a program has decided the settings that the user has not chosen.

    Returns:
        The plan, and the settings that the text has decided. The latter are empty if robot and profile stay the same.

    Raises:
        ConfigError: the mat is missing.
    """
    free = plan.free
    usual = Settings()
    settings = plan.settings
    decided = decide(
        source, settings.changed({key: usual[key] for key in free}), free, insists=False
    )
    free |= decided.layer.keys() & {"profile"}
    layer, words = _resolve_choices({key: decided.layer.get(key, usual[key]) for key in free})
    changed = {key: value for key, value in layer.items() if settings[key] != value}
    words_kept = {key: word for key, word in plan.words.items() if key not in changed}
    named = {key: word for key, word in words.items() if key in changed}
    new_plan = replace(
        change_values(plan, changed) if changed else plan,
        words=words_kept | named,
        from_program=layer,
    )
    new_plan = replace(
        new_plan,
        robot=changed.get("robot", plan.robot),
        program_robot=decided.robot,
        shown_ports=decided.shown_ports,
    )
    return new_plan, decided if changed.keys() & {"robot", "profile"} else Decided()


def free_settings(plan: NextRun, keys: Iterable[str]) -> NextRun:
    """Return a plan in which some settings count as not chosen by the user, so that programs decide about them."""
    free = {key: plan.settings[key] for key in keys if key in PROGRAM_PATHS}
    return replace(plan, from_program={**plan.from_program, **free})


def follow_program_robot(plan: NextRun) -> NextRun:
    """Return a plan with the robot that the program needs, in place of the robot that the user has chosen.

    The text of a later program may change the robot again.
    """
    chosen = plan.program_robot or RobotChoice.load(DEFAULT_ROBOT)
    words = {key: word for key, word in plan.words.items() if key != "robot"}
    following = {**plan.from_program, "robot": chosen}
    return replace(
        change_values(plan, {"robot": chosen}), words=words, robot=chosen, from_program=following
    )


def list_notes(before: NextRun, plan: NextRun) -> list[str]:
    """Return messages to the user about the robot of a plan, except those that also apply to the plan `before`."""
    notes = () if plan.robot == before.robot else plan.robot.notes
    known = list_ineffective(before.spec)
    return [*notes, *(text for text in list_ineffective(plan.spec) if text not in known)]


def change_mat(plan: NextRun, name: str) -> NextRun:
    """Return a plan with another mat, and the start pose, obstacles and sensor positions of that mat.

    Raises:
        BackgroundError: there is no such mat.
    """
    return apply_choices(plan, {"background": name})


def change_robot(plan: NextRun, word: str) -> NextRun:
    """Return a plan with another robot, given by its name or file.

    Raises:
        RobotError: there is no robot of that name, or the file is invalid.
    """
    return apply_choices(plan, {"robot": word})


def change_profile(plan: NextRun, word: str) -> NextRun:
    """Return a plan with another profile, given by its name or file.

    Raises:
        ProfileError: there is no profile of that name, or the file is invalid.
    """
    return apply_choices(plan, {**dict.fromkeys(RESET_BY_PROFILE), "profile": word})


def undo_robot_edits(plan: NextRun) -> NextRun:
    """Return a plan with the robot as it was chosen, without the user's changes of its parts."""
    return change_values(plan, {"robot": plan.robot})


def edit_robot(plan: NextRun, robot: RobotSpec, moved: bool = False) -> NextRun:
    """Return a plan with a robot that the user has changed.

    Args:
        plan: The current plan.
        robot: The changed `plan.robot_choice.spec`.
        moved: Whether a colour sensor was moved: then the mat's sensor positions no longer apply.

    Raises:
        ConfigError: the mat is missing.
    """
    choice = plan.robot_choice
    return change_values(
        plan, {"robot": replace(choice, spec=robot, own_places=choice.own_places or moved)}
    )


def build_saved_robot(plan: NextRun) -> RobotSpec:
    """Return the robot to save: the chosen one with the user's changes and the pen, without the changes of the mat."""
    return replace(plan.robot_choice.spec, pen=plan.spec.robot.pen)


def change_obstacle_set(plan: NextRun, word: str) -> NextRun:
    """Return a plan with another set of obstacles, given by its name or file.

    Raises:
        ObstacleError: there is no set of that name, or the file is invalid.
    """
    return apply_choices(plan, {"obstacles": word})


def change_obstacles(plan: NextRun, obstacles: tuple[Obstacle, ...]) -> NextRun:
    """Return the plan with other obstacles."""
    settings = plan.settings.changed({"obstacles": obstacles})
    words = {path: word for path, word in plan.words.items() if path != "obstacles"}
    spec = replace(plan.spec, world=replace(plan.spec.world, obstacles=obstacles))
    return replace(plan, settings=settings, spec=spec, words=words)


# The following functions are called many times a second during a drag: they change the specification, and do not
# rebuild it.


def _put(plan: NextRun, values: Mapping[str, Any]) -> NextRun:
    """Return a plan with other values of some settings, given by the paths of the settings.

    Call this only for settings on which no other value of the specification depends.
    """
    spec_values = {RUN_VALUES[path].spec_path: value for path, value in values.items()}
    return replace(
        plan, settings=plan.settings.changed(values), spec=tree.put_all(plan.spec, spec_values)
    )


def move_start(plan: NextRun, pose: Pose) -> NextRun:
    """Return the plan with another start pose."""
    return _put(plan, {path: tree.get_value(pose, path.removeprefix("start.")) for path in START})


def change_noise(plan: NextRun, noise: NoiseSpec) -> NextRun:
    """Return the plan with other noise of light and motors."""
    # A robot file may set the noise of its motors and sensors: it applies until the user sets the noise.
    before = plan.spec.world.noise
    changed = {"noise.light": noise.light, "noise.motor": noise.motor}
    return _put(
        plan,
        {
            path: value
            for path, value in changed.items()
            if tree.get_value(before, path[6:]) != value
        },
    )


def change_seed(plan: NextRun, seed: int) -> NextRun:
    """Return the plan with another seed."""
    return _put(plan, {"seed": seed})


def change_pen(plan: NextRun, down: bool) -> NextRun:
    """Return the plan with the pen down or up at the start of the run."""
    return _put(plan, {"pen.down": down})
