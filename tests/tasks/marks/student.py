"""A student of the class that tests mark: files, expected points, and why.

The task, on the mat Grey_bands with the profile robolab, from (150, 500) at 0°: print the level of each of the four
bands as `Colour: N` in percent, and stop at (1750, 500) without touching the wall, whose face is at x = 1950 mm.

What the marks follow from: a sensor is 30 mm ahead of the axle and sees a disc of 20 mm, so it lies fully on the
bands (x 250-451, 650-851, 1050-1251, 1450-1651) while the axle is at x 230-411, 630-811, 1030-1211 and 1430-1611. They
read 86.3, 82.7, 50.2 and 0 percent (255: 220, 211, 128, 0). One rotation drives 175.93 mm, so 1600 mm are 9.094
rotations and the middles of the bands are 170, 400, 400 and 400 mm apart. At speed 50 the robot drives 256.6 mm/s
and stops at once. Its front is about 50 mm ahead of the axle: it touches the wall from x = 1900 mm on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tuisim.base.errors import printable

GOALS = Path(__file__).with_name("goals.toml")

GOAL_POINTS: Mapping[str, float] = {"levels": 4, "place": 3, "heading": 1, "wall": 1, "done": 1}
"""The goals by name, with their points:

- levels: samples `Colour` reach 86.3, 82.7, 50.2 and 0, each within 0.5.
- place: the robot stands within 30 mm of (1750, 500) at the end of the run.
- heading: it stands within 100 mm of there, and its heading is within 5° of 0.
- wall: it came within 100 mm of there, and touched nothing.
- done: it stands within 100 mm of there, and the program finished without an error within 20 s.
"""

EVERY = tuple(GOAL_POINTS)
ARRIVAL = ("place", "heading", "wall", "done")
"""Missed by a robot that never comes near the place."""


@dataclass(frozen=True)
class Student:
    """One student of the class."""

    name: str
    """Name of the file or the folder; a name without `.py` is a folder."""
    files: Mapping[str, str | bytes]
    """Contents by the path in the folder; for a file its own name is the only one."""
    missed: tuple[str, ...]
    """The goals that are missed, in the order of the goals."""
    why: str
    """Why these marks are expected."""
    line: int = 0
    """The line of the main program that the reason of failure names; 0 if it names none, or no particular one."""

    @property
    def row(self) -> str:
        """Its name in the marks."""
        return printable(self.name.removesuffix(".py"))

    @property
    def points(self) -> float:
        """The expected points, the same with every seed: there is no noise."""
        return sum(points for goal, points in GOAL_POINTS.items() if goal not in self.missed)

    def write(self, folder: Path) -> None:
        """Write the files into the folder of the class."""
        own = folder if self.name.endswith(".py") else folder / self.name
        for name, content in self.files.items():
            path = own / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())


def single(
    name: str, text: str | bytes, why: str, missed: tuple[str, ...] = (), line: int = 0
) -> Student:
    """Return a student who hands in one file."""
    return Student(f"{name}.py", {f"{name}.py": text}, missed, why, line)
