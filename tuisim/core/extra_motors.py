"""Simulation of a robot with motors that do not drive it."""

from __future__ import annotations

from tuisim.core import motors
from tuisim.core.motors import Motor
from tuisim.core.simulation import Simulation
from tuisim.core.sink import TickSink
from tuisim.core.spec import RunSpec


class FurtherMotors(Simulation):
    """A simulation whose robot has motors besides its two wheels. They do not change the pose.

    Args:
        spec: Robot, world, profile and seed.
        sink: Gets one record a tick, beginning with tick 0.
    """

    __slots__ = ("others",)

    def __init__(self, spec: RunSpec, sink: TickSink) -> None:
        super().__init__(spec, sink)
        self.others: tuple[Motor, ...] = tuple(Motor() for _ in spec.robot.extra_motors)

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Do some ticks, as `Motion.advance`; tick by tick while a further motor runs."""
        done = 0
        while done < ticks and any(motor.mode != motors.STOPPED for motor in self.others):
            self.tick_once()
            done += 1
            if until_change and self.changed:
                return done
        return done + super().advance(ticks - done, until_change) if done < ticks else done

    def tick_once(self) -> None:
        """Do one tick of the robot, then of the further motors."""
        super().tick_once()
        for motor in self.others:
            if motor.mode != motors.STOPPED:
                motor.step(self.tick, self.spec.profile, self._ramp_step, self._tick_s, 0.0)
                if motor.mode == motors.STOPPED:
                    self.changed = True


def simulation_of(spec: RunSpec, sink: TickSink) -> Simulation:
    """Return the simulation of a run: the plain one where two wheels are all its motors."""
    return FurtherMotors(spec, sink) if spec.robot.extra_motors else Simulation(spec, sink)
