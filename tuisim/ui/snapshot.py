"""What the panels show: one frozen picture of the run, made once a frame by the bridge."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.sensors.color import ColorReading
from tuisim.core.spec import RunSpec
from tuisim.core.state import Instant
from tuisim.datalog.face import Face

IDLE, STARTING, RUNNING, PAUSED, WAITING, ENDED = "idle", "starting", "running", "paused", "waiting", "ended"
"""Run states: no run yet, child is starting, time moves, stands still, waits in input(), over."""

GOOD_ENDS = ("finished", "stopped")
"""Ends of a run that are no failure (`protocol.Ended.end`)."""

_DARK = Face()


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One moment as every panel sees it. Sensor values are those of `instant`."""

    state: str
    end: str
    """How the run ended (`protocol.Ended.end`), empty unless `state` is ended."""
    spec: RunSpec
    field: Field | None
    """None until the mat has been prepared."""
    instant: Instant
    time_s: float
    line: int
    """Line of the program that lets the time pass, 0 for none."""
    speed: float
    """1.0 real time, 0 as fast as possible."""
    colors: Mapping[str, ColorReading]
    """By sensor name, such as `left`."""
    ultrasonic_mm: int | None
    rays: tuple[tuple[float, float], ...]
    """Ultrasonic rays as (world angle in degrees, length in mm)."""
    gyro_deg: int
    gyro_rate_dps: int
    pen_down: bool
    further: Mapping[str, float] = dataclasses.field(default_factory=dict)
    """What the sensors measure that not every robot has, by telemetry column, such as `bumper_pressed`."""
    stalled: tuple[bool, bool] = (False, False)
    """Whether the left and the right motor are told to run but cannot turn."""
    next_spec: RunSpec | None = None
    """What the next run will be; differs from `spec` in what was changed during the run. None: the same."""

    face: Face = _DARK
    """What the brick shows."""
    turns: tuple[tuple[float, float], ...] = ()
    """Position in degrees and speed in degrees per second of each motor that does not drive the robot."""
    pressed: frozenset[str] = frozenset()
    """The brick's buttons that are held down."""

    past: bool = False
    """Whether this is an instant that is looked back at, and not the newest one."""
    now_tick: int = 0
    """The newest tick of the run."""
    now_pose: Pose | None = None
    """Where the robot is now, while another instant is looked at."""

    @property
    def failed(self) -> bool:
        """Whether the run is over and did not end well."""
        return self.state == ENDED and bool(self.end) and self.end not in GOOD_ENDS

    @property
    def planned(self) -> RunSpec:
        """What the next run will be."""
        return self.next_spec or self.spec
