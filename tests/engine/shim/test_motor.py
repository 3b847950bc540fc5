"""Programs on robots as real ones are built: reversed wheels, gears, arms with end stops and what they press."""

from __future__ import annotations

import pytest

from tests.engine.shim import table_groups, table_motor
from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import START, RunOn
from tuisim.engine.runs.frames import build_telemetry_frame

BACKWARDS = """
from ev3dev2.motor import *
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on_for_rotations(-40, -40, 2)
print(tank.left_motor.position, tank.right_motor.position)
"""


def test_motors_mounted_the_other_way_round_drive_forwards_when_they_run_backwards(
    run_on: RunOn,
) -> None:
    done = run_on(BACKWARDS, "reversed")
    assert done.lines == ["-720 -720"]
    assert done.pose == pytest.approx((START.x_mm + 2 * 175.929, START.y_mm, 0.0), abs=0.01)


GEARED = """
from ev3dev2.motor import *
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on_for_rotations(40, 40, 2)
print(tank.left_motor.position, tank.left_motor.position)
"""


def test_a_wheel_turns_twice_as_far_with_a_gear_of_one_half(run_on: RunOn) -> None:
    done = run_on(GEARED, "geared")
    assert done.lines == ["720 720"]
    assert done.pose[0] == pytest.approx(START.x_mm + 4 * 175.929, abs=0.01)


HOMES = """
from ev3dev2.motor import *
from time import sleep, time
arm = MediumMotor(OUTPUT_A)
arm.on(-20)
while not arm.is_stalled:
    sleep(0.01)
print(arm.position, arm.speed, arm.state)
arm.off()
arm.position = 0
arm.on_to_position(30, 90)
print(arm.position, arm.state)
arm.run_forever(speed_sp=-300)
arm.wait_until_not_moving()
print(arm.position, arm.is_running)
since = time()
arm.on_for_seconds(50, 5)
print(arm.position, time() - since < 2, arm.is_stalled)
arm.on_for_degrees(-50, 400)
print(arm.position, arm.is_stalled)
arm.run_direct(duty_cycle_sp=30)
print(arm.wait_until('stalled', timeout=2000), arm.position)
arm.duty_cycle_sp = -30
print(arm.wait_until('stalled', timeout=2000), arm.position)
"""


def test_every_kind_of_wait_ends_when_an_arm_reaches_its_end_stop(run_on: RunOn) -> None:
    assert run_on(HOMES, "arm").lines == [
        "-90 0 ['running', 'overloaded', 'stalled']",
        "90 ['holding']",
        "0 True",
        "270 True True",
        "0 True",
        "True 270",
        "True 0",
    ]


def test_in_the_browser_simulators_profile_an_arm_at_its_stop_is_not_stalled(run_on: RunOn) -> None:
    waits = (
        HOMES.partition("arm.off()")[0]
        .replace("-20", "20")
        .replace("sleep(0.01)", "print(arm.state); sleep(9)")
    )
    assert run_on(waits, "arm", profile="nbev3devsim", time_limit_s=15.0).lines == [
        "running",
        "running",
    ]


PRESSED = """
from ev3dev2.motor import *
from ev3dev2.sensor.lego import TouchSensor
from time import sleep
arm, end = MediumMotor(OUTPUT_A), TouchSensor('in4')
print('Pressed:', end.value())
arm.on(-20)
end.wait_for_pressed()
arm.off()
sleep(0.01)
print('Pressed:', end.value())
arm.on_for_degrees(20, 45)
sleep(0.01)
print('Pressed:', end.value())
"""


def test_an_arm_presses_a_sensor_at_its_end_in_every_view_of_the_run(run_on: RunOn) -> None:
    done = run_on(PRESSED, "arm")
    run = done.run.stored()
    frame = build_telemetry_frame(run)
    pressed = frame["end_pressed"]
    told = [
        (row.tick, float(row.text.rpartition(" ")[2]))
        for row in run.output.rows()
        if row.stream == 1
    ]
    assert [value for _, value in told] == [0.0, 1.0, 0.0]
    assert [pressed[tick] for tick, _ in told] == [0.0, 1.0, 0.0]
    # One stretch, that ends with the move away from the stop.
    assert (pressed.diff() != 0).sum() == 3


TABLES: Tables = {
    "speeds": (table_motor.SPEEDS, "plain", "empty"),
    "motor": (table_motor.MOTOR, "eyes", "empty"),
    "motor set": (table_groups.SET, "plain", "empty"),
    "tank": (table_groups.TANK, "plain", "empty"),
    "steering": (table_groups.STEERING, "plain", "empty"),
    "differential": (table_groups.DIFFERENTIAL, "plain", "empty"),
}


@cases(TABLES)
def test_reversed_geared_and_blocked_motors_move_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
