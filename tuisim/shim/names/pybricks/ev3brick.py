"""The brick, as version 1.0 has it."""

from tuisim.shim.pybricks.version_1 import (
    battery as battery,
)
from tuisim.shim.pybricks.version_1 import (
    buttons as buttons,
)
from tuisim.shim.pybricks.version_1 import (
    display as display,
)
from tuisim.shim.pybricks.version_1 import (
    light as light,
)
from tuisim.shim.pybricks.version_1 import (
    sound as sound,
)
