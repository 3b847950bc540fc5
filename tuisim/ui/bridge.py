"""Between the app and a run: starts it, sends it what the user does, and reads what it writes.

Knows nothing of widgets. The app calls `poll` and `snapshot` at its own rate, so that
drawing can neither slow nor change a run. Without a child the robot stands where the
user puts it, and its sensors are measured all the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import FLAG_PEN_DOWN, Instant
from tuisim.ui import plan as plans
from tuisim.ui.news import News
from tuisim.ui.plan import Plan
from tuisim.ui.readings import snapshot_of
from tuisim.ui.recording import Recording
from tuisim.ui.snapshot import ENDED, IDLE, PAUSED, RUNNING, STARTING, WAITING, Snapshot
from tuisim.ui.timeline import Timeline

if TYPE_CHECKING:
    from tuisim.datalog.runfile import StoredRun
    from tuisim.datalog.views import TickRecord
    from tuisim.host import Program, RunHandle
    from tuisim.ui.branching import Branch
    from tuisim.ui.mat import Mat
    from tuisim.ui.session import AppSettings

FIRST_LINE = (0, 1)
"""Tick and ordinal at which the first line of a program is about to run."""

ROWS_A_POLL = 4000
"""Most output rows that one poll takes, so that a flood of prints leaves the app fluid."""


class Bridge:
    """The run at hand, or the robot at rest.

    Args:
        settings: What the app was started with.
    """

    def __init__(self, settings: AppSettings) -> None:
        self.program: Program | None = settings.program
        self.plan: Plan = plans.plan_of(settings.settings) if settings.settings else plans.plan_of_run(settings.spec)
        """What the next run will be."""
        self.home: Pose = self.plan.spec.world.start
        """Where `back to start` puts the robot."""
        self.speed = settings.speed
        self.mat: Mat | None = None
        self.run: RunHandle | None = None
        """The run at work or the last one; None before the first, and while one from the store is shown."""
        self.timeline = Timeline()
        self.pressed: frozenset[str] = frozenset()
        """The brick's buttons that the user holds down."""
        self.propose: Callable[[protocol.Message], None] = lambda _: None
        """Called instead of a user action while a former instant is looked at: it can only be done in a branch."""
        self._branch: Branch | None = None
        """What the run at hand is becoming, while it is done again up to its instant."""
        self._still = self._at_rest(self.home)
        self._end = ""
        """How the run ended."""
        self._moved = True
        """Whether the robot was placed since the last run, so that the run's last record no longer holds."""

        self.held_line: tuple[int, int] | None = None
        """Tick and line at which the program was held: more exact than the record of that tick."""

    # What is the case

    @property
    def spec(self) -> RunSpec:
        """What is shown: the run's own specification while it goes on or is looked back at, else the next run's."""
        recording = self.timeline.recording
        return recording.spec if recording and (self.in_run or self.in_past) else self.plan.spec

    @property
    def in_run(self) -> bool:
        """Whether there is a child at work."""
        return self.run is not None and self.run.ended is None

    @property
    def in_past(self) -> bool:
        """Whether an instant before the newest is looked at."""
        return self.timeline.at is not None

    @property
    def state(self) -> str:
        """One of the states of `ui.snapshot`."""
        run = self.run
        if run is None:
            return ENDED if self.timeline.recording else IDLE
        if run.ended is not None:
            return ENDED
        if run.waiting_for_input is not None:
            return WAITING
        if self._branch is not None:
            return STARTING
        if run.paused:
            return PAUSED
        return RUNNING if run.started else STARTING

    @property
    def run_id(self) -> str:
        """Id of the run at hand or the last one, empty if there was none."""
        return self.timeline.recording.run_id if self.timeline.recording else ""

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return self._moment()[0].pose

    @property
    def pen_down(self) -> bool:
        """Whether the pen draws."""
        return self._moment()[2]

    def snapshot(self) -> Snapshot:
        """Return the picture of the moment that is looked at."""
        record, recording = self._record(), self.timeline.recording
        instant, line, pen_down = self._moment()
        newest = recording.telemetry.last() if recording and self.in_past else None
        return replace(
            snapshot_of(
                instant,
                self.spec,
                self._field(record),
                state=self.state,
                end=self._end if self.state == ENDED else "",
                line=line,
                speed=self.speed,
                pen_down=pen_down,
                stalled=recording.stalled(record) if record and recording and self._is_of_run else (False, False),
                next_spec=self.plan.spec,
            ),
            face=self.timeline.face(),
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
        """Whether what is shown is an instant of the run, and not how the robot stands after it."""
        return self.in_run or self.in_past

    def _record(self) -> TickRecord | None:
        """The record that is looked at; now that is the run's newest, if the robot is where the run left it."""
        recording = self.timeline.recording
        if recording is None or (self._moved and not self.in_past):
            return None
        return self.timeline.record() or recording.telemetry.last()

    def _moment(self) -> tuple[Instant, int, bool]:
        """The instant, the program's line, and whether the pen is down."""
        record, recording = self._record(), self.timeline.recording
        if record is None or recording is None:
            return self._still, 0, self.plan.spec.robot.pen.down
        from tuisim.datalog.views import instant_of

        noise = recording.noise_at(record) if self._is_of_run else self.plan.spec.world.noise
        # At rest the pen is where the next run will have it.
        down = bool(record.flags & FLAG_PEN_DOWN) if self._is_of_run else self.plan.spec.robot.pen.down
        tick, line = self.held_line or (-1, 0)
        return instant_of(record, self.spec, noise), line if tick == record.tick else record.line, down

    def _pressed_at(self, record: TickRecord | None) -> frozenset[str]:
        """The brick's buttons that are held down: those of the user now, or those of the instant looked at."""
        recording = self.timeline.recording
        if not self.in_past or record is None or recording is None:
            return self.pressed if self.in_run else frozenset()
        return recording.pressed_at(record.tick)

    def _field(self, record: TickRecord | None) -> Field | None:
        """The mat as the sensors saw it then, None until it is prepared for them."""
        if self.mat is None or self.mat.field is None or not self.mat.serves(self.spec):
            return None
        recording = self.timeline.recording
        return (
            self.mat.field if record is None or recording is None else recording.field_at(record.tick, self.mat.field)
        )

    # What the user does

    def start(self, breaks: tuple[str, ...] = (), held: bool = False) -> None:
        """Start the program from where the robot was last put.

        Args:
            breaks: What holds it.
            held: Hold it at its first line.

        Raises:
            TuisimError: the run cannot be started.
        """
        from tuisim.host import RunOptions, start_run

        if self.program is None or self.in_run:
            return
        options = RunOptions(
            live=True, speed=self.speed, time_limit_s=0.0, stall_limit_s=0.0, asks_user=True,
            breaks=breaks, hold_at=FIRST_LINE if held else None,
        )  # fmt: skip
        run = start_run(self.program, self.plan.spec, options)
        self.close()
        self.run, self._end = run, ""
        self._look_at(Recording(self.run))

    def branch(self, branch: Branch) -> None:
        """Do a run again up to an instant of it, and go on from there. Ends the run at hand.

        Raises:
            TuisimError: the run cannot be started.
        """
        run = branch.start(self.speed)
        self.close()
        self.run, self._end = run, ""
        self._look_at(Recording(run, branch.of.answers))
        self._branch = branch

    def _branch_is_there(self, held: protocol.Paused | None = None) -> Branch | None:
        """Leave the former run, in the midst of which the new one is held at the instant of the branch, or has ended.

        A program that comes to its end before that is held there.
        """
        branch, self._branch = self._branch, None
        if branch is not None and held is not None:
            early = held.tick < branch.tick
            self._send(protocol.SetSpeed(self.speed))
            if branch.then is not None and not early:
                self._send(branch.then)
            if early or (branch.goes_on and not self.in_past):
                self._send(protocol.Resume())
        return branch

    def replay(self, run: StoredRun) -> None:
        """Show a run from the store as one that is over. Not during a run."""
        self.close()
        self._end = run.state
        self._look_at(Recording(run))

    def _look_at(self, recording: Recording) -> None:
        self.timeline.take(recording)
        self._moved = False

    def stop(self) -> None:
        """End the program; the end comes with a later poll."""
        if self.run:
            self.run.stop()

    def stop_now(self) -> None:
        """End the program without waiting for it; its run stays the one at hand."""
        if self.run:
            self.run.close()

    def pause(self) -> None:
        """Let the run stand still."""
        self._send(protocol.Pause())

    def resume(self) -> None:
        """Let the run go on."""
        self._send(protocol.Resume())

    def step(self) -> None:
        """Let one tick pass."""
        self._send(protocol.StepTicks(1))

    def debug(self, command: protocol.Message) -> None:
        """Send a command of debugging."""
        self._send(command)

    def set_speed(self, speed: float) -> None:
        """Change the pace: 1.0 real time, 0 as fast as possible."""
        self.speed = speed
        self._send(protocol.SetSpeed(speed))

    def answer(self, text: str | None) -> None:
        """Answer `input()`; None is end of file."""
        self._send(protocol.Answer(text))

    def set_pen(self, down: bool) -> None:
        """Put the pen down or up, for this run and the next."""
        if self.in_past:
            self.propose(protocol.SetPen(down))
            return
        self._send(protocol.SetPen(down))
        self.plan = plans.with_pen(self.plan, down)

    def press(self, buttons: frozenset[str]) -> None:
        """Hold these of the brick's buttons down, and no others."""
        self.pressed = buttons
        self._send(protocol.SetButtons(tuple(name for name in protocol.BUTTONS if name in buttons)))

    def set_noise(self, noise: NoiseSpec) -> None:
        """Change the noise, at once and for the next run."""
        if self.in_past:
            if noise != self._moment()[0].noise:
                self.propose(protocol.SetNoise(noise.light, noise.motor))
            return
        if noise == self.plan.spec.world.noise:
            return
        self.plan = plans.with_noise(self.plan, noise)
        self._still = replace(self._still, noise=noise)
        if self.in_run:
            self._send(protocol.SetNoise(noise.light, noise.motor))

    def set_seed(self, seed: int) -> None:
        """Choose the seed of the next run."""
        self.plan = plans.with_seed(self.plan, seed)
        self._still = replace(self._still, seed=seed)

    def place(self, pose: Pose) -> None:
        """Put the robot somewhere: during a run as a user action, else as the start of the next run."""
        command = protocol.SetPose(pose.x_mm, pose.y_mm, pose.heading_deg)
        if self.in_past:
            self.propose(command)
            return
        if self.in_run:
            self._send(command)
            return
        self._start_at(pose)

    def _start_at(self, pose: Pose) -> None:
        self.plan = plans.at_pose(self.plan, pose)
        self._still = self._at_rest(pose)
        self._moved = True

    def load(self, plan: Plan, program: Program | None) -> None:
        """Take another world or program; the robot goes to its start. Not during a run."""
        self.timeline.go(None)
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
        self._branch = None
        self.timeline.take(None)

    def _send(self, command: protocol.Message) -> None:
        # On its way to its instant a branch is done again exactly as it was.
        if self.run is not None and (self._branch is None or isinstance(command, protocol.Answer)):
            self.run.send(command)

    # What comes from the run

    def poll(self) -> News:
        """Take what has arrived; never waits.

        Raises:
            HostError: the child sent rubbish.
            LogError: its recording is damaged.
        """
        recording = self.timeline.recording
        if recording is None:
            return News([])
        ended = branched = None
        spoken: list[protocol.Spoke] = []
        held: list[protocol.Message] = []
        for event in self.run.pump() if self.run else ():
            match event:
                case protocol.Ended():
                    ended, self._end = event, event.end
                    branched = self._branch_is_there()
                case protocol.Paused() if self._branch:
                    branched = self._branch_is_there(event)
                    held.append(event)
                case protocol.Paused() | protocol.Resumed() | protocol.Looked():
                    held.append(event)
                    if isinstance(event, protocol.Paused) and event.reason == "break":
                        self.timeline.breaks.append(event.tick)
                case protocol.Spoke() if self._branch is None:
                    spoken.append(event)
        rows = recording.rows.take(ROWS_A_POLL)
        prompt = self.run.waiting_for_input if self.run and self.in_run else None
        return News(rows, 0, ended, tuple(spoken), prompt, branched, tuple(held))
