"""Between the app and a run: starts it, sends it what the user does, and reads what it writes.

Knows nothing of widgets. The app calls `poll` and `snapshot` at its own rate, so that
drawing can neither slow nor change a run. Without a child the robot stands where the
user puts it, and its sensors are measured all the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import FLAG_LEFT_RUNNING, FLAG_PEN_DOWN, FLAG_RIGHT_RUNNING, Instant
from tuisim.datalog.records import OutputRow
from tuisim.ui import plan as plans
from tuisim.ui.plan import Plan
from tuisim.ui.readings import snapshot_of
from tuisim.ui.snapshot import ENDED, IDLE, PAUSED, RUNNING, STARTING, WAITING, Snapshot

if TYPE_CHECKING:
    from tuisim.core.marks import PenMarks
    from tuisim.datalog.runfile import Action
    from tuisim.datalog.views import TickRecord
    from tuisim.host import Program, RunHandle
    from tuisim.ui.mat import Mat
    from tuisim.ui.session import AppSettings

ROWS_A_POLL = 4000
"""Most output rows that one poll takes, so that a flood of prints leaves the app fluid."""

STALL_S = 0.1
"""A running motor that has not turned for longer is stalled (EV3 motor driver)."""
_STILL_DEG = 0.05
"""Less in that time is no turning, but pushing."""


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
        self.plan: Plan = plans.plan_of(settings.settings) if settings.settings else plans.plan_of_spec(settings.spec)
        """What the next run will be."""
        self.home: Pose = self.plan.spec.world.start
        """Where `back to start` puts the robot."""
        self.speed = settings.speed
        self.mat: Mat | None = None
        self.run: RunHandle | None = None
        self._still = self._at_rest(self.home)
        self._end: protocol.Ended | None = None
        self._moved = True
        """Whether the robot was placed since the last run, so that the run's last record no longer holds."""
        self._noise_set = False
        """Whether the user has changed the noise of the run at hand."""
        self._actions: tuple[Action, ...] = ()
        """The user's actions in this run, as far as they have been read."""
        self._marks: PenMarks | None = None

    # What is the case

    @property
    def spec(self) -> RunSpec:
        """What is shown: the run's own specification while it goes on, else that of the next run."""
        return self.run.spec if self.run is not None and self.run.ended is None else self.plan.spec

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
        record = self._record()
        instant, line, pen_down = self._moment()
        return snapshot_of(
            instant,
            self.spec,
            self._field(),
            state=self.state,
            end=self._end.end if self._end and self.state == ENDED else "",
            line=line,
            speed=self.speed,
            pen_down=pen_down,
            stalled=self._stalled(record) if record else (False, False),
            next_spec=self.plan.spec,
        )

    def _at_rest(self, pose: Pose) -> Instant:
        spec = self.plan.spec
        return Instant(0, pose, gyro_zero_deg=pose.heading_deg, noise=spec.world.noise, seed=spec.seed)

    def _record(self) -> TickRecord | None:
        """The newest record of the run, if the robot is where it left it."""
        return self.run.telemetry.last() if self.run and not self._moved else None

    def _moment(self) -> tuple[Instant, int, bool]:
        """The newest instant, the program's line, and whether the pen is down."""
        record = self._record()
        if record is None:
            return self._still, 0, self.plan.spec.robot.pen.down
        from tuisim.datalog.views import instant_of

        noise = self.noise_at(record) if self.in_run else self.plan.spec.world.noise
        # At rest the pen is where the next run will have it.
        down = bool(record.flags & FLAG_PEN_DOWN) if self.in_run else self.plan.spec.robot.pen.down
        return instant_of(record, self.spec, noise), record.line, down

    def noise_at(self, record: TickRecord) -> NoiseSpec:
        """Return the noise at the tick of a record of the run at hand."""
        assert self.run is not None
        if not self._noise_set:
            return self.run.spec.world.noise
        from tuisim.datalog.runfile import noise_at, read_actions

        # The record counts the actions modulo 65536, and may be a little ahead of their file.
        if 0 < (record.actions - len(self._actions)) & 0xFFFF < 0x8000:
            self._actions = read_actions(self.run.folder)[0]
        return noise_at(self.run.spec, self._actions, record)

    def _field(self) -> Field | None:
        """The mat as the sensors see it, None until it is prepared for them."""
        if self.mat is None or not self.mat.serves(self.spec):
            return None
        if self.run is None or self._moved or not self.run.spec.world.pen_marks:
            return self.mat.field
        if self._marks is None:
            from tuisim.core.marks import PenMarks

            self._marks = PenMarks(self.mat.field, self.run.spec)
        self._marks.take_in(self.run.telemetry.array()[self._marks.records :].tolist())
        return self._marks.field

    def _stalled(self, record: TickRecord) -> tuple[bool, bool]:
        """Whether the left and the right motor are told to run but do not turn."""
        run = self.run
        if run is None or run.ended is not None:
            return False, False
        ticks = int(STALL_S * run.spec.profile.tick_hz) + 1
        if record.tick < ticks:
            return False, False
        before = run.telemetry.record(record.tick - ticks)
        running = record.flags & before.flags
        turned = (
            abs(record.left_position_deg - before.left_position_deg),
            abs(record.right_position_deg - before.right_position_deg),
        )
        return (
            bool(running & FLAG_LEFT_RUNNING) and turned[0] < _STILL_DEG,
            bool(running & FLAG_RIGHT_RUNNING) and turned[1] < _STILL_DEG,
        )

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
        self._noise_set, self._actions, self._marks = False, (), None
        options = RunOptions(live=True, speed=self.speed, time_limit_s=0.0, stall_limit_s=0.0, asks_user=True)
        self.run = start_run(self.program, self.plan.spec, options)
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
        self.plan = plans.with_pen(self.plan, down)

    def set_noise(self, noise: NoiseSpec) -> None:
        """Change the noise, at once and for the next run."""
        if noise == self.plan.spec.world.noise:
            return
        self.plan = plans.with_noise(self.plan, noise)
        self._still = replace(self._still, noise=noise)
        if self.in_run:
            self._noise_set = True
            self._send(protocol.SetNoise(noise.light, noise.motor))

    def set_seed(self, seed: int) -> None:
        """Choose the seed of the next run."""
        self.plan = plans.with_seed(self.plan, seed)
        self._still = replace(self._still, seed=seed)

    def place(self, pose: Pose) -> None:
        """Put the robot somewhere: during a run as a user action, else as the start of the next run."""
        if self.in_run:
            self._send(protocol.SetPose(pose.x_mm, pose.y_mm, pose.heading_deg))
            return
        self._start_at(pose)

    def _start_at(self, pose: Pose) -> None:
        self.plan = plans.at_pose(self.plan, pose)
        self._still = self._at_rest(pose)
        self._moved = True

    def load(self, plan: Plan, program: Program | None) -> None:
        """Take another world or program; the robot goes to its start. Not during a run."""
        self.plan, self.program, self.home = plan, program, plan.spec.world.start
        self._start_at(plan.spec.world.start)

    def change(self, plan: Plan) -> None:
        """Take a plan that differs in other things than the start; the robot stays where it is. Not during a run."""
        self.plan = plan
        self._still = replace(self._still, noise=plan.spec.world.noise, seed=plan.spec.seed)

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
