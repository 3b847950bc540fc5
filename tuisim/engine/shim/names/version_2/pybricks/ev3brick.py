"""The brick, as version 1.0 has it."""

from tuisim.engine.shim.pybricks.hubs import EV3Brick
from tuisim.engine.shim.pybricks.version_1 import (
    Display,
    Speaker,
    battery,
    buttons,
    display,
    light,
    sound,
)
