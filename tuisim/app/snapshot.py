"""What the app shows: one frozen state a frame, and how users read phases and speeds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, assert_never

from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.sensors import color, gyro, sources, ultrasonic, with_kinds
from tuisim.core.sensors.color import ColorReading
from tuisim.core.spec import RunSpec
from tuisim.core.state import Instant
from tuisim.protocol import End, Ended, Inspected, Paused, RunState, Unended
from tuisim.runs.brick_state import BrickState
from tuisim.source import Program

if TYPE_CHECKING:
    from tuisim.app.setup.next_run import NextRun


class RunPhase(StrEnum):
    """What the run in view is doing."""

    IDLE = "idle"
    """There is no run yet."""
    STARTING = "starting"
    """The child process starts, or a branch is on the way to its instant."""
    RUNNING = "running"
    PAUSED = "paused"
    WAITING = "waiting"
    """It waits in `input()`."""
    ENDED = "ended"


IN_RUN = frozenset({RunPhase.STARTING, RunPhase.RUNNING, RunPhase.PAUSED, RunPhase.WAITING})
"""The phases in which a child process runs."""

AT_REST = frozenset({RunPhase.PAUSED, RunPhase.ENDED})
"""The phases in which a run stands still."""

GOOD_ENDS: frozenset[RunState | None] = frozenset({End.FINISHED, End.STOPPED})
"""Ways to end a run that are no failure."""

_DARK = BrickState()


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One moment as every panel sees it. Sensor values are those of `instant`."""

    state: RunPhase
    end: RunState | None
    """How the run ended; None unless `state` is ended."""
    spec: RunSpec
    field: Field | None
    """None until the mat has been prepared."""
    instant: Instant
    time_s: float
    line: int
    """Line of the program during which time passes, 0 for none."""
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
    """Measurements of sensors that not every robot has, by telemetry column, such as `bumper_pressed`."""
    stalled: tuple[bool, bool] = (False, False)
    """Whether the left and the right motor are commanded to run but cannot turn."""
    next_spec: RunSpec | None = None
    """Settings of the next run; differ from `spec` in what was changed during the run. None: the same."""

    face: BrickState = _DARK
    """What the brick shows."""
    turns: tuple[tuple[float, float], ...] = ()
    """Position in degrees and speed in degrees per second of each motor that does not drive the robot."""
    pressed: frozenset[str] = frozenset()
    """The brick's buttons that are held down."""

    past: bool = False
    """Whether this is a past instant, and not the newest one."""
    now_tick: int = 0
    """The newest tick of the run."""
    now_pose: Pose | None = None
    """The current pose of the robot, while another instant is viewed."""

    def has_stopped_since(self, before: Snapshot | None) -> bool:
        """Whether the run stands still now, and did not at an earlier moment."""
        return before is not None and self.state in AT_REST and before.state is not self.state

    @property
    def failed(self) -> bool:
        """Whether the run has ended with a failure."""
        return self.state == RunPhase.ENDED and self.end is not None and self.end not in GOOD_ENDS

    @property
    def planned(self) -> RunSpec:
        """The settings of the next run."""
        return self.next_spec or self.spec


@dataclass(frozen=True, slots=True)
class PauseView:
    """Where a program is paused, and its frames and variables there."""

    paused: Paused
    inspected: Inspected
    past: bool
    """Whether this is a past instant."""


@dataclass(frozen=True, slots=True)
class DebugState:
    """What the debugger knows at one moment."""

    view: PauseView | None = None
    """None while the program runs, or before it is first paused."""
    looks_back: bool = False
    """Whether a past instant is viewed, even one within the newest tick."""
    busy: bool = False
    """Whether a past instant is still being computed."""


@dataclass(frozen=True, slots=True)
class Situation:
    """The state that decides whether a key is available."""

    state: RunPhase
    has_program: bool
    has_run: bool
    """Whether there has been a run, so that there is a log and a past."""
    in_past: bool = False
    """Whether an instant before the newest is viewed."""
    looks_back: bool = False
    """As `in_past`, and also for an earlier line of the newest tick or while such an instant is being computed."""
    reads_code: bool = False
    """Whether the code has the focus."""
    has_pixels: bool = False
    """Whether pictures are drawn with pixels, or were until the user switched to characters."""


