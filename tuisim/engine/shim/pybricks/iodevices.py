"""`Ev3devSensor` of `pybricks.iodevices`; its `DCMotor` is in `motor`."""

from __future__ import annotations

import errno

from tuisim.engine.core.spec import INPUT_PORTS
from tuisim.engine.shim.pybricks.ev3devices import Sensor
from tuisim.engine.shim.pybricks.parameters import Port


class Ev3devSensor(Sensor):
    """Any sensor on an input port, which is read by the modes of its ev3dev driver."""

    def __init__(self, port: Port) -> None:
        super().__init__(port)
        _, _, number = self.brick.plugs.find_path(port.device_port).rpartition("/sensor")
        self.sensor_index = int(number)
        """The number in the name of the sensor's folder in `/sys/class/lego-sensor`, such as 0 for `sensor0`."""
        self.port_index = INPUT_PORTS.index(port.device_port)
        """The index of the port among the brick's inputs: 0 for input 1."""

    def read(self, mode: str) -> tuple[int, ...]:
        """Return the values of a measurement in a mode such as `COL-REFLECT`. A change of mode takes time.

        Raises:
            OSError: the sensor has no such mode.
            NotSimulated: only a sensor that is not simulated has this mode.
        """
        if mode not in self._sensor.modes:
            try:
                self._sensor.set_mode(mode)
            except OSError:
                raise OSError(errno.EIO, f"EIO:\n\nThe sensor has no mode {mode!r}.") from None
        return self._read(mode)
