"""Builds the brick of a robot: the simulated devices and their ports.

Mode and device of a port can be set as far as they match the connected device. A setting that
would disconnect or exchange the device is refused with a message that names it.
"""

from __future__ import annotations

import errno
from dataclasses import field
from functools import partial

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.core.motors import Motor
from tuisim.engine.core.sensors import list_mounted
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.spec import (
    INPUT_PORTS,
    NO_PORT,
    OUTPUT_PORTS,
    MotorSpec,
    RobotSpec,
    SensorSpec,
)
from tuisim.engine.shim.device_files import DeviceFiles, SimDevice, refuse
from tuisim.engine.shim.driver_motor import DriverTacho
from tuisim.engine.shim.leds import LED_CLASS, Lights, led_name
from tuisim.engine.shim.motor import KINDS, BrowserTacho, ServoTacho, Tacho, TachoMotor
from tuisim.engine.shim.power import BATTERY, POWER_CLASS, Battery
from tuisim.engine.shim.sensors import DEVICES, ColorDevice, LegoSensor
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.unsupported.devices import PORT_MODES, of_driver

PORT_CLASS, MOTOR_CLASS, SENSOR_CLASS = "lego-port", "tacho-motor", "lego-sensor"
"""Classes of devices, by their kernel names."""
BOARD_CLASS = "board-info"
BOARD = "board0"
BOARD_INFO = {"model": "LEGO MINDSTORMS EV3", "type": "main", "hw_rev": "7", "rom_rev": "6"}
"""The attributes of the brick's board, with their values."""
CLASSES = (
    BOARD_CLASS,
    "dc-motor",
    LED_CLASS,
    PORT_CLASS,
    SENSOR_CLASS,
    POWER_CLASS,
    "servo-motor",
    MOTOR_CLASS,
)
"""All classes of devices, some of them always without a device on the simulated brick."""
AUTO = "auto"
"""The mode in which a port detects the connected device by itself."""


@dataclass(frozen=True, slots=True)
class PortKind:
    """What all input ports, or all output ports, have in common: driver, modes, and the status without a device."""

    driver_name: str
    modes: tuple[str, ...]
    empty: str
    """The status while nothing is connected."""


INPUT = PortKind(
    "ev3-input-port",
    (
        AUTO,
        "nxt-analog",
        "nxt-color",
        "nxt-i2c",
        "other-i2c",
        "ev3-analog",
        "ev3-uart",
        "other-uart",
        "raw",
    ),
    "no-sensor",
)
OUTPUT = PortKind("ev3-output-port", (AUTO, "tacho-motor", "dc-motor", "led", "raw"), "no-motor")


@dataclass(frozen=True, slots=True)
class Connection:
    """The device that is connected to a port: its driver, and the port mode that it needs."""

    driver_name: str
    mode: str
    """The mode of the port that the device needs."""


def find_connections(robot: RobotSpec) -> dict[str, Connection]:
    """Return the devices on the robot's ports, by short name such as `in1`."""
    motors = [motor for motor in robot.motors if motor.port != NO_PORT]
    connections = {
        motor.port: Connection(KINDS[motor.kind].driver_name, "tacho-motor") for motor in motors
    }
    for kind, sensor, *_ in list_mounted(robot):
        connections[sensor.port] = Connection(kind.driver_name, kind.port_mode)
    return connections


