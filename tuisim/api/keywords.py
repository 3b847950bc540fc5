"""Refuses misspelt keyword arguments with the name that was meant, and names options as Python does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from inspect import signature
from typing import Any, TypeVar, cast

from tuisim.api.descriptions import OPTIONS_BY_NAME
from tuisim.base.errors import ConfigError, did_you_mean, nearest
from tuisim.settings.options import WORLD

_Function = TypeVar("_Function", bound=Callable[..., Any])
_NAMES = {
    **{flag: name for name, option in OPTIONS_BY_NAME.items() for flag in option.flags},
    "--expr": "expressions",
    "--scheduler": "scheduler",
}
"""Names of keyword arguments by the command-line option that they stand for; errors name the argument instead."""


_OTHER_NAMES = {
    "axle_track": "wheel_spacing_mm",
    "track_mm": "wheel_spacing_mm",
    "delimiter": "separator",
    "sep": "separator",
}
"""Names of arguments in other libraries, and the arguments of tuisim that mean the same, for hints."""


_ELSEWHERE = {
    "goals": "Run.judge(goals)",
    **dict.fromkeys(("constants", "metrics", "columns", "parameters"), "tuisim.experiment"),
}
"""Arguments that another function has, and the name of that function, for hints."""


def build_keyword_error(name: str, known: Sequence[str]) -> ConfigError:
    """Return the error for an unknown argument, with a hint: a similar argument, or the function that has it.

    Args:
        name: The unknown argument.
        known: The function's arguments.
    """
    option = OPTIONS_BY_NAME.get(name)
    if _OTHER_NAMES.get(name) in known:
        hint = did_you_mean([_OTHER_NAMES[name]])
    elif name in _ELSEWHERE:
        hint = f"{_ELSEWHERE[name]} has it"
    elif option is None or f"{name}s" in known:
        hint = nearest(name, known)
    elif option.group == WORLD and name != "robot":
        hint = f"tuisim.World({name}=…) has it"
    else:
        hint = f"tuisim.simulate({name}=…) has it"
    return ConfigError(f"no such argument {name!r}", hint)


def check_keywords(function: _Function) -> _Function:
    """Return a function that raises ConfigError, not TypeError, for an unknown keyword argument."""
    known = [name for name in signature(function).parameters if name != "self"]

    @wraps(function)
    def call(*values: Any, **named: Any) -> Any:
        for name in named:
            if name not in known:
                raise build_keyword_error(name, known)
        try:
            return function(*values, **named)
        except ConfigError as error:
            flag = error.key.partition(" ")[0]
            if not error.file and flag in _NAMES:
                error.message = error.message.replace(flag, _NAMES[flag], 1)
            # Without its traceback, the error shows the script's line just above the message.
            raise error.with_traceback(None) from None
        except KeyboardInterrupt as error:
            raise error.with_traceback(None) from None

    return cast(_Function, call)
