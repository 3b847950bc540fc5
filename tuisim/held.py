"""What a program that stands still looks like: threads, frames, variables, watches, lines met."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ThreadState:
    """One thread of a program that stands still."""

    name: str
    line: int
    """Its line of the program, 0 if it is in none."""
    waiting: str
    """What it waits for and until when, empty if it could run on."""
    held: bool
    """Whether it is the one in which the run was held."""


@dataclass(frozen=True, slots=True)
class FrameState:
    """One call of the program's own code."""

    function: str
    line: int
    file: str
    """Empty for the program itself, otherwise the module beside it."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A name and what it stands for."""

    name: str
    kind: str
    """Name of its type."""
    value: str
    """Its value as text, cut to a length that can be shown."""
    changed: bool
    """Whether the text is another one than at the last look at this function; new names are changed."""


@dataclass(frozen=True, slots=True)
class Watched:
    """A watch and its value."""

    text: str
    value: str
    """Empty if there is an error."""
    error: str


@dataclass(frozen=True, slots=True)
class MetLine:
    """A line of the program that was about to run."""

    tick: int
    ordinal: int
    line: int
    thread: str
    depth: int
    """How many calls of the program's own code were open, from 1."""
