"""Between the app and a run: starts it, sends commands, and receives its events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.run_view import RunView
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.core.geometry import Pose
from tuisim.core.spec import NoiseSpec
from tuisim.runs.recording import Recording
from tuisim.runs.records import OutputRow

if TYPE_CHECKING:
    from tuisim.app.actions.branch import Branch
    from tuisim.app.start_options import AppSettings
    from tuisim.runs.handle import Program
    from tuisim.runs.run_folder import StoredRun

FIRST_LINE = (0, 1)
"""Tick and ordinal at which the first line of a program is about to run."""

ROWS_A_POLL = 4000
"""Most output rows that one poll takes, so that a flood of prints leaves the app fluid."""


class RunController(RunView):
    """The run at hand, or the robot at rest.

    Args:
        settings: What the app was started with.
    """

    def __init__(self, settings: AppSettings) -> None:
        super().__init__(settings)
        self.propose: Callable[[protocol.Message], None] = lambda _: None
        """Called instead of a user action while a former instant is looked at: it can only be done in a branch."""

    # What the user does

    def start(self, breaks: tuple[str, ...] = (), held: bool = False) -> None:
        """Start the program from where the robot was last put.

        Args:
            breaks: What holds it.
            held: Hold it at its first line.

        Raises:
            TuisimError: the run cannot be started.
        """
        from tuisim.runs.handle import RunOptions, start_run

        if self.program is None or self.in_run:
            return
        options = RunOptions(
            live=True, speed=self.speed, time_limit_s=0.0, stall_limit_s=0.0, asks_user=True,
            breaks=breaks, hold_at=FIRST_LINE if held else None,
        )  # fmt: skip
        program = replace(self.program, arguments=self.plan.settings.arguments)
        run = start_run(program, self.plan.spec, options)
        self.close()
        self.run, self._end = run, ""
        self._look_at(Recording(self.run))

    def branch(self, branch: Branch) -> None:
        """Do a run again up to an instant of it, and go on from there. Ends the run at hand.

        Raises:
            TuisimError: the run cannot be started.
        """
        noise = branch.noise
        run = branch.start(self.speed)
        self.close()
        self.run, self._end = run, ""
        # The noise of the run at hand is that of the next one, as if it had been chosen now.
        self.plan = plans.with_noise(self.plan, noise)
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
            if branch.of.pressed_at(branch.tick + 1) and not early:
                # Whoever held them then has let go meanwhile.
                self._send(protocol.SetButtons(()))
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
        self._pending.forget()
        self.pressed = frozenset()
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
        self._act(protocol.SetPen(down))
        self.plan = plans.with_pen(self.plan, down)

    def press(self, buttons: frozenset[str]) -> None:
        """Hold these of the brick's buttons down, and no others."""
        if buttons == self.pressed:
            return
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
            self._act(protocol.SetNoise(noise.light, noise.motor))

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
            # Where time stands still, to put it where it is would only be noted as one thing more that was done.
            if not self._stands_still or pose != self.pose:
                self._act(command)
            return
        self._start_at(pose)

    def _start_at(self, pose: Pose) -> None:
        self.plan = plans.at_pose(self.plan, pose)
        self._still = self._at_rest(pose)
        self._moved = True

    def load(self, plan: NextRun, program: Program | None) -> None:
        """Take another world or program; the robot goes to its start. Not during a run."""
        self.timeline.go(None)
        self.plan, self.program, self.home = plan, program, plan.spec.world.start
        self._start_at(plan.spec.world.start)

    def change(self, plan: NextRun) -> None:
        """Take a plan that differs in other things than the start; the robot stays where it is. Not during a run.

        What was changed is seen now, not in the past.
        """
        self.timeline.go(None)
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

    def _act(self, action: protocol.Message) -> None:
        """Send what changes the world; where time stands still that is shown before it has taken effect."""
        record = self._record()
        if record is not None and self._branch is None and self._stands_still:
            self._pending.note(record, action)
        self._send(action)

    @property
    def _stands_still(self) -> bool:
        return self.run is not None and self.run.paused

    def _send(self, command: protocol.Message) -> None:
        # On its way to its instant a branch is done again exactly as it was.
        if self.run is not None and (self._branch is None or isinstance(command, protocol.Answer)):
            self.run.send(command)

    # What comes from the run

    def poll(self) -> RunUpdate:
        """Take what has arrived; never waits.

        Raises:
            HostError: the child sent rubbish.
            LogError: its recording is damaged.
        """
        recording = self.timeline.recording
        if recording is None:
            return RunUpdate([])
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
                case protocol.Paused() | protocol.Resumed() | protocol.Inspected():
                    held.append(event)
                    if isinstance(event, protocol.Paused) and event.reason == "break":
                        self.timeline.breaks.append(event.tick)
                case protocol.Spoke() if self._branch is None:
                    spoken.append(event)
        rows = recording.rows.take(ROWS_A_POLL)
        prompt = self.run.waiting_for_input if self.run and self.in_run else None
        return RunUpdate(rows, 0, ended, tuple(spoken), prompt, branched, tuple(held))


@dataclass(frozen=True, slots=True)
class RunUpdate:
    """What has come from the run since the last poll."""

    rows: list[OutputRow]
    skipped: int = 0
    """Rows left out before `rows`."""
    ended: protocol.Ended | None = None
    """Set once, in the poll in which the end is learnt."""
    spoken: tuple[protocol.Spoke, ...] = ()
    """What the program said."""
    prompt: str | None = None
    """The prompt while the program waits in `input()`."""
    branched: Branch | None = None
    """Set once, when a branch has come to its instant, or has ended before."""
    held: tuple[protocol.Message, ...] = ()
    """That the program stands still or goes on, and what it looks like."""

    def __bool__(self) -> bool:
        """Whether anything has come; that the program still waits for an answer is nothing new."""
        return bool(self.rows or self.ended or self.spoken or self.branched or self.held)
