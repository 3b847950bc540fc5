"""Parts of the library that the simulated brick does not have: each says so by its name."""

from __future__ import annotations

import types
from collections.abc import Mapping
from functools import wraps
from typing import Any, NoReturn

from tuisim.errors import NotSimulated

REFUSED: Mapping[str, tuple[str, ...]] = {
    "ev3dev2.button": ("Button",),
    "ev3dev2.control.GyroBalancer": ("GyroBalancer",),
    "ev3dev2.control.webserver": ("WebControlledTank",),
    "ev3dev2.led": ("Led", "Leds"),
    "ev3dev2.port": ("LegoPort",),
    "ev3dev2.power": ("PowerSupply",),
}
"""By module, the classes that cannot be made."""


def refuse_classes(module: types.ModuleType) -> None:
    """Make the constructors of a module's refused classes raise NotSimulated."""
    for name in REFUSED[module.__name__]:
        found: Any = getattr(module, name, None)
        if found is not None:
            found.__init__ = wraps(found.__init__)(_refusal(f"{module.__name__}.{name}"))


def _refusal(name: str) -> Any:
    def refuse(_self: object, *_args: object, **_kwargs: object) -> NoReturn:
        raise NotSimulated(f"{name} is not part of the simulated brick")

    return refuse
