"""What is plugged into the brick's ports, and what a program is told that looks for something else."""

from __future__ import annotations

from tests.engine.shim.conftest import EYES, RunOn
from tuisim.engine.core.spec import NO_PORT, RobotSpec
from tuisim.engine.shim.brick import Connection, find_connections


def test_find_connections_gives_driver_and_mode_of_each_port() -> None:
    found = find_connections(EYES)
    assert found.keys() == {"outA", "outB", "outC", "outD", "in1", "in2", "in3", "in4"}
    assert (found["outA"], found["outD"]) == (
        Connection("lego-ev3-m-motor", "tacho-motor"),
        Connection("lego-ev3-l-motor", "tacho-motor"),
    )
    assert (found["in2"].driver_name, found["in2"].mode) == ("lego-ev3-touch", "ev3-analog")


def test_a_robot_without_wheels_has_empty_outputs() -> None:
    robot = RobotSpec(left_port=NO_PORT, right_port=NO_PORT)
    assert not [port for port in find_connections(robot) if port.startswith("out")]


PORTS = """
from ev3dev2.port import LegoPort
for name in ('outA', 'in2'):
    port = LegoPort(name)
    print(port.driver_name, port.mode, port.status)
"""


def test_a_program_reads_which_ports_are_empty_and_which_have_a_sensor(run_on: RunOn) -> None:
    assert run_on(PORTS, "default").lines == [
        "ev3-output-port auto no-motor",
        "ev3-input-port auto ev3-uart",
    ]


def test_looking_for_a_missing_device_names_the_devices_that_are_there(run_on: RunOn) -> None:
    done = run_on("from ev3dev2.sensor.lego import TouchSensor\nTouchSensor('in1')", "default")
    assert "This robot has: in1 " in done.errors[-1]
    assert "outB" not in done.errors[-1]
