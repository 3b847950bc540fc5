"""Robots, obstacles, profiles and worlds, by name or from a file, made into the frozen specification of a run.

To add a robot or a set of obstacles that has a name: add an entry in `presets.py`.
"""

from tuisim.config.building import build_run_spec
from tuisim.config.obstacles import load_obstacles, save_obstacles
from tuisim.config.presets import NO_OBSTACLES, OBSTACLES, ROBOTS
from tuisim.config.profiles import load_profile
from tuisim.config.robots import load_robot, save_robot
from tuisim.config.world_writing import save_world, settings_from
from tuisim.config.worlds import WorldFile, load_world, means_world

__all__ = [
    "NO_OBSTACLES",
    "OBSTACLES",
    "ROBOTS",
    "WorldFile",
    "build_run_spec",
    "load_obstacles",
    "load_profile",
    "load_robot",
    "load_world",
    "means_world",
    "save_obstacles",
    "save_robot",
    "save_world",
    "settings_from",
]