class LegoPort:
    """One port of the brick, by its short name such as `in1`, and the device that is connected to it."""

    def __init__(self, session: DeviceSession, port: str) -> None:
        self._session = session
        self._port = port
        self._kind = INPUT if port in INPUT_PORTS else OUTPUT
        self._mode = AUTO

    @property
    def _plugged(self) -> Connection | None:
        return find_connections(self._session.sim.spec.robot).get(self._port)

    def device(self) -> SimDevice:
        """Return the port as a device of `/sys/class/lego-port`, with its attributes."""
        return SimDevice(
            self._session,
            {
                "address": lambda: f"ev3-ports:{self._port}",
                "driver_name": lambda: self._kind.driver_name,
                "modes": lambda: " ".join(self._kind.modes),
                "mode": lambda: self._mode,
                "status": self._status,
            },
            {"mode": self._set_mode, "set_device": self._set_device},
        )

    def _status(self) -> str:
        if self._mode != AUTO:
            return self._mode
        return self._plugged.mode if self._plugged else self._kind.empty

    def _set_mode(self, text: str) -> None:
        if text not in self._kind.modes:
            raise refuse(text)
        self._session.command()
        if self._plugged is None and text in PORT_MODES:
            raise NotSimulated(*PORT_MODES[text].explain("ev3dev2.port.LegoPort.mode", text))
        if self._plugged is not None and text not in (AUTO, self._plugged.mode):
            raise NotSimulated(
                f"ev3dev2.port.LegoPort.mode: {text!r} would disconnect {self._plugged.driver_name} from {self._port}",
                f"{AUTO} or {self._plugged.mode}; NXT, I2C and analog devices are not simulated",
            )
        self._mode = text

    def _set_device(self, text: str) -> None:
        self._session.command()
        if self._mode in (AUTO, "raw"):
            raise OSError(errno.EOPNOTSUPP, "set_device")
        if (kind := of_driver(text)) is not None:
            raise NotSimulated(*kind.explain("ev3dev2.port.LegoPort.set_device", text))
        if self._plugged is None or text != self._plugged.driver_name:
            there = self._plugged.driver_name if self._plugged else "nothing"
            raise NotSimulated(
                f"ev3dev2.port.LegoPort.set_device: {there} is plugged into {self._port}, not {text}",
                "a robot file says what is on which port",
            )


def ports_hint(session: DeviceSession, class_name: str) -> str:
    """Return a hint for the error about a missing motor or sensor: which motors or sensors the robot has, by port.

    `class_name` is the kernel's name of the class of the missing device, such as `tacho-motor`. For devices other than
    motors and sensors, the hint is empty.
    """
    if class_name not in (MOTOR_CLASS, SENSOR_CLASS):
        return ""
    robot = session.sim.spec.robot
    devices = robot.motors if class_name == MOTOR_CLASS else robot.sensors
    ports = [device.port for device in devices]
    plugged = find_connections(robot)
    parts = [f"{port} {plugged[port].driver_name}" for port in sorted(plugged) if port in ports]
    there = f"This robot has: {', '.join(parts) or 'nothing of the kind'}."
    return f"{there} Another robot: -r ROBOT; `tuisim robots --from PROGRAM --out FILE` writes the program's own."


