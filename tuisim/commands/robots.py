"""`tuisim robots`: lists the named robots, or prints one as a file."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import asdict

from tuisim.commands.echo import echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.options import SwitchParser
from tuisim.config.robots import ROBOTS, load_robot, robot_file
from tuisim.core.spec import RobotSpec


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim robots`."""
    parser.description = "List the robots, or print one as TOML to start your own from."
    parser.add_argument("robot", nargs="?", metavar="NAME|FILE", help="print this robot as TOML")
    parser.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: Namespace) -> int:
    """Print the robots, or one as a file.

    Raises:
        RobotError: there is no such robot, or its file is wrong.
    """
    chosen = None if arguments.robot is None else load_robot(arguments.robot)
    if arguments.json:
        robots = [chosen] if chosen else ROBOTS.values()
        echo_json([asdict(robot) for robot in robots])
    elif chosen:
        echo_lines("\n".join(robot_file(chosen)))
    else:
        heads = ("NAME", "WHEELS", "WEIGHT", "COLOUR SENSORS x, y, diameter", "PORTS")
        echo_lines(table(heads, list(map(_row, ROBOTS.values()))))
    return 0


def _row(robot: RobotSpec) -> tuple[str, ...]:
    wheels = f"{robot.wheel_diameter_mm:g} mm, {robot.wheel_spacing_mm:g} mm apart"
    sensors = [f"{s.name} {s.x_mm:g}, {s.y_mm:g}, {s.diameter_mm}" for s in robot.color_sensors]
    ports = [
        (motor.port, wheel if motor.kind == "large" else f"{wheel} ({motor.kind} motor)")
        for motor, wheel in zip(robot.wheel_motors, ("left wheel", "right wheel"), strict=True)
    ]
    ports += [(motor.port, f"{motor.kind} motor") for motor in robot.extra_motors]
    ports += [(sensor.port, sensor.name) for sensor in robot.sensors]
    on_ports = ", ".join(f"{port} {name}" for port, name in sorted(ports))
    return robot.name, wheels, f"{robot.weight:g}", "; ".join(sensors), on_ports
