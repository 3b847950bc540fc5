"""Robots, obstacles, profiles, mats and worlds, by name or from a file, as the frozen specification of a run."""