@dataclass(slots=True)
class BuiltBrick:
    """The simulated brick of a robot with the devices that are connected to it."""

    session: DeviceSession
    files: DeviceFiles
    lights: Lights
    battery: Battery
    colors: dict[str, ColorDevice] = field(default_factory=dict)
    """The brick's colour sensors, by the path of their device."""
    sensors: dict[str, LegoSensor] = field(default_factory=dict)
    """The drivers of the sensors, by port."""
    motors: dict[str, Motor] = field(default_factory=dict)
    """The simulated motors, by port."""
    tachos: dict[str, Tacho] = field(default_factory=dict)
    """The drivers of the motors, by port."""
    paths: dict[str, str] = field(default_factory=dict)
    """Paths of the devices on ports, by port."""
    _heard: list[LegoSensor] = field(default_factory=list)
    """All sensors: an ultrasonic sensor hears the other ones."""

    def connect_motor(self, motor: MotorSpec) -> None:
        """Add the device of a motor that the robot has on a port."""
        port = motor.port
        simulated = self.motors[port] = self.session.sim.motors_by_port[port]
        tacho = self.tachos[port] = tacho_of(self.session, simulated, port, motor.kind)
        self._add(MOTOR_CLASS, "motor", port, tacho.device())

    def connect_sensor(self, spec: SensorSpec) -> None:
        """Add the device of a sensor that the robot has on a port."""
        sensor = self.sensors[spec.port] = DEVICES[type(spec)](self.session, spec, self._heard)
        self._heard.append(sensor)
        path = self._add(SENSOR_CLASS, "sensor", spec.port, sensor.device())
        if isinstance(sensor, ColorDevice):
            self.colors[path] = sensor

    def _add(self, class_name: str, name: str, port: str, device: SimDevice) -> str:
        """Add a device under the next number of its class, and return its path.

        As in the kernel, the number of a removed device is not used again.
        """
        path = self.paths[port] = self.files.add_numbered(class_name, name, device)
        return path

    def disconnect(self, port: str) -> None:
        """Remove the device on a port of the brick."""
        path = self.paths.pop(port)
        del self.files.by_path[path]
        self.colors.pop(path, None)
        self.motors.pop(port, None)
        self.tachos.pop(port, None)
        if (sensor := self.sensors.pop(port, None)) is not None:
            self._heard.remove(sensor)

    def take_wheels(self) -> None:
        """Set `wheel_registers` of the session for the motors that drive the wheels now.

        The value is the method `registers` of each: it returns what the program has last written to the motor.
        """
        session = self.session
        wheels = zip(
            session.sim.spec.robot.wheel_motors, (session.sim.left, session.sim.right), strict=True
        )
        session.wheel_registers = tuple(
            (
                self.tachos.get(motor.port) or tacho_of(session, simulated, motor.port, motor.kind)
            ).registers
            for motor, simulated in wheels
        )


def build_brick(session: DeviceSession) -> BuiltBrick:
    """Return the brick of the run's robot, with its motors and sensors connected."""
    robot = session.sim.spec.robot
    built = BuiltBrick(session, DeviceFiles(CLASSES), Lights(session), Battery(session))
    brick = built.files
    # Devices are numbered by port, so that an object without an address finds the one on the first port.
    for motor in sorted(robot.motors, key=lambda found: found.port):
        if motor.port != NO_PORT:
            built.connect_motor(motor)
    built.take_wheels()
    for spec in sorted(robot.sensors, key=lambda found: found.port):
        built.connect_sensor(spec)
    for port in (*INPUT_PORTS, *OUTPUT_PORTS):
        brick.add_numbered(PORT_CLASS, "port", LegoPort(session, port).device())
    for name, light in built.lights.lights.items():
        brick.add(LED_CLASS, led_name(name), light.device())
    brick.add(POWER_CLASS, BATTERY, built.battery.device())
    brick.add(BOARD_CLASS, BOARD, board(session))
    return built


def board(session: DeviceSession) -> SimDevice:
    """Return the device of the brick's board, whose attributes name the kind of brick; reading them takes no time."""
    told = dict(BOARD_INFO)
    told["uevent"] = "\n".join(
        f"BOARD_INFO_{name.upper()}={value}" for name, value in BOARD_INFO.items()
    )
    return SimDevice(
        session,
        {name: partial(str, value) for name, value in told.items()},
        {},
        dict.fromkeys(told, 0),
    )


def tacho_of(session: DeviceSession, motor: Motor, port: str, kind: str) -> Tacho:
    """Return the simulated driver of a motor; the class of the motor determines the class of the driver.

    Args:
        session: The run.
        motor: The simulated motor.
        port: Such as `outA`.
        kind: One of `KINDS`.

    Raises:
        TypeError: there is no driver for this class.
    """
    match motor:
        case BrickMotor():
            return TachoMotor(session, motor, port, kind)
        case SimulatedMotor():
            return DriverTacho(session, motor, port, kind)
        case BrowserMotor():
            return BrowserTacho(session, motor, port, kind)
        case ServoMotor():
            return ServoTacho(session, motor, port, kind)
    raise TypeError(f"no driver for {type(motor).__name__}")
