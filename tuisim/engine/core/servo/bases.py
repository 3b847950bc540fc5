"""The drive bases of a program, by their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.engine.core.servo.drive_base import DriveBase

MAX_BASES = 256
"""Only so many newest drive bases have numbers: a program may make one in each turn of a loop."""


class DriveBases:
    """The drive bases that a program has made most recently, by number."""

    __slots__ = ("_bases", "_made")

    def __init__(self) -> None:
        self._bases: list[DriveBase] = []
        self._made = 0

    def __len__(self) -> int:
        return len(self._bases)

    def __getitem__(self, number: int) -> DriveBase:
        return self._bases[number]

    @property
    def newest(self) -> int:
        """The number of the drive base that the program has made last."""
        return (self._made - 1) % MAX_BASES

    def add(self, base: DriveBase) -> None:
        """Add a drive base; once there are `MAX_BASES`, it replaces the oldest one and has its number."""
        self._made += 1
        self._bases[self.newest : self.newest + 1] = [base]
