"""Between the app and a run: starts it, sends it what the user does, and reads what it writes.

Knows nothing of widgets. The app calls `poll` and `snapshot` at its own rate, so that
drawing can neither slow nor change a run. Without a child the robot stands where the
user puts it, and its sensors are measured all the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.core.geometry import Pose
from tuisim.core.spec import RunSpec
from tuisim.core.state import FLAG_PEN_DOWN, Instant
from tuisim.datalog.records import OutputRow
from tuisim.ui.readings import snapshot_of
from tuisim.ui.snapshot import ENDED, IDLE, PAUSED, RUNNING, STARTING, WAITING, Snapshot

if TYPE_CHECKING:
    from tuisim.host import Program, RunHandle
    from tuisim.ui.mat import Mat
    from tuisim.ui.session import AppSettings

ROWS_A_POLL = 4000
"""Most output rows that one poll takes, so that a flood of prints leaves the app fluid."""


@dataclass(frozen=True, slots=True)
class News:
    """What has come from the run since the last poll."""

    rows: list[OutputRow]
    skipped: int = 0
    """Rows left out before `rows`."""
    ended: protocol.Ended | None = None
    """Set once, in the poll in which the end is learnt."""
    spoken: tuple[str, ...] = ()
    """What the program said."""
    prompt: str | None = None
    """The prompt while the program waits in `input()`."""


class Bridge:
    """The run at hand, or the robot at rest.

    Args:
        settings: What the app was started with.
    """

    def __init__(self, settings: AppSettings) -> None:
        self.program: Program | None = settings.program
        self.spec: RunSpec = settings.spec
        """What the next run will be; during a run, its own spec but for the pen."""
        self.home: Pose = settings.spec.world.start
        """Where `back to start` puts the robot."""
        self.speed = settings.speed
        self.mat: Mat | None = None
        self.run: RunHandle | None = None
        self._still = self._at_rest(self.home)
        self._end: protocol.Ended | None = None
        self._moved = True
        """Whether the robot was placed since the last run, so that the run's last record no longer holds."""

    # What is the case

    @property
    def in_run(self) -> bool:
        """Whether there is a child at work."""
        return self.run is not None and self.run.ended is None

    @property
    def state(self) -> str:
        """One of the states of `ui.snapshot`."""
        run = self.run
        if run is None:
            return IDLE
        if run.ended is not None:
            return ENDED
        if run.waiting_for_input is not None:
            return WAITING
        if run.paused:
            return PAUSED
        return RUNNING if run.started else STARTING

    @property
    def run_id(self) -> str:
        """Id of the run at hand or the last one, empty if there was none."""
        return self.run.run_id if self.run else ""

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return self._moment()[0].pose

    @property
    def pen_down(self) -> bool:
        """Whether the pen draws."""
        return self._moment()[2]

    def snapshot(self) -> Snapshot:
        """Return the picture of this moment."""
        instant, line, pen_down = self._moment()
        return snapshot_of(
            instant,
            self.spec,
            self.mat.field if self.mat else None,
            state=self.state,
            end=self._end.end if self._end and self.state == ENDED else "",
            line=line,
            speed=self.speed,
            pen_down=pen_down,
        )

    def _at_rest(self, pose: Pose) -> Instant:
        return Instant(0, pose, gyro_zero_deg=pose.heading_deg, noise=self.spec.world.noise, seed=self.spec.seed)

    def _moment(self) -> tuple[Instant, int, bool]:
        """The newest instant, the program's line, and whether the pen is down."""
        record = self.run.telemetry.last() if self.run and not self._moved else None
        if record is None:
            return self._still, 0, self.spec.robot.pen.down
        from tuisim.datalog.views import instant_of

        instant = instant_of(record, self.spec, self.spec.world.noise)
        return instant, record.line, bool(record.flags & FLAG_PEN_DOWN)

    # What the user does

    def start(self) -> None:
        """Start the program from where the robot was last put.

        Raises:
            TuisimError: the run cannot be started.
        """
        from tuisim.host import RunOptions, start_run

        if self.program is None or self.in_run:
            return
        self.close()
        self._end, self._moved = None, True
        options = RunOptions(live=True, speed=self.speed, time_limit_s=0.0, stall_limit_s=0.0, asks_user=True)
        self.run = start_run(self.program, self.spec, options)
        self._moved = False

    def stop(self) -> None:
        """End the program; the end comes with a later poll."""
        if self.run:
            self.run.stop()

    def pause(self) -> None:
        """Let the run stand still."""
        self._send(protocol.Pause())

    def resume(self) -> None:
        """Let the run go on."""
        self._send(protocol.Resume())

    def step(self) -> None:
        """Let one tick pass."""
        self._send(protocol.StepTicks(1))

    def set_speed(self, speed: float) -> None:
        """Change the pace: 1.0 real time, 0 as fast as possible."""
        self.speed = speed
        self._send(protocol.SetSpeed(speed))

    def answer(self, text: str | None) -> None:
        """Answer `input()`; None is end of file."""
        self._send(protocol.Answer(text))

    def set_pen(self, down: bool) -> None:
        """Put the pen down or up, for this run and the next."""
        self._send(protocol.SetPen(down))
        self.spec = replace(self.spec, robot=replace(self.spec.robot, pen=replace(self.spec.robot.pen, down=down)))

    def place(self, pose: Pose) -> None:
        """Put the robot somewhere: during a run as a user action, else as the start of the next run."""
        if self.in_run:
            self._send(protocol.SetPose(pose.x_mm, pose.y_mm, pose.heading_deg))
            return
        self._start_at(pose)

    def _start_at(self, pose: Pose) -> None:
        self._still = self._at_rest(pose)
        self._moved = True
        self.spec = replace(self.spec, world=replace(self.spec.world, start=pose))

    def load(self, spec: RunSpec, program: Program | None) -> None:
        """Take another world or program; the robot goes to its start. Not during a run."""
        self.spec, self.program, self.home = spec, program, spec.world.start
        self._start_at(spec.world.start)

    def close(self) -> None:
        """Let go of the run; a child still at work is killed."""
        if self.run:
            if self.run.ended is None:
                self.run.kill()
            self.run.close()
            self.run = None

    def _send(self, command: protocol.Message) -> None:
        if self.run is not None:
            self.run.send(command)

    # What comes from the run

    def poll(self) -> News:
        """Take what has arrived; never waits.

        Raises:
            HostError: the child sent rubbish.
            LogError: its recording is damaged.
        """
        if self.run is None:
            return News([])
        ended = None
        spoken: list[str] = []
        for event in self.run.pump():
            match event:
                case protocol.Ended():
                    self._end = ended = event
                case protocol.Spoke(text=text):
                    spoken.append(text)
        rows = self.run.output.new_rows(ROWS_A_POLL)
        return News(rows, 0, ended, tuple(spoken), self.run.waiting_for_input if self.in_run else None)
