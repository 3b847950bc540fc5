"""Recordings of the driver's own code, and motors that go through the same again.

`reference.jsonl.xz` has a recording in each line: the motors with their loads, what was written to them, when their
states changed, and what a program could read every 10 ms, as differences.
"""

from __future__ import annotations

import json
import lzma
from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from math import inf
from pathlib import Path
from typing import Any

from tuisim.engine.core.driver.jiffies import Jiffies
from tuisim.engine.core.driver.motor import STATES, Command, DriverMotor, SetPoints
from tuisim.engine.core.driver.regulator import MODELS, StopAction

MS = 1_000_000
SAMPLE_MS = 10
SET_POINTS = {
    "speed_sp": "speed_dps",
    "position_sp": "position",
    "duty_cycle_sp": "duty",
    "time_sp": "time_ms",
    "ramp_up_sp": "ramp_up_ms",
    "ramp_down_sp": "ramp_down_ms",
}
"""Attributes that numbers are written to, with their fields."""
SIGNED = ("speed_sp", "position_sp", "duty_cycle_sp", "position")
POLARITIES = {"normal": 1, "inversed": -1}

Write = tuple[int, int, str, Any]
"""Milliseconds, number of the motor, attribute, value; `BLOCK` and `UNBLOCK` hold the wheel from outside."""


@dataclass(frozen=True)
class Samples:
    """What one motor showed every 10 ms, before the writes of that instant."""

    position: list[int]
    tenths_deg: list[int]
    """The true angle since the start."""
    speed: list[int]
    duty: list[int]


@dataclass(frozen=True)
class Recording:
    """What the driver's own code did."""

    battery_v: float
    jiffies: Jiffies
    motors: list[tuple[str, float, float]]
    """Kind, inertia and friction of the load."""
    writes: list[Write]
    states: list[list[Any]]
    """Milliseconds, number of the motor, and its state, at each change."""
    samples: list[Samples]


@cache
def load_recordings() -> dict[str, Recording]:
    """Return all recordings, by name."""
    path = Path(__file__).with_name("reference.jsonl.xz")
    with lzma.open(path, "rt", encoding="utf-8") as lines:
        return {row["id"]: _parse(row) for row in map(json.loads, lines)}


def _parse(row: dict[str, Any]) -> Recording:
    return Recording(
        row["battery_v"],
        Jiffies(*row["jiffies"]),
        row["motors"],
        [tuple(write) for write in row["writes"]],
        row["states"],
        [
            Samples(**{name: [*accumulate(column)] for name, column in columns.items()})
            for columns in row["samples"]
        ],
    )


class Bench:
    """The motors of a recording.

    Args:
        recording: What is done to them.
    """

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        self.motors: list[DriverMotor] = []
        for kind, inertia_kg_m2, friction_nm in recording.motors:
            model = MODELS[kind]
            plant = model.plant.add_load(inertia_kg_m2, friction_nm)
            self.motors.append(
                DriverMotor(model, plant, recording.battery_v, recording.jiffies),
            )
        self.signs = [1 for _ in self.motors]
        self.set_points: list[dict[str, Any]] = [{} for _ in self.motors]
        self.states: list[list[Any]] = []
        self._last_states: list[str | None] = [None for _ in self.motors]
        self.samples = [Samples([], [], [], []) for _ in self.motors]

    def run(self) -> Bench:
        """Do everything again."""
        writes = sorted(self.recording.writes, key=lambda write: write[0])
        self._look(0)
        for now_ms in range(SAMPLE_MS * len(self.recording.samples[0].position)):
            for motor in self.motors:
                motor.run_until(now_ms * MS)
            if now_ms % SAMPLE_MS == 0:
                self._sample()
            while writes and writes[0][0] == now_ms:
                self.write(*writes.pop(0))
            self._look(now_ms)
        return self

    def write(self, now_ms: int, number: int, name: str, value: Any) -> None:
        """Write one value."""
        motor = self.motors[number]
        value = value * self.signs[number] if name in SIGNED else value
        if name in SET_POINTS:
            self.set_points[number][SET_POINTS[name]] = value
            if name == "duty_cycle_sp":
                motor.set_duty(now_ms * MS, value)
            return
        match name:
            case "stop_action":
                self.set_points[number][name] = StopAction(value)
            case "command":
                set_points = SetPoints(**self.set_points[number])
                motor.obey(now_ms * MS, Command(value), set_points)
                if value == "reset":
                    self.signs[number], self.set_points[number] = 1, {}
            case "polarity":
                self.signs[number] = POLARITIES[value]
            case "position":
                renumber(motor, now_ms * MS, value)
            case "speed_pid/Ki":
                motor.wake(now_ms * MS)
                motor.speed_control.ki = value
            case "BLOCK":
                motor.wake(now_ms * MS)
                axle = motor.axle
                axle.low_deg = axle.high_deg = axle.angle_deg
                axle.speed_dps = 0.0
            case "UNBLOCK":
                motor.wake(now_ms * MS)
                motor.axle.low_deg, motor.axle.high_deg = -inf, inf
            case _:
                raise ValueError(name)

    def _look(self, now_ms: int) -> None:
        for number, motor in enumerate(self.motors):
            state = STATES[motor.state_bits]
            if self._last_states[number] != state:
                self._last_states[number] = state
                self.states.append([now_ms, number, state])

    def _sample(self) -> None:
        for motor, sign, samples in zip(self.motors, self.signs, self.samples, strict=True):
            samples.position.append(motor.position * sign)
            samples.tenths_deg.append(round(10 * round(motor.axle.angle_deg - 0.125, 1)))
            samples.speed.append(motor.speed_dps * sign)
            samples.duty.append(motor.duty * sign)


def renumber(motor: DriverMotor, time_ns: int, position: int) -> None:
    """Set the number that stands for the position at a time."""
    motor.wake(time_ns)
    motor.set_position(position)


def give(motor: DriverMotor, time_ns: int, command: Command, **setpoints: Any) -> None:
    """Set values and give a command; values that are not set stay."""
    motor.obey(time_ns, command, motor.active._replace(**setpoints))
