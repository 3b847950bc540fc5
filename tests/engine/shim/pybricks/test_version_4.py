"""Version 4: moves that end otherwise, arcs, and tasks, in which nothing blocks."""

from __future__ import annotations

from typing import Any

import pytest

from tests.engine.shim.conftest import RunOn
from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks import robotics
from tuisim.engine.shim.pybricks.parameters import Port
from tuisim.engine.shim.pybricks.tools import StopWatch, wait
from tuisim.engine.shim.pybricks.version_4 import DriveBase, Motor, Stop, multitask, run_task


def call(function: Any, *given: Any) -> Any:
    """Call a blocking function in a task: its type says what it returns elsewhere."""
    return function(*given)


@pytest.fixture
def base() -> DriveBase:
    Lab(MotorLaw.PYBRICKS_4, {"outA": "large", "outB": "large", "outC": "medium"})
    robotics.DriveBase.current = None
    return DriveBase(Motor(Port.A), Motor(Port.B), 56, 114)


@pytest.mark.parametrize(
    "then, active", [(Stop.HOLD, True), (Stop.COAST, False), (Stop.BRAKE, False)]
)
def test_a_move_of_a_drive_base_ends_held_braked_or_coasting_as_asked(
    base: DriveBase, then: Stop, active: bool
) -> None:
    base.straight(100, then)
    # The brick tells the mean speed over 100 ms.
    distance, speed, *_ = base.state()
    assert distance == 100 and speed in range(18, 39)
    wait(100)
    assert base.state()[:2] == (100, 0)
    assert base._base.active == active


def test_a_move_refuses_a_stop_type_of_the_wrong_kind(base: DriveBase) -> None:
    with pytest.raises(TypeError, match="a Stop is needed, not"):
        call(base.straight, 100, Port.A)


def test_a_move_with_stop_none_keeps_driving_afterwards(base: DriveBase) -> None:
    base.straight(100, Stop.NONE)
    assert base.state()[1] == 156
    wait(1000)
    assert base.distance() == pytest.approx(257, abs=3)


def test_an_arc_between_moves_with_stop_none_turns_by_its_whole_angle(base: DriveBase) -> None:
    base.straight(300, Stop.NONE)
    base.curve(150, 90, Stop.NONE)
    base.straight(300)
    distance, _, angle, _ = base.state()
    assert distance == pytest.approx(837, abs=3)
    assert angle == pytest.approx(90, abs=1)
    base.straight(0, Stop.NONE)
    wait(500)
    assert base.state() == (distance, 0, angle, 0)


def test_a_move_with_wait_false_returns_before_it_is_done(base: DriveBase) -> None:
    base.turn(90, wait=False)
    assert not base.done()
    wait(2000)
    assert base.done() and base.angle() == pytest.approx(90, abs=0.2)
    base.turn(90, absolute=True)
    assert base.angle() == pytest.approx(90, abs=0.2)


def test_distance_and_angle_of_an_arc_stay_in_proportion(base: DriveBase) -> None:
    base.arc(200, angle=60, wait=False)
    for _ in range(8):
        wait(100)
        distance, _, angle, _ = base.state()
        assert angle == pytest.approx(distance / 200 * 57.3, abs=1.5)


