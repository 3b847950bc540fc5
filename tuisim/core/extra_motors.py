"""Simulation of a robot with motors that do not drive it."""

from __future__ import annotations

from collections.abc import Callable

from tuisim.core.motor_laws import motor_of
from tuisim.core.motors import Motor
from tuisim.core.simulation import Simulation
from tuisim.core.spec import RunSpec
from tuisim.core.state import TickSink

Turn = tuple[float, float]
"""Position in degrees and speed in degrees per second, both of the axle."""

TOLD_DEG = 0.25
"""A motor that is further from where its last turn has it has been turned otherwise."""


class FurtherMotors(Simulation):
    """A simulation whose robot has motors besides its two wheels. They do not change the pose.

    Args:
        spec: Robot, world, profile and seed.
        sink: Gets one record a tick, beginning with tick 0.
    """

    __slots__ = ("_told", "_told_tick", "others", "tell")

    def __init__(self, spec: RunSpec, sink: TickSink) -> None:
        super().__init__(spec, sink)
        self.others: tuple[Motor, ...] = tuple(motor_of(spec, motor.kind) for motor in spec.robot.extra_motors)
        self.tell: Callable[[tuple[Turn, ...]], None] = lambda _: None
        """Called when a motor turns otherwise than was told last; until then each turns evenly on."""
        self._told: tuple[Turn, ...] = ((0.0, 0.0),) * len(self.others)
        self._told_tick = 0

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Do some ticks, as `Motion.advance`; tick by tick while a further motor runs."""
        done = 0
        self._tell_turns()
        while done < ticks and not all(motor.resting for motor in self.others):
            self.tick_once()
            done += 1
            if until_change and self.changed:
                return done
        return done + super().advance(ticks - done, until_change) if done < ticks else done

    def tick_once(self) -> None:
        """Do one tick of the robot, then of the further motors."""
        super().tick_once()
        for motor in self.others:
            if not motor.resting:
                before = motor.mode
                motor.step(self.tick, 0.0)
                if motor.mode != before:
                    self.changed = True
        self._tell_turns()

    def _tell_turns(self) -> None:
        turns = tuple((motor.position_deg, motor.counting_dps) for motor in self.others)
        since_s = (self.tick - self._told_tick) * self._tick_s
        if any(
            dps != before_dps or abs(position - before - before_dps * since_s) > TOLD_DEG
            for (position, dps), (before, before_dps) in zip(turns, self._told, strict=True)
        ):
            self._told, self._told_tick = turns, self.tick
            self.tell(turns)


def simulation_of(spec: RunSpec, sink: TickSink) -> Simulation:
    """Return the simulation of a run: the plain one where two wheels are all its motors."""
    return FurtherMotors(spec, sink) if spec.robot.extra_motors else Simulation(spec, sink)
