"""Parts of the library that the simulated brick does not have: each says so by its name."""

from __future__ import annotations

import types
from collections.abc import Mapping
from functools import wraps
from typing import Any, NoReturn

from tuisim.errors import NotSimulated

REFUSED: Mapping[str, Mapping[str, str]] = {
    "ev3dev2.control.GyroBalancer": {
        "GyroBalancer": "it balances on two wheels, and this robot cannot fall; to drive, use MoveTank or MoveSteering",
    },
    "ev3dev2.control.webserver": {
        "RobotWebServer": "a program has no network; for driving by hand use RemoteControlledTank or the buttons",
        "WebControlledTank": "a program has no network; for driving by hand use RemoteControlledTank or the buttons",
    },
}
"""By module, the classes that cannot be made, and what to use in their place."""


def refuse_classes(module: types.ModuleType) -> None:
    """Make the constructors of a module's refused classes raise NotSimulated."""
    for name, hint in REFUSED[module.__name__].items():
        refused: Any = getattr(module, name)
        refused.__init__ = wraps(refused.__init__)(_refusal(f"{module.__name__}.{name}", hint))


def _refusal(name: str, hint: str) -> Any:
    def refuse(_self: object, *_args: object, **_kwargs: object) -> NoReturn:
        raise NotSimulated(f"{name} is not part of the simulated brick", hint)

    return refuse
