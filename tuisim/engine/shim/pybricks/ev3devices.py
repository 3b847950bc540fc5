"""The sensors of `pybricks.ev3devices`; its `Motor` is in `motor`."""

from __future__ import annotations

from itertools import product
from typing import Any, ClassVar

from tuisim.engine.core.sensors import color
from tuisim.engine.shim.brick import SENSOR_CLASS
from tuisim.engine.shim.pybricks.brick import Connected, invalid_argument, no_device, whole
from tuisim.engine.shim.pybricks.parameters import (
    AnyPort,
    Button,
    Color,
    Direction,
    Port,
)
from tuisim.engine.shim.sensors import ColorDevice, GyroDevice

LAST_CODE = Color.BROWN.value
"""The highest colour code that the colour sensor gives for a member of `Color`; a code is the member's value."""
KEYPAD = Button.LEFT_UP, Button.LEFT_DOWN, Button.RIGHT_UP, Button.RIGHT_DOWN
"""The buttons of the infrared remote control except the beacon's, in the order of their bits in the mode `IR-REM-A`."""
FIRST_KEYPAD_BIT = 0x10
REMOTE_BUTTONS: tuple[tuple[Button, ...], ...] = (
    (),
    *((button,) for button in KEYPAD),
    *product(KEYPAD[:2], KEYPAD[2:]),
    (Button.BEACON,),
    KEYPAD[:2],
    KEYPAD[2:],
)
"""The pressed buttons of the infrared remote control, by the code that the sensor gives in the mode `IR-REMOTE`."""
NO_BEACON = -128
"""The distance that the infrared sensor gives in the mode `IR-SEEK` if it finds no beacon."""
DEG_PER_HEADING = 3
CHANNELS = range(1, 5)


class Sensor(Connected):
    """Base class of Pybricks' EV3 sensors; such a sensor is on an input port, and measures in one of its modes."""

    KIND: ClassVar[str] = ""
    """The kind of sensor that the class needs, a key of `engine.core.sensors.SENSORS`; empty if it accepts every kind.
    """

    def __init__(self, port: AnyPort) -> None:
        name = self._take_port(port, self.brick.session.sim.spec.robot.input_ports)
        sensor = self.brick.find_sensor(name, self.KIND)
        if sensor is None:
            raise no_device(self.brick.hint(SENSOR_CLASS))
        self._sensor = sensor

    def _read(self, mode: str) -> tuple[int, ...]:
        """Return the numbers that the sensor measures in a mode, as its driver gives them.

        The first measurement after a change of mode takes more time.
        """
        return self._sensor.measure(mode) if self._sensor.mode == mode else self._switched(mode)

    def _switched(self, mode: str) -> tuple[int, ...]:
        """Switch to a mode, and return the numbers that the sensor's driver first measures in it."""
        self._sensor.switch(mode)
        return self._sensor.measure_switched(mode)


class TouchSensor(Sensor):
    """Pybricks' EV3 touch sensor: it tells whether it is pressed."""

    KIND = "touch"

    def pressed(self) -> bool:
        """Return whether the sensor is pressed."""
        return bool(self._read("TOUCH")[0])


class ColorSensor(Sensor):
    """Pybricks' EV3 colour sensor: it measures colours, reflected light and ambient light."""

    KIND = "color"

    def color(self) -> Color | None:
        """Return the colour that the sensor sees, as a `Color`; None if it sees none."""
        code = self._read("COL-COLOR")[0]
        return Color(code) if 0 < code <= LAST_CODE else None

    def reflection(self) -> int:
        """Return the reflected light in percent."""
        return self._read("COL-REFLECT")[0]

    def ambient(self) -> int:
        """Return the ambient light in percent."""
        return self._read("COL-AMBIENT")[0]

    def rgb(self) -> tuple[int, int, int]:
        """Return the reflected red, green and blue light in percent."""
        self._read("RGB-RAW")
        assert isinstance(self._sensor, ColorDevice)
        red, green, blue = (100 * channel // color.WHITE for channel in self._sensor.channels())
        return red, green, blue


class UltrasonicSensor(Sensor):
    """Pybricks' EV3 ultrasonic sensor: it measures distances, and hears other ultrasonic sensors."""

    KIND = "ultrasonic"

    def distance(self, silent: bool = False) -> int:
        """Return the distance to the next object in mm; `silent` switches the sensor off after the measurement."""
        if silent:
            return self._switched("US-SI-CM")[0]
        return self._read("US-DIST-CM")[0]

    def presence(self) -> bool:
        """Return whether the sensor hears another ultrasonic sensor."""
        return bool(self._read("US-LISTEN")[0])


class InfraredSensor(Sensor):
    """Pybricks' EV3 infrared sensor: it measures distances, finds the beacon, and receives the remote control."""

    KIND = "infrared"

    COLLECT: ClassVar[type[Any]] = list
    """The type of the collections in which `buttons` and `keypad` return buttons: a list, or a set under version 4."""

    def distance(self) -> int:
        """Return the distance to the next object, 0 for near to 100 for far."""
        return self._read("IR-PROX")[0]

    def _channel(self, channel: Any) -> int:
        number = whole(channel)
        if number not in CHANNELS:
            raise invalid_argument()
        return number - 1

    def beacon(self, channel: int) -> tuple[int, int] | tuple[None, None]:
        """Return the beacon's distance, 0 to 100, and its direction in degrees, positive to the right.

        Both are None if the sensor does not find the beacon on this channel.

        Args:
            channel: The channel of the beacon, 1 to 4.
        """
        at = 2 * self._channel(channel)
        heading, distance = self._read("IR-SEEK")[at : at + 2]
        return (None, None) if distance == NO_BEACON else (distance, DEG_PER_HEADING * heading)

    def buttons(self, channel: int) -> Any:
        """Return the remote control's buttons that are pressed on a channel, as members of `Button`; empty for none.

        Args:
            channel: The channel, 1 to 4.
        """
        return self.COLLECT(REMOTE_BUTTONS[self._read("IR-REMOTE")[self._channel(channel)]])

    def keypad(self) -> Any:
        """Return the remote control's buttons that are pressed on channel 1, as members of `Button`; empty for none.

        Unlike `buttons`, it notices any combination.
        """
        bits = self._read("IR-REM-A")[0]
        pressed = (key for place, key in enumerate(KEYPAD) if bits & FIRST_KEYPAD_BIT << place)
        return self.COLLECT(pressed)


class GyroSensor(Sensor):
    """The EV3 gyro. As on the brick, reading the speed and then the angle sets the angle to 0."""

    KIND = "gyro"
    _zero = 0

    def __init__(
        self,
        port: Port,
        direction: Direction = Direction.CLOCKWISE,
        *,
        positive_direction: Direction | None = None,
    ) -> None:
        super().__init__(port)
        self._sign = (positive_direction or direction).sign
        self._zero = self._angle()

    def _switched(self, mode: str) -> tuple[int, ...]:
        values = super()._switched(mode)
        assert isinstance(self._sensor, GyroDevice)
        if self._sensor.restarts:
            self._zero = 0
        return values

    def _angle(self) -> int:
        return self._read("GYRO-ANG")[0] * self._sign

    def angle(self) -> int:
        """Return the gyro's angle in degrees, which increases clockwise; `reset_angle` sets it."""
        return self._angle() - self._zero

    def speed(self) -> int:
        """Return the rate of turn in degrees per second, clockwise."""
        return self._read("GYRO-RATE")[0] * self._sign

    def reset_angle(self, angle: float) -> None:
        """Make the gyro show the angle `angle`, in degrees, at the robot's present heading."""
        self._zero = self._angle() - whole(angle)
