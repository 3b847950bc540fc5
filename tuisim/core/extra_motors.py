"""Simulation of a robot with motors that do not drive its wheels."""

from __future__ import annotations

from collections.abc import Callable

from tuisim.core.motor_laws import motor_of
from tuisim.core.motors import Motor
from tuisim.core.simulation import Simulation
from tuisim.core.spec import RunSpec
from tuisim.core.tick_record import TickSink

Turn = tuple[float, float]
"""Position in degrees and speed in degrees per second, both at the axle."""

REPORT_DEG = 0.25
"""A motor farther than this from the position that its last report predicts is reported again."""


class FurtherMotors(Simulation):
    """A simulation whose robot has motors besides its two wheel motors. They do not change the pose.

    Args:
        spec: Robot, world, profile and seed.
        sink: Receives one record per tick, starting with tick 0.
    """

    __slots__ = ("_reported", "_reported_tick", "on_turns", "others")

    def __init__(self, spec: RunSpec, sink: TickSink) -> None:
        super().__init__(spec, sink)
        self.others: tuple[Motor, ...] = tuple(motor_of(spec, motor.kind) for motor in spec.robot.extra_motors)
        self.on_turns: Callable[[tuple[Turn, ...]], None] = lambda _: None
        """Called when a motor deviates from its last report; until then each motor turns at the reported speed."""
        self._reported: tuple[Turn, ...] = ((0.0, 0.0),) * len(self.others)
        self._reported_tick = 0

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Run ticks as `Motion.advance` does, one by one while an extra motor runs."""
        done = 0
        self._report_turns()
        while done < ticks and not all(motor.resting for motor in self.others):
            self.tick_once()
            done += 1
            if until_change and self.changed:
                return done
        return done + super().advance(ticks - done, until_change) if done < ticks else done

    def tick_once(self) -> None:
        """Run one tick of the robot, then of the extra motors."""
        super().tick_once()
        for motor in self.others:
            if not motor.resting:
                before = motor.mode
                motor.step(self.tick, 0.0)
                if motor.mode != before:
                    self.changed = True
        self._report_turns()

    def _report_turns(self) -> None:
        turns = tuple((motor.position_deg, motor.counting_dps) for motor in self.others)
        since_s = (self.tick - self._reported_tick) * self._tick_s
        if any(
            dps != before_dps or abs(position - before - before_dps * since_s) > REPORT_DEG
            for (position, dps), (before, before_dps) in zip(turns, self._reported, strict=True)
        ):
            self._reported, self._reported_tick = turns, self.tick
            self.on_turns(turns)


def simulation_of(spec: RunSpec, sink: TickSink) -> Simulation:
    """Return the simulation of a run: the plain one if the wheel motors are its only motors."""
    return FurtherMotors(spec, sink) if spec.robot.extra_motors else Simulation(spec, sink)
