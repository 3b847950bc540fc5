"""Gives the methods of a library class other globals without changing its module.

A program that does `from module import *` also gets the names that the module itself has
imported, such as `os`: those must not change.
"""

from __future__ import annotations

import types
from functools import update_wrapper
from typing import Any


def rebind(changed: type[Any], **names: object) -> None:
    """Change the values that the methods and properties of a class see under some global names.

    Args:
        changed: The class.
        names: The values by name.
    """
    for name, part in list(vars(changed).items()):
        match part:
            case types.FunctionType():
                setattr(changed, name, _rebound(part, names))
            case property():
                get, put, delete = (
                    _rebound(function, names) for function in (part.fget, part.fset, part.fdel)
                )
                setattr(changed, name, property(get, put, delete, part.__doc__))


def _rebound(function: Any, names: dict[str, object]) -> Any:
    if function is None:
        return None
    copy = types.FunctionType(
        function.__code__,
        {**function.__globals__, **names},
        function.__name__,
        function.__defaults__,
        function.__closure__,
    )
    copy.__kwdefaults__ = function.__kwdefaults__
    return update_wrapper(copy, function)
