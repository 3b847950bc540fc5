"""Marks of the functions in which a program waits, so that the debugger recognises their calls on the stack."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum, auto
from types import CodeType
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


class Wait(Enum):
    """What a program waits for inside a call of Python or of the library."""

    SLEEP = auto()
    FILES = auto()
    LOOP = auto()
    """The program waits for nothing: it has run a loop without a call that takes simulated time, so some time now
    passes.
    """
    MOTOR = auto()
    INPUT = auto()
    BUTTONS = auto()
    """The program waits until the buttons in the waiting function's `to_press` are pressed, and those in its
    `to_release` are not.
    """
    BUTTON_EVENT = auto()
    SOUND = auto()
    READING = auto()
    """The program waits for a value of the device's attribute that the waiting function's variable `name` holds."""
    THREAD = auto()
    LOCK = auto()


_MARKED: dict[CodeType, Wait] = {}


def waits_for(what: Wait) -> Callable[[Function], Function]:
    """Return a decorator that marks a function as one that waits, and returns this same function."""

    def mark(function: Function) -> Function:
        _MARKED[function.__code__] = what
        return function

    return mark


def wait_of(code: CodeType) -> Wait | None:
    """Return what the function with this code waits for; None if it is not marked."""
    return _MARKED.get(code)
