"""Plugs in the devices that a program looks for, on ports where the robot has nothing that the program uses.

A part of the default robot that the program does not use is replaced; parts that the program's text names stay. A
program that catches the library's error about a missing device only tests which devices there are, so nothing is
plugged in for it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.robot import encode_parts
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.plugged import (
    LATE,
    LEFT,
    MOTOR_KIND_OF,
    MOTOR_PARTS,
    RIGHT,
    SENSOR_PARTS,
    PluggedPart,
)
from tuisim.engine.core.sensors import SENSORS
from tuisim.engine.core.spec import INPUT_PORTS, NO_PORT, OUTPUT_PORTS
from tuisim.engine.shim.brick import MOTOR_CLASS, SENSOR_CLASS, BuiltBrick
from tuisim.engine.shim.motor import KINDS

PART_OF_KIND = {kind: part for part, kind in MOTOR_KIND_OF.items()}
"""The name of the library's class for each kind of motor, such as `LargeMotor` for `large`."""


PART_OF_DRIVER = {
    **{KINDS[kind].driver_name: part for part, kind in MOTOR_PARTS.items()},
    **{
        kind.driver_name: part
        for part, spec in SENSOR_PARTS.items()
        for kind in SENSORS.values()
        if kind.spec is spec
    },
}
"""The name of the library's class for the motors or sensors of each driver, such as `LargeMotor` for
`lego-ev3-l-motor`.
"""
_PORT = re.compile(r"(?:ev3-ports:)?(out[A-D]|in[1-4])")


def find_port(address: object) -> str:
    """Return the port in an address that a program gives, such as `in1`; empty if it has none."""
    match = _PORT.fullmatch(address) if isinstance(address, str) else None
    return match[1] if match else ""


