"""Motors and sensors of the EV3."""

from tuisim.shim.pybricks.ev3devices import (
    ColorSensor as ColorSensor,
)
from tuisim.shim.pybricks.ev3devices import (
    GyroSensor as GyroSensor,
)
from tuisim.shim.pybricks.ev3devices import (
    InfraredSensor as InfraredSensor,
)
from tuisim.shim.pybricks.ev3devices import (
    TouchSensor as TouchSensor,
)
from tuisim.shim.pybricks.ev3devices import (
    UltrasonicSensor as UltrasonicSensor,
)
from tuisim.shim.pybricks.motor import Motor as Motor
