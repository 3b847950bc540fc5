"""What the user did to a run that stands still: it takes effect right before its next tick, and is shown at once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec
from tuisim.core.state import Instant

if TYPE_CHECKING:
    from tuisim.datalog.views import TickRecord


@dataclass(slots=True)
class Pending:
    """The user's actions that the newest record does not know yet."""

    _after: tuple[int, int] = (-1, 0)
    """Tick of the record after which they were done, and how many actions it counts."""
    _pose: Pose | None = None
    _noise: NoiseSpec | None = None
    _pen_down: bool | None = None

    def note(self, record: TickRecord, action: protocol.Message) -> None:
        """Take an action that was sent while this was the newest record."""
        if self._after != _key(record):
            self.forget()
            self._after = _key(record)
        match action:
            case protocol.SetPose(x_mm=x_mm, y_mm=y_mm, heading_deg=heading_deg):
                self._pose = Pose(x_mm, y_mm, heading_deg)
            case protocol.SetNoise(light=light, motor=motor):
                self._noise = NoiseSpec(light, motor)
            case protocol.SetPen(down=down):
                self._pen_down = down

    def forget(self) -> None:
        """There are none."""
        self._after, self._pose, self._noise, self._pen_down = (-1, 0), None, None, None

    def done_to(self, record: TickRecord, instant: Instant, pen_down: bool) -> tuple[Instant, bool]:
        """Return the instant of the newest record and its pen with what the user did since.

        The gyro goes on showing its angle, as it does when the robot is lifted.
        """
        if self._after != _key(record):
            return instant, pen_down
        pose = self._pose or instant.pose
        zero_deg = instant.gyro_zero_deg + pose.heading_deg - instant.pose.heading_deg
        instant = replace(instant, pose=pose, noise=self._noise or instant.noise, gyro_zero_deg=zero_deg)
        return instant, pen_down if self._pen_down is None else self._pen_down


def _key(record: TickRecord) -> tuple[int, int]:
    return record.tick, record.actions
