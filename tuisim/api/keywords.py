"""Refuses misspelt keyword arguments with the name that was meant."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, TypeVar, cast

from tuisim.base.errors import ConfigError, nearest

_Function = TypeVar("_Function", bound=Callable[..., Any])


def check_keywords(function: _Function) -> _Function:
    """Return a function that raises ConfigError for a keyword argument that it does not have."""
    known = signature(function).parameters

    @wraps(function)
    def call(*values: Any, **named: Any) -> Any:
        for name in named:
            if name not in known:
                raise ConfigError(f"no such argument {name!r}", nearest(name, known))
        return function(*values, **named)

    return cast(_Function, call)
