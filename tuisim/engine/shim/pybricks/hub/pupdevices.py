"""The sensors of `pybricks.pupdevices`; its `Motor` is in `version_4`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from tuisim.engine.core.sensors import color
from tuisim.engine.shim.brick import SENSOR_CLASS
from tuisim.engine.shim.pybricks import ev3devices
from tuisim.engine.shim.pybricks.brick import Connected, Result, Waiting, no_device, whole
from tuisim.engine.shim.pybricks.hub.colors import find_nearest, measure_hsv
from tuisim.engine.shim.pybricks.hub.face import show_light
from tuisim.engine.shim.pybricks.hub.parameters import Port
from tuisim.engine.shim.pybricks.tools import wait, wait_until
from tuisim.engine.shim.pybricks.version_4 import Color
from tuisim.engine.shim.sensors import ColorDevice

FARTHEST_MM = 2000
"""The distance in mm that the distance sensor reads if it hears no echo, or only one from farther away."""
MAX_FORCE_N = 10.0
MAX_PRESS_MM = 6.67


class Sensor(ev3devices.Sensor):
    """Base class of sensors on a port of a hub."""

    SWITCH_US: ClassVar[int] = 0
    """Time in µs that the first reading takes after the sensor's mode was changed."""

    def _read_as(self, mode: str, convert: Callable[[int], Result]) -> Result:
        """Measure in a mode, and return the result of `convert` for the measured number.

        While a task runs, return an object to await instead.
        """
        return self.brick.finish(self._measure(mode, convert))

    def _measure(self, mode: str, convert: Callable[[int], Result]) -> Waiting[Result]:
        sensor = self._sensor
        if sensor.mode == mode:
            return convert(sensor.measure(mode)[0])
        sensor.mode = mode
        yield from wait_until(self.brick.now_us + self.SWITCH_US)
        return convert(sensor.measure_switched(mode)[0])


class Lights:
    """The lights around the eye of a sensor, which are not shown."""

    def on(self, brightness: Any = 100) -> None:
        """Turn the lights around the eye of the sensor on.

        Args:
            brightness: In percent, one number for all lights, or one for each.
        """
        return wait(10)

    def off(self) -> None:
        """Turn all lights around the eye of the sensor off."""
        return wait(10)


class Light(Connected):
    """A light on a port of a hub. The panel of the hub shows it, but no sensor sees it."""

    def __init__(self, port: Port) -> None:
        name = self._take_port(port, self.brick.session.sim.spec.robot.output_ports)
        if name in self.brick.built.motors or name in self.brick.built.sensors:
            raise no_device(self.brick.hint(SENSOR_CLASS))

    def on(self, brightness: float = 100) -> None:
        """Turn the connected light on with a brightness in percent."""
        show_light(self.port.device_port, whole(brightness))

    def off(self) -> None:
        """Turn the connected light off."""
        self.on(0)


class ColorSensor(Sensor):
    """The colour sensor of SPIKE Prime."""

    KIND = "color"
    SWITCH_US = 30_000
    lights = Lights()
    _colors: Sequence[Any] = [
        Color[name] for name in ("RED", "YELLOW", "GREEN", "BLUE", "WHITE", "NONE")
    ]

    def __init__(self, port: Port) -> None:
        super().__init__(port)
        self._sensor.mode = ""

    def _read_light(self, convert: Callable[..., Result]) -> Result:
        """Measure red, green and blue, each from 0 to `HUB_WHITE`, and return `convert(red, green, blue)`.

        While a task runs, return an object to await instead.
        """
        assert isinstance(self._sensor, ColorDevice)
        channels = self._sensor.channels
        return self._read_as("RGB-RAW", lambda _: convert(*color.measure_hub_channels(channels())))

    def reflection(self) -> int:
        """Return the reflected light in percent."""
        return self._read_light(lambda *channels: int(sum(channels) * 100 // (3 * color.HUB_WHITE)))

    def ambient(self) -> int:
        """Return the ambient light in percent."""
        return self._read_as("COL-AMBIENT", int)

    def _read_hsv(self, surface: bool, convert: Callable[[tuple[int, int, int]], Result]) -> Result:
        """Measure hue, saturation and value, and return the result of `convert` for them.

        While a task runs, return an object to await instead.

        Args:
            surface: Whether to measure with the sensor's light; without it, only the ambient light is measured, as a
                grey.
            convert: Takes a tuple of hue in degrees, and saturation and value in percent.
        """
        if surface:
            return self._read_light(lambda *channels: convert(measure_hsv(*channels)))
        return self._read_as("COL-AMBIENT", lambda percent: convert((0, 0, percent)))

    def hsv(self, surface: bool = True) -> Any:
        """Return hue, saturation and value of what the sensor sees, as a `Color`.

        `surface` says whether the sensor's own light is on; without it, the ambient light is measured, as a grey.
        """
        return self._read_hsv(surface, lambda measured: Color(*measured))

    def color(self, surface: bool = True) -> Any:
        """Return the detectable colour that is nearest to what the sensor sees.

        `surface` says whether the sensor's own light is on; without it, the ambient light is measured, as a grey.
        """
        return self._read_hsv(surface, lambda measured: find_nearest(measured, self._colors))

    def detectable_colors(self, colors: Any = None) -> Sequence[Any] | None:
        """Set the colours from which `color` chooses, and return None; without an argument, return these colours."""
        if colors is None:
            return (*self._colors,)
        self._colors = tuple(colors)
        return None


class UltrasonicSensor(Sensor):
    """The distance sensor of SPIKE Prime."""

    KIND = "ultrasonic"
    SWITCH_US = 50_000
    lights = Lights()

    def distance(self) -> int:
        """Return the distance to the next object in mm, at most 2000; 2000 if there is none."""
        return self._read_as("US-DIST-CM", lambda distance_mm: min(FARTHEST_MM, distance_mm))

    def presence(self) -> bool:
        """Return whether the sensor hears another ultrasonic sensor."""
        return self._read_as("US-LISTEN", bool)


class ForceSensor(Sensor):
    """A force sensor, which is always pressed with its full force or not at all."""

    KIND = "touch"

    def _push(self, pressed: Result, released: Result) -> Result:
        return self._read_as("TOUCH", lambda is_pressed: pressed if is_pressed else released)

    def force(self) -> float:
        """Return the force on the sensor in newtons: `MAX_FORCE_N` while it is pressed, else 0."""
        return self._push(MAX_FORCE_N, 0.0)

    def distance(self) -> float:
        """Return how far the sensor's button is pushed in, in mm: `MAX_PRESS_MM` while it is pressed, else 0."""
        return self._push(MAX_PRESS_MM, 0.0)

    def pressed(self, force: float = 3) -> bool:
        """Return whether the sensor is pressed with at least `force` newtons."""
        return self._push(force <= MAX_FORCE_N, force <= 0)

    def touched(self) -> bool:
        """Return whether the sensor is touched."""
        return self._push(True, False)
