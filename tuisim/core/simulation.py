"""The simulation of one run: the world at this moment, and the changes that come from outside."""

from __future__ import annotations

from collections.abc import Iterator

from tuisim.core.drive import float32, turn_rate_dps
from tuisim.core.geometry import Pose
from tuisim.core.motion import Motion
from tuisim.core.motors import Motor
from tuisim.core.state import TICK_RECORD, Instant

NS_PER_S = 1_000_000_000


class Simulation(Motion):
    """The world of one run.

    Args:
        spec: Robot, world, profile and seed.
        sink: Gets one record a tick, beginning with tick 0.
    """

    __slots__ = ()

    others: tuple[Motor, ...] = ()
    """Motors that do not drive the robot, in the order of `RobotSpec.extra_motors`."""

    # Reading

    def due_ns(self, tick: int) -> int:
        """Return when a tick falls due, in ns from the start: ceil(tick · 10⁹ / f)."""
        return -(-tick * NS_PER_S // self._hz)

    def ticks_at(self, time_ns: int) -> int:
        """Return how many ticks have fallen due at a time."""
        return time_ns * self._hz // NS_PER_S

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        drive = self.drive
        return Pose(drive.x_mm, drive.y_mm, drive.heading_deg)

    def instant(self) -> Instant:
        """Return the present moment, with values rounded as the telemetry stores them."""
        left, right = float32(self._left_dps), float32(self._right_dps)
        return Instant(
            tick=self.tick,
            pose=self.pose,
            left_position_deg=self.left.position_deg,
            right_position_deg=self.right.position_deg,
            left_speed_dps=left,
            right_speed_dps=right,
            turn_rate_dps=turn_rate_dps(left, right, self.spec.robot),
            gyro_zero_deg=self.gyro_zero_deg,
            noise=self.noise,
            seed=self.spec.seed,
        )

    def records_since(self, first: int) -> Iterator[tuple[float, ...]]:
        """Return the tick records from `first` on, with the fields of `TICK_RECORD`."""
        return TICK_RECORD.iter_unpack(self._buffer[64 + 64 * first : 64 + 64 * self._sink.count])

    # Changing

    def place(self, pose: Pose) -> None:
        """Put the robot somewhere; the gyro keeps the angle it shows."""
        drive, before_deg = self.drive, self.heading_deg
        drive.put(pose)
        drive.gyro_zero_deg = float32(drive.gyro_zero_deg + drive.heading_deg - before_deg)

    def reset_gyro(self) -> None:
        """Let the gyro show 0 here."""
        self.drive.gyro_zero_deg = float32(self.heading_deg)

    def end_tick_after(self, now_ns: int, duration_ns: int) -> int:
        """Return the tick in which a timed move that starts now comes to its end."""
        return self.ticks_at(now_ns + duration_ns)

    def rewrite_record(self) -> None:
        """Write the present tick's record again, after a change from outside."""
        # In one piece: readers look at this record already.
        at = 64 * self._sink.count
        self._buffer[at : at + 64] = TICK_RECORD.pack(*self._fields())
