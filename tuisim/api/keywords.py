"""Refuses misspelt keyword arguments with the name that was meant, and names options as Python does."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, TypeVar, cast

from tuisim.api.descriptions import OPTIONS_BY_NAME
from tuisim.base.errors import ConfigError, nearest
from tuisim.settings.options import WORLD

_Function = TypeVar("_Function", bound=Callable[..., Any])
_NAMES = {
    **{flag: name for name, option in OPTIONS_BY_NAME.items() for flag in option.flags},
    "--expr": "expressions",
    "--scheduler": "scheduler",
}
"""The arguments by their flags on the command line."""


def check_keywords(function: _Function) -> _Function:
    """Return a function that raises ConfigError for a keyword argument that it does not have."""
    known = [name for name in signature(function).parameters if name != "self"]

    @wraps(function)
    def call(*values: Any, **named: Any) -> Any:
        for name in named:
            if name not in known:
                is_of_world = name in OPTIONS_BY_NAME and OPTIONS_BY_NAME[name].group == WORLD
                hint = f"tuisim.World({name}=…) has it" if is_of_world else nearest(name, known)
                raise ConfigError(f"no such argument {name!r}", hint)
        try:
            return function(*values, **named)
        except ConfigError as error:
            flag = error.key.partition(" ")[0]
            if not error.file and flag in _NAMES:
                error.message = error.message.replace(flag, _NAMES[flag], 1)
            raise

    return cast(_Function, call)
