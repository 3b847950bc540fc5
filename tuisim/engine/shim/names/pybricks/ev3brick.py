"""The brick, as version 1.0 has it."""

from tuisim.engine.shim.pybricks.hubs import EV3Brick as EV3Brick
from tuisim.engine.shim.pybricks.version_1 import Display as Display
from tuisim.engine.shim.pybricks.version_1 import Speaker as Speaker
from tuisim.engine.shim.pybricks.version_1 import (
    battery as battery,
)
from tuisim.engine.shim.pybricks.version_1 import (
    buttons as buttons,
)
from tuisim.engine.shim.pybricks.version_1 import (
    display as display,
)
from tuisim.engine.shim.pybricks.version_1 import (
    light as light,
)
from tuisim.engine.shim.pybricks.version_1 import (
    sound as sound,
)
