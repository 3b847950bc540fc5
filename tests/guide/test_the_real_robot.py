"""The tables of the page The real robot: what was measured on bricks, and beside it what comes out here."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest

from tests.engine.core.driver.lab import MS, give
from tuisim.engine.core.driver.jiffies import JIFFY_US, STEP_US, Jiffies, round_up
from tuisim.engine.core.driver.motor import STATES, Command, DriverMotor
from tuisim.engine.core.driver.plant import NS_PER_S, STEP_NS
from tuisim.engine.core.driver.regulator import MODELS, StopAction
from tuisim.engine.core.driver.simulated import load_wheel
from tuisim.guide.catalogue import load_pages
from tuisim.settings.robots import ROBOTS

ROBOT = ROBOTS["Default_Robot"]
CLOCKS = [Jiffies(first, us) for first in range(64) for us in range(0, JIFFY_US, STEP_US)]
"""All clocks that make a difference of up to 64 jiffies."""

Cells = tuple[str, ...]


def rows_of(title: str) -> list[Cells]:
    """Return the rows of the table in a section of the page."""
    section = (
        load_pages()["the-real-robot"].source.partition(f"## {title}\n")[2].partition("\n## ")[0]
    )
    table = [line for line in section.splitlines() if line.startswith("| ")]
    return [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in table[2:]]


def build_motor(battery_v: float, kind: str = "large", clock: Jiffies | None = None) -> DriverMotor:
    model = MODELS[kind]
    return DriverMotor(model, model.plant, battery_v, clock or Jiffies())


def build_wheel() -> DriverMotor:
    """Return a motor of the usual robot, with a wheel and its share of the robot."""
    model = MODELS["large"]
    return DriverMotor(model, load_wheel(model.plant, ROBOT), ROBOT.battery_v, Jiffies())


def watch(motor: DriverMotor, begin_s: float, end_s: float) -> list[float]:
    """Run a motor, and return its angle after each step of the control, in degrees."""
    angles_deg = []
    for time_ns in range(round(begin_s * NS_PER_S), round(end_s * NS_PER_S), STEP_NS):
        motor.run_until(time_ns + STEP_NS)
        motor.move_axle(time_ns + STEP_NS)
        angles_deg.append(motor.axle.angle_deg - 0.125)
    return angles_deg


def fit_line(points: list[tuple[float, float]]) -> tuple[float, float]:
    """Return slope and zero of the line with the least squares."""
    count = len(points)
    sum_x = sum(x for x, _ in points)
    sum_y = sum(y for _, y in points)
    slope = (count * sum(x * y for x, y in points) - sum_x * sum_y) / (
        count * sum(x * x for x, _ in points) - sum_x**2
    )
    return slope, (sum_x - sum_y / slope) / count


def after(cell: str) -> str:
    """Return what a cell says of the simulation, behind the measurement."""
    return cell.rpartition(" / ")[2]


STEPS = rows_of("A free large motor at a fixed duty")


@pytest.mark.parametrize("row", STEPS, ids=[row[0].partition("]")[0] + row[1] for row in STEPS])
def test_the_guides_row_of_a_step_response_is_what_comes_out(row: Cells) -> None:
    points = []
    constants_ms = []
    for duty in range(20, 101, 10):
        motor = build_motor(float(row[2]))
        give(motor, 0, Command.RUN_DIRECT, duty=duty)
        angles_deg = watch(motor, 0, 1)
        speed_dps = 2 * (angles_deg[-1] - angles_deg[249])
        points.append((float(duty), speed_dps))
        constants_ms.append(1000 * (1 - angles_deg[-1] / speed_dps))
    slope, zero = fit_line(points)
    assert max(constants_ms) - min(constants_ms) < 1
    here = (f"{slope:.2f}", f"{zero:.1f}", f"{constants_ms[0]:.0f}", f"{points[-1][1]:.0f}")
    assert tuple(after(cell) for cell in row[3:]) == here


@pytest.mark.parametrize("speed_dps", [100, 200, 300, 500])
def test_the_guides_row_of_a_start_is_what_comes_out(speed_dps: int) -> None:
    motor = build_motor(8.0)
    give(motor, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    angles_deg = [0.0, *watch(motor, 0, 2)]
    shares = [
        (after_deg - before_deg) / STEP_NS * NS_PER_S / speed_dps
        for before_deg, after_deg in pairwise(angles_deg)
    ]
    fast_ms = next(step * 2 for step, share in enumerate(shares, 1) if share >= 0.9)
    steady_ms = max(step * 2 for step, share in enumerate(shares, 1) if abs(share - 1) > 0.03)
    assert 64 <= fast_ms <= 68
    assert 1.145 <= max(shares) <= 1.215
    assert 200 <= steady_ms <= 310


def turn_timed(battery_v: float, speed_dps: int, time_ms: int) -> list[int]:
    """Return the least and the greatest position in which a free motor ends, by the phase of the kernel's clock."""
    by_end = sorted(CLOCKS, key=lambda clock: clock.find_expiry_ns(0, round_up(time_ms)))
    positions = []
    for clock in (by_end[0], by_end[-1]):
        motor = build_motor(battery_v, clock=clock)
        setpoints = {"speed_dps": speed_dps, "time_ms": time_ms, "stop_action": StopAction.HOLD}
        give(motor, 0, Command.RUN_TIMED, **setpoints)
        watch(motor, 0, time_ms / 1000 + 2)
        positions.append(motor.position)
    return positions


TIMED = rows_of("Moves by time")


@pytest.mark.parametrize("row", TIMED, ids=[row[0] for row in TIMED])
def test_the_guides_row_of_a_move_by_time_is_what_comes_out(row: Cells) -> None:
    least, most = turn_timed(8.0, int(row[0]), int(row[1]))
    assert row[3] == f"{least}–{most}"


