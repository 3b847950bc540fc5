"""Motors and sensors of the EV3."""

from tuisim.engine.shim.pybricks.ev3devices import (
    ColorSensor as ColorSensor,
)
from tuisim.engine.shim.pybricks.ev3devices import (
    GyroSensor as GyroSensor,
)
from tuisim.engine.shim.pybricks.ev3devices import (
    InfraredSensor as InfraredSensor,
)
from tuisim.engine.shim.pybricks.ev3devices import (
    TouchSensor as TouchSensor,
)
from tuisim.engine.shim.pybricks.ev3devices import (
    UltrasonicSensor as UltrasonicSensor,
)
from tuisim.engine.shim.pybricks.motor import Motor as CompatMotor  # noqa: F401 - it is seen
from tuisim.engine.shim.pybricks.parameters import Stop as Stop
from tuisim.engine.shim.pybricks.wrappers import Motor as Motor
