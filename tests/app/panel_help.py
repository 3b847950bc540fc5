"""What tests of single panels share: a moment to show, and an app with nothing else in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Generic, TypeVar

import numpy as np
from textual.app import App, ComposeResult
from textual.message import Message
from textual.widget import Widget

from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.sensors.color import ColorReading
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.state import Instant
from tuisim.terminal.pixels import Pixels

P = TypeVar("P", bound=Widget)
M = TypeVar("M", bound=Message)

SPEC = RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)


def white_mat() -> Pixels:
    """An empty mat."""
    return np.full((1143, 2362, 3), 255, np.uint8)


def small_field() -> Field:
    """The upper left corner of a mat, the left 100 mm red and the rest white; sums are not made."""
    pixels = np.full((300, 400, 3), 255, np.uint8)
    pixels[:, :100] = 255, 0, 0
    return Field(400, 300, memoryview(pixels.tobytes()), {})


READINGS: Mapping[str, Any] = {
    "time_s": 3.21,
    "colors": {"left": ColorReading(220.0, 220.0, 220.0), "right": ColorReading(0.0, 0.0, 255.0)},
    "ultrasonic_mm": 1342,
    "rays": ((0.0, 1342.0),),
    "gyro_deg": -90,
    "gyro_rate_dps": 12,
    "further": {},
}


def moment(pose: Pose = Pose(1000.0, 500.0, 0.0), **changes: Any) -> Snapshot:
    """A moment of a run, with some fields changed."""
    now = Snapshot(
        state=RunPhase.RUNNING,
        end=None,
        spec=SPEC,
        field=None,
        instant=Instant(321, pose, 1234.4, -56.6, 525.0, -512.0),
        line=7,
        speed=1.0,
        pen_down=True,
    )
    fields = {
        name: value for name, value in changes.items() if name in Snapshot.__dataclass_fields__
    }
    changed = replace(now, **fields)
    # What is measured is kept there once it has been asked for.
    changed.__dict__.update(
        READINGS, **{name: value for name, value in changes.items() if name not in fields}
    )
    return changed


class PanelApp(App[None], Generic[P]):
    """One panel that fills the screen."""

    CSS = "Screen > * { width: 100%; height: 100%; }"

    def __init__(self, panel: P) -> None:
        super().__init__()
        self.panel = panel
        self.messages: list[Message] = []

    def compose(self) -> ComposeResult:
        """The panel alone."""
        yield self.panel

    def on_world_pose_dragged(self, message: Message) -> None:
        """Keep the message."""
        self.messages.append(message)

    def on_chart_cursor_moved(self, message: Message) -> None:
        """Keep the message."""
        self.messages.append(message)

    def heard(self, kind: type[M]) -> list[M]:
        """The messages of one kind, in their order."""
        return [message for message in self.messages if isinstance(message, kind)]


def screen_text(app: App[None]) -> list[str]:
    """What stands on the screen, row by row."""
    return [strip.text for strip in app.screen._compositor.render_strips()]
