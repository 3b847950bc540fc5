"""Motors and drive bases move as the firmware's own control code did, to the last whole number of its reference.

`reference.jsonl.gz` has what that code recorded every 10 ms: the reference of the trajectory, when a call returned, and
where the motor ended.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.cases import for_each
from tests.engine.shim.pybricks.lab import TICK_NS, Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.servo.control import Controller
from tuisim.engine.core.servo.trajectory import MILLI, divide
from tuisim.engine.shim.pybricks import robotics, version_4
from tuisim.engine.shim.pybricks.motor import Motor
from tuisim.engine.shim.pybricks.parameters import Direction, Port, Stop
from tuisim.engine.shim.pybricks.robotics import DriveBase

VERSION_2: Any = SimpleNamespace(Motor=Motor, DriveBase=DriveBase)

with gzip.open(Path(__file__).with_name("reference.jsonl.gz"), "rt", encoding="utf-8") as _file:
    RECORDED = {one["id"]: one for one in map(json.loads, _file)}

WITHOUT_REFERENCE = {
    **dict.fromkeys(
        ("L_dc_20", "M_dc_20", "M_dc_50", "L_dc_100", "M_dc_100", "M_dc_-100"),
        "no control is active",
    ),
}
"""Recordings without a reference, with the reason."""
OF_THE_PLANT = {
    "L_run_angle_blocked": "the trajectory pauses when the blocked motor is behind",
    **dict.fromkeys(
        (
            "L_run_until_stalled_200_limit_None",
            "L_run_until_stalled_200_limit_30",
            "L_run_until_stalled_-300_limit_30",
            "L_run_until_stalled_-300_limit_100",
        ),
        "it ends when the blocked motor stalls",
    ),
    "L_reset_angle_while_running": "the new reference is the measured angle",
    "DB_drive_then_stop_then_straight": "it begins where the coasting robot is measured to be",
}
"""Recordings whose reference depends on the simulated motor, with the reason; each has a test of its rule below."""
PAUSED_FROM_MS = {"DB_settings_max": 1800}
"""From when on a trajectory has paused: at the highest acceleration the recorded motors fell behind."""
PLANT_FREE = [
    key
    for key in RECORDED
    if not key.startswith("v4") and key not in {*WITHOUT_REFERENCE, *OF_THE_PLANT}
]
LATEST_MS = 40
"""A call returned this long after the end of its trajectory at most."""


class Experiment:
    """One recording, made again with the classes of the library."""

    def __init__(self, key: str, stop_deg: float | None = None) -> None:
        self.recorded = RECORDED[key]
        law = MotorLaw.PYBRICKS_4 if key.startswith("v4") else MotorLaw.PYBRICKS
        kind = "medium" if key.removeprefix("v4_").startswith("M") else "large"
        self.lab = Lab(law, {"outA": kind, "outB": kind}, stop_deg)
        self.lab.until_ns = self.recorded["n"] * TICK_NS + TICK_NS // 2
        self.lab.looks.append(self._look)
        self.seen: list[tuple[int, list[tuple[int, int] | None]]] = []
        self.find_returned: list[tuple[str, int, Any]] = []
        robotics.DriveBase.current = None
        library = version_4 if key.startswith("v4") else VERSION_2
        direction = Direction.COUNTERCLOCKWISE if "ccw" in key else Direction.CLOCKWISE
        gears = {
            "L_gears_40_8_run_angle_1000_360": [40, 8],
            "v4_L_gears_12_36_run_angle_200_180": [12, 36],
        }.get(key)
        self.motor: Motor = library.Motor(Port.A, direction, gears)
        self.controls: list[Controller] = [self.motor.simulated.control]
        self.base: DriveBase | None = None
        if self.recorded["sizes"]:
            self.base = library.DriveBase(
                self.motor, library.Motor(Port.B), *self.recorded["sizes"]
            )
            self.controls = [self.base._base.distance, self.base._base.heading]
            if self.recorded["settings"]:
                self.base.settings(*self.recorded["settings"])
            if key == "v4_DB_settings_300_400":
                self.base.settings(300, 400)

    def _look(self, now_ms: int) -> None:
        found: list[tuple[int, int] | None] = []
        for control in self.controls:
            if control.trajectory is None:
                found.append(None)
                continue
            found.append((divide(control.milli(now_ms * 1000), MILLI), control.rate(now_ms * 1000)))
        self.seen.append((now_ms, found))

    def run(self) -> Experiment:
        try:
            for at_ms, call in self.recorded["commands"]:
                self.lab.spend(max(0, at_ms * 1_000_000 - self.lab.now))
                self._call(call)
            self.lab.spend(self.lab.until_ns - self.lab.now)
        except TimeoutError:
            pass
        return self

    def _call(self, call: str) -> None:
        name, _, words = call.rstrip(")").partition("(")
        owner = self.base or self.motor
        words = words.replace("duty_limit ", "duty_limit=")
        args, named = eval(
            f"given({words})", {"given": lambda *args, **named: (args, named), "Stop": Stop}
        )
        if "then" in named:
            named["then"] = version_4.Stop(named["then"])
        getattr(owner, name)(*args, **named)
        state = self.base.state() if self.base else self.motor.angle()
        self.find_returned.append((name, self.lab.now // 1_000_000, state))

    def references(self) -> Iterator[tuple[int, list[Any], list[Any]]]:
        """Yield the times, what was recorded, and what is now; each a position and a rate for each controller."""
        names = list(self.recorded["reference"])
        for at, (now_ms, found) in enumerate(self.seen):
            row = [self.recorded["reference"][name][at] for name in names]
            pairs = [row[i : i + 2] for i in range(0, len(row), 2)]
            yield now_ms, pairs, found


def in_units(experiment: Experiment, found: list[Any]) -> list[list[int]]:
    """Return references as a recording has them: of a drive base in mm and degrees."""
    if experiment.base is None:
        return [list(pair) for pair in found]
    return [
        [control.settings.units(pair[0]), control.settings.units(pair[1])]
        for control, pair in zip(experiment.controls, found, strict=True)
    ]


@for_each(key=PLANT_FREE)
def test_a_moves_reference_trajectory_equals_the_firmwares(key: str) -> None:
    experiment = Experiment(key).run()
    compared = 0
    held_ms = min(
        (at for call, at, _ in experiment.recorded["returned"] if call == "run_time"),
        default=1 << 30,
    )
    for now_ms, recorded, found in experiment.references():
        if None in found or recorded[0][0] is None:
            continue
        if now_ms >= min(held_ms, PAUSED_FROM_MS.get(key, held_ms)):
            # At the end of a timed move the motor holds where it is measured to be.
            break
        assert in_units(experiment, found) == recorded, now_ms
        compared += 1
    assert compared >= 3


RETURNING = [
    key
    for key in RECORDED
    if RECORDED[key]["returned"] and not key.startswith("v4") and key not in OF_THE_PLANT
]


def ends_ms(key: str) -> Iterator[tuple[int, int]]:
    """Yield when each call of a recording returned, and when it returns now."""
    experiment = Experiment(key).run()
    blocking = [
        at
        for name, at, _ in experiment.find_returned
        if name not in ("drive", "run", "stop", "brake", "dc")
    ]
    yield from zip([at for _, at, _ in experiment.recorded["returned"]], blocking, strict=True)


@for_each(key=RETURNING)
def test_each_move_call_returns_at_the_recorded_time(key: str) -> None:
    for recorded_ms, now_ms in ends_ms(key):
        assert 0 <= recorded_ms - now_ms <= LATEST_MS


HELD = [key for key in RETURNING if not key.endswith(("COAST", "BRAKE"))]
SETTLED_FAR = {
    "M_run_angle_200_360": 2,
    "M_run_angle_500_5": 2,
    "M_run_time_500_1000_HOLD": 5,
    "L_run_time_500_100_HOLD": 2,
}
"""The recorded medium motor came to rest this far from its target: its friction is 20 % of its power. A timed move ends
where the motor was measured to be."""


@for_each(key=HELD)
def test_a_held_motor_ends_where_the_recorded_one_did(key: str) -> None:
    experiment = Experiment(key).run()
    now = experiment.base.state()[::2] if experiment.base else (experiment.motor.angle(),)
    for recorded, found in zip(experiment.recorded["final"][1:], now, strict=True):
        assert abs(recorded - found) <= SETTLED_FAR.get(key, 1)


@for_each(key=[key for key in RECORDED if RECORDED[key]["usual"]])
def test_default_settings_and_limits_equal_those_of_the_firmware(key: str) -> None:
    experiment = Experiment(key)
    base = experiment.base
    usual = RECORDED[key]["usual"]
    assert base is not None
    made = base.settings()
    if not RECORDED[key]["settings"] and key != "v4_DB_settings_300_400":
        names = ("straight_speed", "straight_acceleration", "turn_rate", "turn_acceleration")
        assert made == tuple(usual[name] for name in names)
    if limits := RECORDED[key]["limits"]:
        speed, acceleration, _ = base.distance_control.limits() or (0, 0, 0)
        turn_rate, turn_acceleration, _ = base.heading_control.limits() or (0, 0, 0)
        assert [speed, acceleration, turn_rate, turn_acceleration] == [*limits.values()]


# Recordings that depend on the simulated motor: their rules


def test_a_blocked_moves_trajectory_pauses_and_the_call_never_returns() -> None:
    experiment = Experiment("L_run_angle_blocked", stop_deg=68.0).run()
    at = RECORDED["L_run_angle_blocked"]["reference"]["ref_count"][-1]
    assert experiment.motor.simulated.control.stalled
    assert not experiment.motor.control.done()
    position, rate = experiment.seen[-1][1][0] or (0, 0)
    # The proportional part alone uses up the power from 25 counts on.
    assert abs(position - at) <= 3 and rate == 600
    assert experiment.seen[-1][1] == experiment.seen[-50][1]


def test_a_move_against_an_end_stop_never_returns_and_says_why() -> None:
    lab = Lab(MotorLaw.PYBRICKS, {"outA": "large"}, stop_deg=68.0)
    lab.until_ns = 60_000 * 1_000_000
    with pytest.raises(TimeoutError):
        Motor(Port.A).run_angle(300, 180)
    assert (
        lab.held_up
        == "the motor on outA is stalled: run_angle() waits until the way is free, as on the brick"
    )


@pytest.mark.parametrize("key", [key for key in OF_THE_PLANT if "until_stalled" in key])
def test_a_stalled_motor_stops_when_the_recorded_one_did(key: str) -> None:
    experiment = Experiment(key, stop_deg=125.0).run()
    (_, recorded_ms, recorded), (_, now_ms, now) = (
        experiment.recorded["returned"][0],
        experiment.find_returned[0],
    )
    assert abs(now) == 125 and abs(recorded[0]) in range(122, 130)
    assert abs(now_ms - recorded_ms) <= 110
    assert experiment.motor.simulated.guide is None


def test_resetting_a_motors_angle_ends_its_motion() -> None:
    experiment = Experiment("L_reset_angle_while_running").run()
    assert experiment.motor.angle() == 0
    assert experiment.motor.control.done() and experiment.motor.simulated.guide is not None


def test_after_a_stop_a_move_begins_where_the_robot_is() -> None:
    experiment = Experiment("DB_drive_then_stop_then_straight").run()
    # The recorded robot was 2 mm behind its reference.
    assert (
        abs(experiment.base.state()[0] - experiment.recorded["final"][1]) <= 2
        if experiment.base
        else False
    )


@pytest.mark.parametrize("key", WITHOUT_REFERENCE)
def test_power_drives_a_motor_as_far_as_the_recorded_one(key: str) -> None:
    experiment = Experiment(key).run()
    assert experiment.motor.simulated.position_deg == pytest.approx(
        experiment.recorded["final"][1], rel=0.01
    )


@for_each(
    key=[
        key
        for key in RECORDED
        if key.startswith(("L_run_", "M_run_")) and "stop" in str(RECORDED[key]["commands"])
    ]
)
def test_a_motor_coasts_about_as_far_as_the_recorded_one(key: str) -> None:
    experiment = Experiment(key).run()
    assert experiment.motor.simulated.position_deg == pytest.approx(
        experiment.recorded["final"][1], abs=12
    )


# Version 4


OF_VERSION_4 = [key for key in RECORDED if key.startswith("v4") and RECORDED[key]["returned"]]


@for_each(key=OF_VERSION_4)
def test_version_4_moves_within_the_bands_of_its_own_tests(key: str) -> None:
    experiment = Experiment(key, stop_deg=125.0 if "stalled" in key else None).run()
    for (_, recorded_ms, state), (_, now_ms, found) in zip(
        experiment.recorded["returned"], experiment.find_returned, strict=True
    ):
        assert abs(recorded_ms - now_ms) <= 60 + recorded_ms // 100
        for recorded, now in zip(
            state[::2], found[::2] if experiment.base else [found], strict=True
        ):
            assert abs(recorded - now) <= 10