@dataclass(frozen=True, slots=True)
class AppState:
    """The app at one moment: everything that panels and footer show. Made once a frame."""

    program: Program | None
    next_run: NextRun
    view: Snapshot
    """The run at the instant in view."""
    debug: DebugState
    situation: Situation
    playing: bool
    """Whether the recording is being played."""

    @property
    def status(self) -> str:
        """State and speed of the run, in words."""
        view = self.view
        status = end_label(view.end) if view.state is RunPhase.ENDED else view.state.value
        if self.debug.looks_back:
            status = "playing" if self.playing else f"past {view.time_s:.2f} s"
        return f"{status} {speed_label(view.speed)}" if view.state in IN_RUN or view.speed != 1 else status

    @property
    def failed(self) -> bool:
        """Whether the end of a failed run is in view."""
        return self.view.failed and not self.debug.looks_back


def snapshot_of(
    instant: Instant,
    spec: RunSpec,
    field: Field | None,
    *,
    state: RunPhase,
    end: RunState | None,
    line: int,
    speed: float,
    pen_down: bool,
    stalled: tuple[bool, bool] = (False, False),
    next_spec: RunSpec | None = None,
) -> Snapshot:
    """Return the snapshot of one moment, with every sensor measured."""
    ultrasonic_spec = spec.robot.ultrasonic
    rays = tuple(ultrasonic.rays_mm(instant.pose, ultrasonic_spec, spec.world)) if ultrasonic_spec else ()
    has_gyro = spec.robot.gyro is not None
    return Snapshot(
        state=state,
        end=end,
        spec=spec,
        field=field,
        instant=instant,
        time_s=instant.tick / spec.profile.tick_hz,
        line=line,
        speed=speed,
        colors={s.name: color.reading(s, instant, field) for s in spec.robot.color_sensors} if field else {},
        ultrasonic_mm=ultrasonic.reading_mm(ultrasonic_spec, instant, spec.world) if ultrasonic_spec else None,
        rays=rays,
        gyro_deg=gyro.angle_deg(instant) if has_gyro else 0,
        gyro_rate_dps=gyro.rate_dps(instant) if has_gyro else 0,
        further=further_readings(instant, spec, field) if field else {},
        pen_down=pen_down,
        stalled=stalled,
        next_spec=next_spec,
    )


def further_readings(instant: Instant, spec: RunSpec, field: Field) -> dict[str, float]:
    """Return the measurements of sensors that not every robot has, by telemetry column."""
    values: dict[str, float] = {}
    for kind, sensor in with_kinds(spec.robot.further_sensors):
        values |= zip(kind.names(sensor), kind.measure(sensor, instant, spec, field), strict=True)
    return values


def telemetry_traces(instant: Instant, spec: RunSpec, field: Field) -> dict[str, float]:
    """Return the chart's telemetry of a moment, which needs no prints, by the name of its column."""
    values: dict[str, float] = {}
    for source in sources(spec.robot):
        if names := {column.name for column in source.columns if column.is_traced}:
            values |= source.values(names, source.measure(instant, spec, field), spec.robot)
    return values


def speed_label(speed: float) -> str:
    """Return a speed as users read it: ¼×, 2×, max."""
    return {0.0: "max", 0.25: "¼×", 0.5: "½×"}.get(speed, f"{speed:g}×")


def end_words(ended: Ended, stood: str) -> tuple[str, str]:
    """Return the end of a run for the notice and for the end of the output.

    Args:
        stood: Where the robot stood in the way of something solid, in words; may be empty.
    """
    words = ended.summary or end_label(ended.end)
    # The traceback is among the rows already.
    known = ended.end in (End.FINISHED, End.RAISED)
    last = f"— {end_label(ended.end) if known else words} at {ended.time_ns / 1e9:.2f} s"
    return ", ".join(filter(None, (words, stood))), ", ".join(filter(None, (last, stood)))


def end_label(state: RunState | None) -> str:
    """Return in words how a run ended; empty if that is not known."""
    match state:
        case End.RAISED:
            return "error"
        case End() | Unended():
            return state.replace("_", " ")
        case None:
            return ""
        case _:
            assert_never(state)
