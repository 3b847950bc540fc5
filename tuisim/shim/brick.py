"""Builds the brick of a robot: the simulated devices and their ports."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tuisim.core.brick_motor import BrickMotor
from tuisim.core.browser_motor import BrowserMotor
from tuisim.core.motors import Motor
from tuisim.core.parts import InfraredSpec, TouchSpec
from tuisim.core.spec import ColorSensorSpec, GyroSpec, UltrasonicSpec
from tuisim.shim.devices import Brick, SimDevice
from tuisim.shim.leds import LED_CLASS, Lights, led_name
from tuisim.shim.motor import BrowserTacho, TachoMotor
from tuisim.shim.ports import MOTOR_CLASS, PORT_CLASS, SENSOR_CLASS, all_ports
from tuisim.shim.power import BATTERY, POWER_CLASS, Battery
from tuisim.shim.sensors.color import ColorDevice, LegoSensor
from tuisim.shim.sensors.others import GyroDevice, infrared_sensor, touch_sensor, ultrasonic_sensor
from tuisim.shim.session import Session

DEVICES: Mapping[type, Callable[[Session, Any, Sequence[LegoSensor]], LegoSensor]] = {
    ColorSensorSpec: lambda session, spec, _others: ColorDevice(session, spec),
    UltrasonicSpec: ultrasonic_sensor,
    GyroSpec: lambda session, spec, _others: GyroDevice(session, spec),
    TouchSpec: lambda session, spec, _others: touch_sensor(session, spec),
    InfraredSpec: lambda session, spec, _others: infrared_sensor(session, spec),
}
"""Factories of sensor devices, by class of spec: they take the session, the spec and the sensors made before."""


def build_brick(session: Session) -> tuple[Brick, dict[str, ColorDevice]]:
    """Build the brick and connect the robot's motors and sensors.

    Returns:
        The brick, and its colour sensors by device path.
    """
    brick, robot, sim = Brick(), session.sim.spec.robot, session.sim
    motors = zip(robot.motors, (sim.left, sim.right, *sim.others), strict=True)
    # Sorted by port, so that a class without an address finds the first port.
    for at, (motor, simulated) in enumerate(sorted(motors, key=lambda found: found[0].port)):
        brick.add(MOTOR_CLASS, f"motor{at}", _motor_device(session, simulated, motor.port, motor.kind))
    colors: dict[str, ColorDevice] = {}
    sensors: list[LegoSensor] = []
    for at, spec in enumerate(sorted(robot.sensors, key=lambda found: found.port)):
        sensor = DEVICES[type(spec)](session, spec, sensors)
        sensors.append(sensor)
        brick.add(SENSOR_CLASS, f"sensor{at}", sensor.device())
        if isinstance(sensor, ColorDevice):
            colors[f"/sys/class/{SENSOR_CLASS}/sensor{at}"] = sensor
    for at, socket in enumerate(all_ports(session)):
        brick.add(PORT_CLASS, f"port{at}", socket)
    for name, light in Lights(session).lights.items():
        brick.add(LED_CLASS, led_name(name), light.device())
    brick.add(POWER_CLASS, BATTERY, Battery(session).device())
    return brick, colors


def _motor_device(session: Session, motor: Motor, port: str, kind: str) -> SimDevice:
    match motor:
        case BrickMotor():
            return TachoMotor(session, motor, port, kind).device()
        case BrowserMotor():
            return BrowserTacho(session, motor, port, kind).device()
    raise TypeError(f"no driver for {type(motor).__name__}")
