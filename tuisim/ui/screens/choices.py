"""What there is to choose from: programs and worlds, robots, obstacles, profiles."""

from __future__ import annotations

from tuisim.ui.plan import Plan
from tuisim.ui.screens.choosing import Chooser, Group, files_here


def program_chooser() -> Chooser:
    """Return the list of programs and worlds: of the folder one is in, and the examples."""
    from tuisim.assets import programs
    from tuisim.config import load_world

    examples = programs()
    known = {str(path.resolve()) for _, path, _ in examples}
    here = files_here([".py"])
    own = Group(here.title, [entry for entry in here.entries if entry[0] not in known])
    worlds = files_here([".toml"], load_world)
    groups = [
        own,
        Group("Worlds" if own.entries else f"{worlds.title}: worlds", worlds.entries),
        Group("Examples", [(str(path), name, title) for name, path, title in examples]),
    ]
    return Chooser("Programs and worlds", groups, path_hint="Path of a program or a world, or choose below")


def robot_chooser(plan: Plan) -> Chooser:
    """Return the list of robots."""
    from tuisim.config import ROBOTS, load_robot

    presets = [(name, name, _robot_title(name)) for name in ROBOTS]
    groups = [Group("", presets), files_here([".toml", ".json"], lambda path: load_robot(str(path)))]
    return Chooser("Robots", groups, plan.words.get("robot", ""), "Path of a robot's .toml or .json file")


def _robot_title(name: str) -> str:
    from tuisim.config import ROBOTS

    robot = ROBOTS[name]
    eyes = ", ".join(f"({eye.x_mm:g}, {eye.y_mm:g}) ⌀ {eye.diameter_mm}" for eye in robot.color_sensors)
    return f"wheels ⌀ {robot.wheel_diameter_mm:g}, {robot.wheel_spacing_mm:g} apart; eyes {eyes}"


def obstacle_chooser(plan: Plan) -> Chooser:
    """Return the list of sets of obstacles."""
    from tuisim.config import OBSTACLES, load_obstacles

    presets = [
        (name, name, "; ".join(f"{b.width_mm:g}×{b.height_mm:g} at ({b.x_mm:g}, {b.y_mm:g})" for b in boxes) or "none")
        for name, boxes in OBSTACLES.items()
    ]
    groups = [Group("", presets), files_here([".toml", ".json"], lambda path: load_obstacles(str(path)))]
    return Chooser("Obstacles", groups, plan.words.get("obstacles", ""), "Path of a .toml or .json file")


def profile_chooser(plan: Plan) -> Chooser:
    """Return the list of profiles."""
    from tuisim.config import load_profile
    from tuisim.core.profile import PROFILES

    presets = [
        (name, name, f"{p.tick_hz} ticks a second, {'solid' if p.solid else 'nothing is solid'}")
        for name, p in PROFILES.items()
    ]
    groups = [Group("", presets), files_here([".toml"], lambda path: load_profile(str(path)))]
    return Chooser("Profiles", groups, plan.words.get("profile", ""), "Path of a profile's .toml file")
