"""Robots, obstacles, profiles, mats and worlds, by name or from a file, as the frozen specification of a run."""

__all__ = [
    "build",
    "command_line",
    "magic_line",
    "options",
    "overrides",
    "preferences",
    "presses",
    "profiles",
    "robots",
    "shared_options",
    "user_config",
    "worlds",
]
