"""python-ev3dev 1.2 drives the robot as it is: tables of its calls, each run as one program in the child."""

from __future__ import annotations

import sys

import pytest

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.table_older import BRICK, COLOR, MOTORS, SENSORS
from tuisim.engine.shim.ev3dev.older_library import MissingLibrary, surroundings

TABLES: Tables = {
    "motors": (MOTORS, "eyes", "empty"),
    "brick": (BRICK, "plain", "empty"),
    "sensors": (SENSORS, "eyes", "furnished"),
    "colour": (COLOR, "default", "red"),
}


@cases(TABLES)
def test_calls_of_the_older_library_do_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)


SQUARE = """
from ev3dev.auto import *
left, right = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
for side in range(4):
    for motor in (left, right):
        motor.run_to_rel_pos(position_sp=360, speed_sp=400, stop_action='hold')
    right.wait_while('running')
    for motor, way in ((left, 1), (right, -1)):
        motor.run_to_rel_pos(position_sp=270 * way, speed_sp=300, stop_action='hold')
    left.wait_until('holding')
    right.wait_until('holding')
"""


def test_a_square_driven_with_the_older_library_ends_where_it_began(run_on: RunOn) -> None:
    done = run_on(SQUARE, "plain")
    assert done.pose == pytest.approx((500.0, 571.5, -360.0), abs=0.5)
    assert done.errors == []


BY_DUTY = """
from time import sleep
from ev3dev.auto import *
left, right = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
for motor in (left, right):
    {}
sleep(1)
print(left.duty_cycle, right.duty_cycle)
"""


@pytest.mark.parametrize(
    ("commands", "duty"),
    [
        ("motor.run_forever(duty_cycle_sp=50)", "50 50"),
        ("motor.duty_cycle_sp = -30; motor.run_forever()", "-30 -30"),
        ("motor.run_forever(speed_sp=0, duty_cycle_sp=50)", "0 0"),
        ("motor.speed_sp = 0; motor.run_forever(duty_cycle_sp=50)", "0 0"),
        ("motor.run_forever()", "0 0"),
    ],
)
def test_a_motor_runs_by_its_duty_cycle_if_no_speed_was_ever_written(
    run_on: RunOn, commands: str, duty: str
) -> None:
    done = run_on(BY_DUTY.format(commands), "plain")
    assert (done.lines, done.errors) == ([duty], [])


REFUSED = """
import ev3dev.GyroBalancer, ev3dev.virtualterminal, ev3dev.webserver
def attempt(call):
    try:
        call()
    except Exception as error:
        print(type(error).__name__, str(error).split(' is ')[0])
for name in ('brickpi', 'brickpi3', 'pistorms'):
    attempt(lambda: __import__('ev3dev.' + name))
attempt(ev3dev.GyroBalancer.GyroBalancer)
attempt(ev3dev.virtualterminal.VirtualTerminal)
attempt(ev3dev.webserver.RobotWebServer)
"""


def test_using_a_part_of_ev3dev_1_that_is_not_simulated_raises_with_its_name(run_on: RunOn) -> None:
    names = (
        "brickpi",
        "brickpi3",
        "pistorms",
        "GyroBalancer.GyroBalancer",
        "virtualterminal.VirtualTerminal",
        "webserver.RobotWebServer",
    )
    assert run_on(REFUSED).lines == [f"NotSimulated ev3dev.{name}" for name in names]


def test_without_the_library_its_import_says_how_to_get_it() -> None:
    finder = MissingLibrary()
    with pytest.raises(
        ModuleNotFoundError, match=r"'ev3dev': pip install 'tuisim\[ev3dev\]' installs it"
    ) as caught:
        finder.find_spec("ev3dev")
    assert caught.value.name == "ev3dev"
    assert finder.find_spec("ev3dev2") is None


def test_the_stand_in_for_pkg_resources_is_gone_after_the_import(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delitem(sys.modules, "pkg_resources", raising=False)
    with surroundings():
        assert "__init__.py" in sys.modules["pkg_resources"].resource_listdir(
            "tuisim.engine.shim", ""
        )
    assert "pkg_resources" not in sys.modules
