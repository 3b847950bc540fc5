"""User actions that were sent to the run in view but are not in its newest record yet."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine import protocol
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.core.state import Instant

if TYPE_CHECKING:
    from tuisim.engine.runs.views import TickRecord


@dataclass(slots=True)
class Pending:
    """User actions that were sent to the run but are not in its newest record yet.

    With them, the app shows the effect of an action before the run has recorded it.
    """

    _after: tuple[int, int] = (-1, 0)
    """Tick of the record after which the actions were sent, and the number of actions that it counts."""
    _pose: Pose | None = None
    _noise: NoiseSpec | None = None
    _pen_down: bool | None = None

    def note(self, record: TickRecord, action: protocol.Message) -> None:
        """Remember an action that was sent to the run while `record` was its newest record."""
        if self._after != _build_key(record):
            self.forget()
            self._after = _build_key(record)
        match action:
            case protocol.SetPose(x_mm=x_mm, y_mm=y_mm, heading_deg=heading_deg):
                self._pose = Pose(x_mm, y_mm, heading_deg)
            case protocol.SetNoise(light=light, motor=motor):
                self._noise = NoiseSpec(light, motor)
            case protocol.SetPen(down=down):
                self._pen_down = down

    def forget(self) -> None:
        """Remove all pending user actions."""
        self._after = (-1, 0)
        self._pose = None
        self._noise = None
        self._pen_down = None

    def apply_pending(
        self, record: TickRecord, instant: Instant, pen_down: bool
    ) -> tuple[Instant, bool]:
        """Return the newest instant and whether the pen is down, as they are after the pending actions.

        The gyro keeps its angle, as it does when the robot is lifted.

        Args:
            record: The newest record of the run.
            instant: The instant in that record.
            pen_down: Whether the pen is down in that record.
        """
        if self._after != _build_key(record):
            return instant, pen_down
        pose = self._pose or instant.pose
        zero_deg = instant.gyro_zero_deg + pose.heading_deg - instant.pose.heading_deg
        instant = replace(
            instant, pose=pose, noise=self._noise or instant.noise, gyro_zero_deg=zero_deg
        )
        return instant, pen_down if self._pen_down is None else self._pen_down


def _build_key(record: TickRecord) -> tuple[int, int]:
    return record.tick, record.actions
