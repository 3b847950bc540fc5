"""A piece of work that is done beside the screen."""

from __future__ import annotations

from dataclasses import dataclass

AT_ONCE = 200_000
"""Rows that are worked through within a few hundredths of a second."""


@dataclass(slots=True)
class Task:
    """One piece of work while it is done."""

    word: str
    part: float = 0.0
    """Of it that is done, 0 to 1; 0 where that is not known."""
    stopped: bool = False
    """Whether nobody waits for it any more."""

    def __str__(self) -> str:
        return f"{self.word} {self.part:.0%}" if self.part else self.word
