"""Starts runs, sends them commands, and receives their events."""

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
    from tuisim.runs.run_folder import StoredRun
    from tuisim.source import Program

FIRST_LINE = (0, 1)
"""Tick and ordinal at which the first line of a program is about to run."""

ROWS_A_POLL = 4000
"""Most output rows that one poll reads, so that a flood of prints does not block the app."""


class RunController(RunView):
    """The current run, or the robot before a run.

    Args:
        settings: The options that the app was started with.
    """

    def __init__(self, settings: AppSettings) -> None:
        super().__init__(settings)
        self.propose: Callable[[protocol.Message], None] = lambda _: None
        """Called instead of a user action while a past instant is in view: the action is only possible in a branch."""

    # What the user does

    def start(self, breaks: tuple[str, ...] = (), held: bool = False) -> None:
        """Start the program from where the robot was last placed.

        Args:
            breaks: The breakpoints.
            held: Pause at the first line.

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
        self.run, self._end = run, None
        self._look_at(Recording(self.run))

    def branch(self, branch: Branch) -> None:
        """Repeat a run up to an instant of it, and continue from there. Ends the current run.

        Raises:
            TuisimError: the run cannot be started.
        """
        noise = branch.noise
        run = branch.start(self.speed)
        self.close()
        self.run, self._end = run, None
        # The noise of the current run is that of the next one, as if chosen now.
        self.plan = plans.with_noise(self.plan, noise)
        self._look_at(Recording(run, branch.of.answers))
        self._branch = branch

    def _branch_arrived(self, held: protocol.Paused | None = None) -> Branch | None:
        """Switch from the former run to the new one, which is paused at the instant of the branch or has ended.

        A program that ends before that instant is paused at its end.
        """
        branch, self._branch = self._branch, None
        if branch is not None and held is not None:
            early = held.tick < branch.tick
            self._send(protocol.SetSpeed(self.speed))
            if branch.of.pressed_at(branch.tick + 1) and not early:
                # Buttons that were held then have been released meanwhile.
                self._send(protocol.SetButtons(()))
            if branch.then is not None and not early:
                self._send(branch.then)
            if early or (branch.goes_on and not self.in_past):
                self._send(protocol.Resume())
        return branch

    def replay(self, run: StoredRun) -> None:
        """Show a stored run, as one that has ended. Not during a run."""
        self.close()
        self._end = run.state
        self._look_at(Recording(run))

    def _look_at(self, recording: Recording) -> None:
        self.timeline.take(recording)
        self._pending.forget()
        self.pressed = frozenset()
        self._moved = False

    def stop(self) -> None:
        """Ask the program to stop; the end arrives with a later poll."""
        if self.run:
            self.run.stop()

    def stop_now(self) -> None:
        """Stop the program without waiting for it; its run stays the current one."""
        if self.run:
            self.run.close()

    def pause(self) -> None:
        """Pause the run."""
        self._send(protocol.Pause())

    def resume(self) -> None:
        """Resume the run."""
        self._send(protocol.Resume())

    def step(self) -> None:
        """Run one tick."""
        self._send(protocol.StepTicks(1))

    def debug(self, command: protocol.Message) -> None:
        """Send a debug command."""
        self._send(command)

    def set_speed(self, speed: float) -> None:
        """Change the speed: 1.0 is real time, 0 as fast as possible."""
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
        """Hold down these buttons of the brick, and no others."""
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
        """Place the robot: during a run as a user action, else as the start of the next run."""
        command = protocol.SetPose(pose.x_mm, pose.y_mm, pose.heading_deg)
        if self.in_past:
            self.propose(command)
            return
        if self.in_run:
            # While paused, placing the robot where it already is would only add a needless action to the record.
            if not self._is_paused or pose != self.pose:
                self._act(command)
            return
        self._start_at(pose)

    def _start_at(self, pose: Pose) -> None:
        self.plan = plans.at_pose(self.plan, pose)
        self._still = self._at_rest(pose)
        self._moved = True

    def load(self, plan: NextRun, program: Program | None) -> None:
        """Load another world or program; the robot goes to its start. Not during a run."""
        self.timeline.go(None)
        self.plan, self.program, self.home = plan, program, plan.spec.world.start
        self._start_at(plan.spec.world.start)

    def change(self, plan: NextRun) -> None:
        """Set a plan that differs in other things than the start; the robot stays where it is. Not during a run.

        The view returns from the past, so that the change is visible.
        """
        self.timeline.go(None)
        self.plan = plan
        self._still = replace(self._still, noise=plan.spec.world.noise, seed=plan.spec.seed)

    def close(self) -> None:
        """Release the run; a child process that still runs is killed."""
        if self.run:
            if self.run.ended is None:
                self.run.kill()
            self.run.close()
            self.run = None
        self._branch = None
        self.timeline.take(None)

    def _act(self, action: protocol.Message) -> None:
        """Send an action that changes the world; while paused, show it before it has taken effect."""
        record = self._record()
        if record is not None and self._branch is None and self._is_paused:
            self._pending.note(record, action)
        self._send(action)

    @property
    def _is_paused(self) -> bool:
        return self.run is not None and self.run.paused

    def _send(self, command: protocol.Message) -> None:
        # On the way to its instant, a branch must repeat the run exactly.
        if self.run is not None and (self._branch is None or isinstance(command, protocol.Answer)):
            self.run.send(command)

    # What comes from the run

    def poll(self) -> RunUpdate:
        """Process what has arrived; never blocks.

        Raises:
            HostError: the child sent malformed data.
            LogError: the recording is damaged.
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
                    branched = self._branch_arrived()
                case protocol.Paused() if self._branch:
                    branched = self._branch_arrived(event)
                    held.append(event)
                case protocol.Paused() | protocol.Resumed() | protocol.Inspected():
                    held.append(event)
                    if isinstance(event, protocol.Paused) and event.reason is protocol.PauseReason.BREAK:
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
    """Set once, in the poll that receives the end."""
    spoken: tuple[protocol.Spoke, ...] = ()
    """Texts and sounds from the program."""
    prompt: str | None = None
    """The prompt while the program waits in `input()`."""
    branched: Branch | None = None
    """Set once, when a branch has reached its instant, or has ended before it."""
    held: tuple[protocol.Message, ...] = ()
    """Reports that the program has paused or resumed, and its frames and variables."""

    def __bool__(self) -> bool:
        """Return whether anything has arrived; a prompt that is still open does not count."""
        return bool(self.rows or self.ended or self.spoken or self.branched or self.held)