@pytest.mark.parametrize(
    "given, message",
    [
        ((9, 90), "Invalid argument"),
        ((100, 90, 50), "Please specify distance or angle but not both"),
        ((100,), "Please specify distance or angle but not both"),
    ],
)
def test_an_arc_without_a_way_or_with_a_tiny_radius_is_refused(
    base: DriveBase, given: tuple[int, ...], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        call(base.arc, *given)


def test_two_drive_bases_cannot_have_the_same_motor(base: DriveBase) -> None:
    motors: tuple[Any, Any] = base.left, base.right
    with pytest.raises(OSError, match="EBUSY"):
        DriveBase(*motors, 56, 114)
    for left, track_mm in ((motors[1], 114), (motors[0], 0.9)):
        with pytest.raises(ValueError, match="Invalid argument"):
            DriveBase(left, motors[1], 56, track_mm)
    motors[0].close()
    DriveBase(*motors, 56, 114)


def test_a_motors_speed_is_the_mean_over_the_given_window(base: DriveBase) -> None:
    arm = Motor(Port.C)
    arm.run(200)
    wait(50)
    # From rest to 100 degrees per second in 50 ms.
    assert [arm.speed(), arm.speed(50), arm.speed(300)] == pytest.approx([25, 50, 8], abs=1)
    wait(350)
    assert arm.speed() == arm.speed(300) == 200
    arm.reset_angle(0)
    for window in (0, 301):
        with pytest.raises(ValueError, match="Invalid argument"):
            arm.speed(window)


def test_done_is_true_while_a_motor_or_drive_base_just_runs_on(base: DriveBase) -> None:
    base.drive(100, 20)
    arm = Motor(Port.C)
    arm.run(100)
    wait(100)
    assert base.done() and arm.done()


def test_a_new_number_for_the_angle_ends_a_move_as_it_would_have_ended(base: DriveBase) -> None:
    arm = Motor(Port.C)
    for then, is_held in ((Stop.HOLD, True), (Stop.COAST, False)):
        call(arm.run_angle, 200, 360, then, False)
        wait(500)
        arm.reset_angle(50)
        wait(200)
        assert (arm.simulated.guide is not None) == is_held
    assert base.done()


def test_a_smart_stop_ends_when_the_motors_rest(base: DriveBase) -> None:
    times_ms = {}
    for then in (Stop.HOLD, Stop.COAST, Stop.COAST_SMART, Stop.BRAKE_SMART):
        watch = StopWatch()
        base.straight(100, then)
        times_ms[then] = watch.time()
        wait(200)
        assert base._base.active == (then is Stop.HOLD)
    hold_ms = times_ms[Stop.HOLD]
    assert times_ms[Stop.COAST] < hold_ms - 10
    for then in (Stop.COAST_SMART, Stop.BRAKE_SMART):
        assert times_ms[then] == pytest.approx(hold_ms, abs=5)


def test_a_drive_bases_deceleration_stays_until_it_is_set_again(base: DriveBase) -> None:
    base.settings(straight_acceleration=(500, 600))
    base.settings(straight_speed=100)
    assert base.settings() == (100, (500, 600), 131, 737)
    base.settings(straight_acceleration=400)
    assert base.settings() == (100, 400, 131, 737)


def test_settings_of_a_drive_base_can_change_while_it_drives(base: DriveBase) -> None:
    base.drive(100, 0)
    base.settings(straight_speed=200)
    assert base.settings()[0] == 200  # type: ignore[index]


def test_tasks_of_multitask_run_at_the_same_time(base: DriveBase) -> None:
    watch, told = StopWatch(), list[tuple[str, Any]]()

    async def drive() -> str:
        await call(base.straight, 100)
        told.append(("driven", watch.time()))
        return "there"

    async def blink() -> None:
        for _ in range(3):
            await call(wait, 100)
        told.append(("blinked", watch.time()))

    async def main() -> Any:
        assert run_task()
        told.append(("both", await multitask(drive(), blink())))

    assert run_task(main()) is None
    assert told.pop() == ("both", ("there", None))
    assert [name for name, _ in told] == ["blinked", "driven"]
    assert [at for _, at in told] == pytest.approx([300, 875], abs=10)
    assert not run_task()


def test_multitask_with_race_ends_with_its_first_task(base: DriveBase) -> None:
    arm = Motor(Port.C)

    async def main() -> Any:
        return await multitask(call(arm.run_angle, 100, 3600), call(wait, 250), race=True)

    watch = StopWatch()
    run_task(main())
    assert watch.time() == 250
    # The move of the task that was closed has ended, too.
    assert arm.simulated.guide is None
    with pytest.raises(TypeError):
        run_task(5)


def test_tasks_that_wait_for_0_ms_take_turns(base: DriveBase) -> None:
    turns: list[str] = []

    async def wait_often(name: str) -> None:
        for _ in range(3):
            turns.append(name)
            await call(wait, 0)

    def rest() -> Any:
        turns.append("rest")
        yield
        return "rested"

    async def main() -> Any:
        turns.append(str(await multitask(wait_often("a"), wait_often("b"), rest())))

    run_task(main())
    assert turns[:6] == ["a", "b", "rest", "a", "b", "a"]
    assert turns[-1] == "(None, None, 'rested')"
    run_task(rest())
    assert base.done()


def test_a_loop_of_waits_of_0_ms_lets_simulated_time_pass(run_on: RunOn) -> None:
    text = (
        "from pybricks.parameters import Port\nfrom pybricks.pupdevices import Motor\n"
        "from pybricks.tools import StopWatch, multitask, run_task, wait\n"
        "motor, watch = Motor(Port.A), StopWatch()\n"
        "async def poll():\n    motor.run_angle(500, 360, wait=False)\n"
        "    while not motor.done():\n        await wait(0)\n"
        "async def main():\n    await multitask(poll(), wait(100))\nrun_task(main())\n"
        "print(watch.time() - 965)"
    )
    done = run_on(text, robot="hub", profile="pybricks4")
    assert int(done.lines[0]) in range(60), done.errors


def test_a_second_command_to_a_motor_ends_the_wait_for_its_first(base: DriveBase) -> None:
    arm, watch = Motor(Port.C), StopWatch()

    async def turn(angle: int, after: int) -> tuple[int, Any]:
        await call(wait, after)
        end = await call(arm.run_angle, 500, angle)
        return watch.time(), end

    async def drive(distance: int, after: int) -> tuple[int, Any]:
        await call(wait, after)
        end = await call(base.straight, distance)
        return watch.time(), end

    async def main() -> Any:
        times = await multitask(turn(3600, 0), turn(-90, 300), drive(1000, 0), drive(-10, 500))
        assert times[0] == (300, None) and times[2] == (500, None)
        assert times[1][0] > 700 and times[3][0] > 900

    run_task(main())
    assert arm.simulated.guide is not None


def test_a_command_to_a_motor_ends_another_tasks_wait_for_its_stall(base: DriveBase) -> None:
    arm = Motor(Port.C)

    async def find_stop() -> int:
        return await call(arm.run_until_stalled, 200)  # type: ignore[no-any-return]

    async def turn() -> None:
        await call(wait, 300)
        await call(arm.run_angle, 500, 90)

    async def main() -> Any:
        await multitask(find_stop(), turn())

    run_task(main())
    assert arm.angle() > 100 and arm.simulated.guide is not None
    assert base.done()


def test_a_task_that_waits_for_a_stall_is_closed_and_the_motor_runs_on(base: DriveBase) -> None:
    arm = Motor(Port.C)

    async def main() -> None:
        await multitask(call(arm.run_until_stalled, 200), call(wait, 250), race=True)

    run_task(main())
    assert arm.simulated.guide is None


def test_a_motor_that_is_run_until_it_stalls_has_no_move_under_way(base: DriveBase) -> None:
    arm = Motor(Port.C)

    async def watch() -> bool:
        await call(wait, 250)
        return arm.done() or arm.control.done()

    async def main() -> None:
        results = await multitask(call(arm.run_until_stalled, 200), watch(), race=True)
        assert results[1] is False

    run_task(main())
    assert arm.done()


def test_an_error_in_a_task_closes_the_others(base: DriveBase) -> None:
    arm = Motor(Port.C)

    async def fail() -> None:
        await call(wait, 100)
        raise ZeroDivisionError

    async def main() -> None:
        with pytest.raises(ZeroDivisionError):
            await multitask(call(arm.run_angle, 100, 3600), fail())
        assert arm.simulated.guide is None

    run_task(main())
    assert base.done()


def test_move_by_drives_to_a_position_given_by_x_and_y(base: DriveBase) -> None:
    base.move_by(100, 100)
    assert base.distance() == pytest.approx(141, abs=1)
    assert base.angle() == pytest.approx(-45, abs=0.5)

    async def main() -> None:
        await call(base.move_by, 100, 0)

    run_task(main())
    assert base.distance() == pytest.approx(241, abs=1)
    assert base.angle() == pytest.approx(0, abs=0.5)


def test_reset_sets_the_distance_and_angle_of_a_drive_base(base: DriveBase) -> None:
    base.straight(100)
    base.turn(90)
    base.reset(20, 30)
    assert base.distance() == 20
    assert base.angle() == pytest.approx(30, abs=0.2)
    base.straight(-50)
    assert base.distance() == -30


@pytest.mark.parametrize("port", [Port.A, Port.B])
def test_creating_a_motor_again_stops_its_drive_base(base: DriveBase, port: Port) -> None:
    base.drive(100, 0)
    wait(500)
    Motor(port, reset_angle=False)
    assert not base._base.active
    base.straight(50)
    assert bool(base._base.active)
    for _ in range(10):
        wait(100)
    assert base.done()
