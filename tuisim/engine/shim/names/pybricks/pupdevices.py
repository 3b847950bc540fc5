"""Motors and sensors of hubs."""

from tuisim.engine.shim.pybricks.hub.pupdevices import (
    ColorSensor as ColorSensor,
)
from tuisim.engine.shim.pybricks.hub.pupdevices import (
    ForceSensor as ForceSensor,
)
from tuisim.engine.shim.pybricks.hub.pupdevices import (
    UltrasonicSensor as UltrasonicSensor,
)
from tuisim.engine.shim.pybricks.version_4 import Motor as Motor
