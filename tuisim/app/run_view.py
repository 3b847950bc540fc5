"""The view of a run: its current state, or the robot before a run, with actions not yet carried out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import ENDED, IDLE, PAUSED, RUNNING, STARTING, WAITING, Snapshot, snapshot_of
from tuisim.app.timeline import Timeline
from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import FLAG_PEN_DOWN, Instant
from tuisim.protocol import RunState

if TYPE_CHECKING:
    from tuisim.app.actions.branch import Branch
    from tuisim.app.setup.mat import Mat
    from tuisim.app.start_options import AppSettings
    from tuisim.runs.handle import RunHandle
    from tuisim.runs.views import TickRecord
    from tuisim.source import Program


@dataclass(slots=True)
class Pending:
    """User actions that the newest record does not contain yet."""

    _after: tuple[int, int] = (-1, 0)
    """Tick of the record after which they were sent, and the number of actions that it counts."""
    _pose: Pose | None = None
    _noise: NoiseSpec | None = None
    _pen_down: bool | None = None

    def note(self, record: TickRecord, action: protocol.Message) -> None:
        """Add an action that was sent while this was the newest record."""
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
        """Drop all pending actions."""
        self._after, self._pose, self._noise, self._pen_down = (-1, 0), None, None, None

    def done_to(self, record: TickRecord, instant: Instant, pen_down: bool) -> tuple[Instant, bool]:
        """Return the instant of the newest record and its pen with the pending actions applied.

        The gyro keeps its angle, as it does when the robot is lifted.
        """
        if self._after != _key(record):
            return instant, pen_down
        pose = self._pose or instant.pose
        zero_deg = instant.gyro_zero_deg + pose.heading_deg - instant.pose.heading_deg
        instant = replace(instant, pose=pose, noise=self._noise or instant.noise, gyro_zero_deg=zero_deg)
        return instant, pen_down if self._pen_down is None else self._pen_down


def _key(record: TickRecord) -> tuple[int, int]:
    return record.tick, record.actions


def _first_plan(settings: AppSettings) -> NextRun:
    if settings.settings is not None:
        return plans.plan_of(settings.settings)
    arguments = settings.program.arguments if settings.program else ()
    return plans.with_arguments(plans.plan_of_run(settings.spec), arguments)


class RunView:
    """The reading side of the run controller: nothing here changes a run.

    Args:
        settings: The options that the app was started with.
    """

    def __init__(self, settings: AppSettings) -> None:
        self.program: Program | None = settings.program
        self.plan: NextRun = _first_plan(settings)
        """The settings of the next run."""
        self.home: Pose = self.plan.spec.world.start
        """The pose that `back to start` uses."""
        self.speed = settings.speed
        self.mat: Mat | None = None
        self.run: RunHandle | None = None
        """The live run or the last one; None before the first one, and while a stored run is shown."""
        self.timeline = Timeline()
        self.pressed: frozenset[str] = frozenset()
        """The brick's buttons that the user holds down."""
        self._branch: Branch | None = None
        """The branch that the current run becomes, while the run is repeated up to its instant."""
        self._still = self._at_rest(self.home)
        self._end: RunState | None = None
        """How the run ended."""
        self._moved = True
        """Whether the robot was placed since the last run, so that the run's last record no longer applies."""
        self._pending = Pending()
        self.held_line: tuple[int, int] | None = None
        """Tick and line at which the program is paused: more exact than the record of that tick."""

    @property
    def spec(self) -> RunSpec:
        """The specification in view: the run's own while it is live or viewed in the past, else the next run's."""
        recording = self.timeline.recording
        return recording.spec if recording and (self.in_run or self.in_past) else self.plan.spec

    @property
    def in_run(self) -> bool:
        """Whether a child process runs."""
        return self.run is not None and self.run.ended is None

    @property
    def in_past(self) -> bool:
        """Whether an instant before the newest is viewed."""
        return self.timeline.at is not None

    @property
    def state(self) -> str:
        """One of the states of `app.snapshot`."""
        run = self.run
        if run is None:
            return ENDED if self.timeline.recording else IDLE
        if run.ended is not None:
            return ENDED
        if run.waiting_for_input is not None and not run.paused:
            return WAITING
        if self._branch is not None:
            return STARTING
        if run.paused:
            return PAUSED
        return RUNNING if run.started else STARTING

    @property
    def run_id(self) -> str:
        """Id of the current or last run, empty if there was none."""
        return self.timeline.recording.run_id if self.timeline.recording else ""

    @property
    def pose(self) -> Pose:
        """The pose of the robot."""
        return self._moment()[0].pose

    @property
    def pen_down(self) -> bool:
        """Whether the pen is down."""
        return self._moment()[2]

    def snapshot(self) -> Snapshot:
        """Return the snapshot of the instant in view."""
        record, recording = self._record(), self.timeline.recording
        instant, line, pen_down = self._moment()
        newest = recording.telemetry.last() if recording and self.in_past else None
        face = self.timeline.face()
        # After the robot was placed following the run, all its motors are reset.
        turns = face.turns_at(instant.tick / self.spec.profile.tick_hz, self.spec.profile.tick_hz) if record else ()
        return replace(
            snapshot_of(
                instant,
                self.spec,
                self._field(record),
                state=self.state,
                end=self._end if self.state == ENDED else None,
                line=line,
                speed=self.speed,
                pen_down=pen_down,
                stalled=recording.stalled(record) if record and recording and self._is_of_run else (False, False),
                next_spec=self.plan.spec,
            ),
            face=face,
            turns=turns or ((0.0, 0.0),) * len(self.spec.robot.extra_motors),
            pressed=self._pressed_at(record),
            past=self.in_past,
            now_tick=max(0, self.timeline.newest),
            now_pose=newest.pose if newest else None,
        )

    def _at_rest(self, pose: Pose) -> Instant:
        spec = self.plan.spec
        return Instant(0, pose, gyro_zero_deg=pose.heading_deg, noise=spec.world.noise, seed=spec.seed)

    @property
    def _is_of_run(self) -> bool:
        """Return whether an instant of the run is in view, and not the robot as placed after it."""
        return self.in_run or self.in_past

    def _record(self) -> TickRecord | None:
        """Return the record in view; without a past instant, the newest one if the robot is where the run left it."""
        recording = self.timeline.recording
        if recording is None or (self._moved and not self.in_past):
            return None
        return self.timeline.record() or recording.telemetry.last()

    def _moment(self) -> tuple[Instant, int, bool]:
        """Return the instant, the program's line, and whether the pen is down."""
        record, recording = self._record(), self.timeline.recording
        if record is None or recording is None:
            return self._still, 0, self.plan.spec.robot.pen.down
        from tuisim.runs.views import instant_of

        noise = recording.noise_at(record) if self._is_of_run else self.plan.spec.world.noise
        # Before a run, the pen is where the next run will have it.
        down = bool(record.flags & FLAG_PEN_DOWN) if self._is_of_run else self.plan.spec.robot.pen.down
        tick, line = self.held_line or (-1, 0)
        instant, line = instant_of(record, self.spec, noise), line if tick == record.tick else record.line
        if self.in_run and not self.in_past:
            instant, down = self._pending.done_to(record, instant, down)
        return instant, line, down

    def _pressed_at(self, record: TickRecord | None) -> frozenset[str]:
        """Return the brick's buttons that are held down: by the user now, or at the instant in view."""
        recording = self.timeline.recording
        if not self.in_past or record is None or recording is None:
            return self.pressed if self.in_run else frozenset()
        return recording.pressed_at(record.tick)

    def _field(self, record: TickRecord | None) -> Field | None:
        """Return the mat as the sensors saw it then, None until it is prepared for them."""
        if self.mat is None or self.mat.field is None or not self.mat.serves(self.spec):
            return None
        recording = self.timeline.recording
        return (
            self.mat.field if record is None or recording is None else recording.field_at(record.tick, self.mat.field)
        )
