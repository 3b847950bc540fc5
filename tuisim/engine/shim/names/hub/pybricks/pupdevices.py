"""Motors, sensors and the remote control."""

from tuisim.engine.shim.pybricks.hub.controllers import Remote
from tuisim.engine.shim.pybricks.hub.pupdevices import (
    ColorSensor,
    ForceSensor,
    Light,
    UltrasonicSensor,
)
from tuisim.engine.shim.pybricks.version_4 import Motor
from tuisim.engine.shim.pybricks.version_4 import Motor as DCMotor