def find_top_speed(battery_v: float, kind: str) -> str:
    motor = build_motor(battery_v, kind)
    give(motor, 0, Command.RUN_DIRECT, duty=100)
    first, second = watch(motor, 0, 2)[-2:]
    return f"{(second - first) / STEP_NS * NS_PER_S:.0f} deg/s"


def find_turns(speed_dps: int, time_ms: int) -> str:
    least, most = turn_timed(8.0, speed_dps, time_ms)
    return f"{least / 360:.2f}–{most / 360:.2f} turns"


def find_proportional(speed_dps: int) -> str:
    """Return which speed a motor reads that is controlled without the sum of the errors."""
    motor = build_motor(7.4)
    motor.speed_control.ki = 0
    give(motor, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    watch(motor, 0, 1)
    speeds_dps = []
    for part in range(100):
        watch(motor, 1 + part / 100, 1.01 + part / 100)
        speeds_dps.append(motor.speed_dps)
    return f"{sum(speeds_dps) / len(speeds_dps):.0f} deg/s"


def find_duration(speed_dps: int, position: int) -> str:
    motor = build_motor(8.0)
    give(motor, 0, Command.RUN_TO_REL_POS, speed_dps=speed_dps, position=position)
    time_ns = 0
    while motor.is_running:
        time_ns += STEP_NS
        motor.run_until(time_ns)
    return f"{time_ns / NS_PER_S:.1f} s"


def find_swing(speed_dps: int, position: int) -> str:
    motor = build_motor(8.0)
    setpoints = {"speed_dps": speed_dps, "position": position, "stop_action": StopAction.HOLD}
    give(motor, 0, Command.RUN_TO_REL_POS, **setpoints)
    farthest_deg = max(watch(motor, 0, 2))
    return f"{farthest_deg - position:.0f} degrees too far, then rests at {motor.position}"


def find_breakaway() -> str:
    """Return at which duties a motor still stands, and at which it turns."""
    turned_deg = []
    for duty in range(1, 10):
        motor = build_motor(8.0)
        give(motor, 0, Command.RUN_DIRECT, duty=duty)
        turned_deg.append(watch(motor, 0, 1)[-1])
    stands = sum(angle_deg == 0 for angle_deg in turned_deg)
    assert all(angle_deg > 0 for angle_deg in turned_deg[stands:])
    return f"stands at {stands} %, turns at {stands + 1} %"


OTHERS: dict[str, Callable[[], str]] = {
    "top speed of a large motor, 8.38 V": lambda: find_top_speed(8.38, "large"),
    "top speed of a medium motor, 8.38 V": lambda: find_top_speed(8.38, "medium"),
    "a large motor that starts": find_breakaway,
    "36 s at 100 deg/s": lambda: find_turns(100, 36_000),
    "10 s at 900 deg/s": lambda: find_turns(900, 10_000),
    "Kp 1000, Ki 0, 200 deg/s, 7.4 V": lambda: find_proportional(200),
    "Kp 1000, Ki 0, 500 deg/s, 7.4 V": lambda: find_proportional(500),
    "1408 degrees at 92 deg/s": lambda: find_duration(92, 1408),
    "200 degrees at 510 deg/s, `hold`": lambda: find_swing(510, 200),
}


@pytest.mark.parametrize("what", OTHERS)
def test_the_guides_rows_of_other_measurements_are_what_comes_out(what: str) -> None:
    named = {row[0]: row for row in rows_of("Other measurements")}
    assert set(named) == set(OTHERS)
    assert named[what][3] == OTHERS[what]()


def stop_wheel(speed_dps: int, action: StopAction, duration_s: float) -> list[float]:
    """Return how far a wheel turns after a stop in full run, in degrees after each step of the control."""
    wheel = build_wheel()
    give(wheel, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    before_deg = watch(wheel, 0, 2)[-1]
    give(wheel, 2000 * MS, Command.STOP, stop_action=action)
    target_deg = before_deg
    if action is StopAction.HOLD:
        assert "holding" in STATES[wheel.state_bits]
        target_deg = float(wheel.position)
    return [angle_deg - target_deg for angle_deg in watch(wheel, 2, 2 + duration_s)]


STOPS = rows_of("Where a robot stops")


@pytest.mark.parametrize("row", STOPS, ids=[row[0] for row in STOPS])
def test_the_guides_row_of_a_stop_is_what_comes_out(row: Cells) -> None:
    speed_dps = int(row[0])
    held_deg = stop_wheel(speed_dps, StopAction.HOLD, 1.5)
    farthest_deg = max(held_deg)
    back_deg = min(held_deg[held_deg.index(farthest_deg) :])
    late = [step for step, angle_deg in enumerate(held_deg, 1) if abs(angle_deg) > 1.5]
    braked_deg, coasted_deg = (
        stop_wheel(speed_dps, action, 20)[-1] for action in (StopAction.BRAKE, StopAction.COAST)
    )
    assert row[1:] == (
        f"{farthest_deg:.0f}",
        f"{max(-back_deg, 0):.0f}",
        f"{late[-1] * STEP_NS / NS_PER_S:.2f}",
        f"{braked_deg:.0f}",
        f"{coasted_deg:.0f}",
    )


def test_the_guides_row_of_late_ends_of_timed_moves_is_what_comes_out() -> None:
    for row in rows_of("When a move by time ends"):
        time_ms = int(float(row[0]) * 1000)
        late_ms = [
            round(clock.find_expiry_ns(0, round_up(time_ms)) / MS) - time_ms for clock in CLOCKS
        ]
        assert row[1] == f"{min(late_ms)}–{max(late_ms)}"