class Plugs:
    """The parts that tuisim plugs into the robot because a program looks for them, and the robot lacks them.

    Args:
        built: The brick.
    """

    def __init__(self, built: BuiltBrick) -> None:
        self._built = built
        self._session = built.session
        self.missing: type[Exception] = Exception
        """The class of error that the program's library raises for a device that is not connected."""
        self._late: frozenset[str] = frozenset()
        """Ports of the motors that a program named as its wheels only after a wheel had turned; they cannot become
        wheels any more.
        """

    def add_device(self, class_name: str, wanted: Mapping[str, Any]) -> bool:
        """Plug in the device that a library searches for; return whether the robot has it now.

        Args:
            class_name: Kernel name of the class that was searched.
            wanted: The values that the device must have, by attribute.
        """
        if wanted.keys() - {"driver_name", "address"} or class_name not in (
            MOTOR_CLASS,
            SENSOR_CLASS,
        ):
            return False
        drivers = wanted.get("driver_name", [])
        names = [drivers] if isinstance(drivers, str) else drivers
        known = [PART_OF_DRIVER[name] for name in names if name in PART_OF_DRIVER]
        # A program that names no kind of motor gets a large one.
        known += [PART_OF_KIND["large"]] if class_name == MOTOR_CLASS and not names else []
        if not known:
            return False
        address = wanted.get("address")
        port = self._choose_port(known[0]) if address is None else find_port(address)
        return bool(port) and self.add(known[0], port)

    def _choose_port(self, part: str) -> str:
        """Return a port for a part whose port the program does not name; empty if there is none.

        A free port is preferred; otherwise it is one whose part the program does not use.

        Args:
            part: The name of the part's class, such as `ColorSensor`.
        """
        ports = OUTPUT_PORTS if part in MOTOR_PARTS else INPUT_PORTS
        free = [port for port in ports if not self.find_path(port)]
        return next((port for port in (*free, *ports) if self._can_give_way(port)), "")

    def take_hold(self, path: str) -> None:
        """Remember that the program uses the device at a path, so that no other part replaces it."""
        if (device := self._built.files.by_path.get(path)) is not None:
            device.is_opened = True

    def refuse_value(self, path: str, number: int) -> NotSimulated | None:
        """Return the error for reading a value that no mode of a sensor has; None if a mode has it.

        Args:
            path: The path of the sensor's device.
            number: The number of the value, such as 3 for `value3`.
        """
        found = (
            sensor for port, sensor in self._built.sensors.items() if self.find_path(port) == path
        )
        return next((sensor.refuse_value(number) for sensor in found), None)

    def find_path(self, port: str) -> str:
        """Return the path of the device on a port; empty if there is none."""
        return self._built.paths.get(port, "")

    def add(self, part: str, port: str) -> bool:
        """Plug in a part; return whether the robot has it now.

        Args:
            part: The name of the part's class, such as `ColorSensor`.
            port: The port that the program names, such as `in1`.
        """
        if self._session.shown_ports is None or not self._can_give_way(port):
            return False
        robot = self._session.sim.spec.robot
        wheels = (robot.left_port, robot.right_port)
        if port in wheels and self._session.sim.has_driven:
            return False
        if part == "GyroSensor" and robot.gyro and not self._can_give_way(robot.gyro.port):
            # A robot has at most one gyro, and the program uses that.
            return False
        if self._session.is_tried(self.missing):
            return False
        parts = [self._session.describe_part(port, part, LATE if port in self._late else "")]
        if port in wheels:
            # The robot loses this wheel, so the motor of the other wheel no longer drives the robot: it stays as a free
            # motor.
            parts += self._keep_wheels((port,))
        self._plug(parts)
        return True

    def make_wheels(self, left: str, right: str, part: str) -> None:
        """Plug in two motors as the robot's wheels.

        If a wheel has turned already, they will be plugged in later as motors without wheels, when the program uses
        them.

        Args:
            left, right: Their ports.
            part: The name of their class, such as `LargeMotor`.
        """
        session = self._session
        ports = (left, right)
        if session.shown_ports is None or left == right:
            return
        robot = session.sim.spec.robot
        wheels = (robot.left_port, robot.right_port)
        # If the program's text names two pairs of motors, one of them has been chosen as the wheels already: keep it.
        if ports == wheels or {*ports, *wheels} <= {*session.shown_ports}:
            return
        if not all(self._is_there(part, port) or self._can_give_way(port) for port in ports):
            return
        if session.is_tried(self.missing):
            return
        if self._can_change_wheels(ports):
            parts = [session.describe_part(left, part, LEFT)]
            parts += [session.describe_part(right, part, RIGHT), *self._keep_wheels(ports)]
            self._plug(parts)
        else:
            self._late |= {*ports}

    def _can_change_wheels(self, ports: Sequence[str]) -> bool:
        """Return whether motors on these ports can become the wheels.

        They cannot if a wheel, or another motor whose number would change, has turned already.
        """
        sim = self._session.sim
        others = [motor.port for motor in sim.spec.robot.extra_motors]
        first = min((others.index(port) for port in ports if port in others), default=len(others))
        return not sim.has_driven and not any(map(sim.has_turned, range(first, len(others))))

    def _is_there(self, part: str, port: str) -> bool:
        """Return whether the robot has a motor of the class with the name `part` on a port."""
        kind = MOTOR_KIND_OF[part]
        return any(
            (motor.port, motor.kind) == (port, kind)
            for motor in self._session.sim.spec.robot.motors
        )

    def _can_give_way(self, port: str) -> bool:
        """Return whether a port is free, or has a part of the default robot that the program does not use."""
        path = self._built.paths.get(port)
        if path is None:
            return True
        shown = self._session.shown_ports or ()
        return port not in shown and not self._built.files.by_path[path].is_opened

    def _keep_wheels(self, without: Sequence[str]) -> list[PluggedPart]:
        """Return those wheel motors that the program uses, described as motors that drive no wheel from now on.

        Args:
            without: Ports whose motors are left out.
        """
        return [
            self._session.describe_part(motor.port, PART_OF_KIND[motor.kind])
            for motor in self._session.sim.spec.robot.wheel_motors
            if motor.port not in (NO_PORT, *without) and not self._can_give_way(motor.port)
        ]

    def _plug(self, parts: Sequence[PluggedPart]) -> None:
        """Change the parts of the simulated robot, and add and remove devices of the brick accordingly."""
        built = self._built
        sim = self._session.sim
        before = sim.spec.robot
        obey(sim, self._session.now, 0, Call.PLUG, *encode_parts(parts))
        robot = sim.spec.robot
        simulated = sim.motors_by_port
        sensors = {sensor.port: sensor for sensor in robot.sensors}
        for port in [*built.paths]:
            if port in built.motors:
                stays = simulated.get(port) is built.motors[port]
            else:
                stays = sensors.get(port) in before.sensors
            if not stays:
                built.disconnect(port)
        for motor in robot.motors:
            if motor.port in simulated and motor.port not in built.paths:
                built.connect_motor(motor)
        for port, sensor in sensors.items():
            if port not in built.paths:
                built.connect_sensor(sensor)
        built.take_wheels()
        self._session.tell_plugged(parts)
