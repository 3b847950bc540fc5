"""The current run: its state and the view of it; starts runs, sends them commands, and receives their events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.app.earlier_run import find_pose, is_comparable
from tuisim.app.pending import Pending
from tuisim.app.run_update import NearSampleWatch, RunUpdate, describe_contacts, describe_remarks
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import PauseView, RunPhase, Snapshot
from tuisim.app.timeline import Timeline
from tuisim.engine import protocol
from tuisim.engine.core.drift import find_drift
from tuisim.engine.core.end_stops import build_start_flags
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import PRESSABLE, NoiseSpec, RunSpec
from tuisim.engine.core.state import Instant, Present
from tuisim.engine.protocol import RunState
from tuisim.engine.runs.command_words import WHEEL_WORDS
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_settings import require_library
from tuisim.tasks.reasons.waiting import WaitWatch

if TYPE_CHECKING:
    from tuisim.app.branch import Branch
    from tuisim.app.setup.mat import Mat
    from tuisim.base.source import Program
    from tuisim.engine.runs.handle import RunHandle
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.engine.runs.views import TickRecord


FIRST_LINE = (0, 1)
"""Tick and ordinal at which the first line of a program is about to run."""

TIME_LIMIT_S = 3600.0
"""Simulated time that a run may take: at full speed, a blocked robot would fill the disk within minutes."""

ROWS_A_POLL = 4000
"""Most output rows that one poll reads, so that a flood of prints does not block the app."""


class RunController:
    """Starts runs and sends commands to them; has the current run or, before the first run, the placed robot.

    Args:
        program: The program that runs next; None for none yet.
        next_run: The settings of the next run.
        speed: 1.0 real time, 0 as fast as possible.
    """

    def __init__(self, program: Program | None, next_run: NextRun, speed: float) -> None:
        self.program = program
        self.next_run = next_run
        self.home: Pose = self.next_run.spec.world.start
        """The pose that `back to start` uses."""
        self.speed = speed
        self.has_chosen_speed = False
        """Whether a key of the user's has set the speed."""
        self.next_options: RunOptions | None = None
        """Options of the next run only, in place of the usual ones."""
        self.mat: Mat | None = None
        self.run: RunHandle | None = None
        """The live run or the last one; None before the first one, and while a stored run is shown."""
        self._mat_of_run: Mat | None = None
        """The mat on which the run in view drove; for another robot, another mat is prepared."""
        self.timeline = Timeline()
        self.earlier: Recording | None = None
        """The run before, or one that was compared with the run in view: it is drawn beside it."""
        self.companion: Recording | None = None
        """A run that is drawn beside every run in place of the run before, such as that of a model answer."""
        self.shows_earlier = True
        self.pressed: frozenset[str] = frozenset()
        """The brick's buttons that the user holds down."""
        self._branch: Branch | None = None
        """The branch that the current run becomes, while the run is repeated up to its instant."""
        self._still = self._build_rest(self.home)
        self._end: RunState | None = None
        """How the run ended."""
        self._moved = True
        """Whether the robot was placed since the last run, so that the run's last record no longer applies."""
        self._pending = Pending()
        self._waits = WaitWatch()
        self._near_samples = NearSampleWatch()
        self.propose: Callable[[protocol.Message], bool] = lambda _: False
        """Proposes a branch with a user action if the past is in view, and returns whether it is."""
        self.shown_pause: PauseView | None = None
        """The pause that was shown last: its line and its values are more exact than the record of its tick."""
        self.chosen_line: tuple[int, int] | None = None
        """Tick and line that the user has gone to: of a sample that was clicked in the chart, or of a reason."""

    @property
    def spec(self) -> RunSpec:
        """The specification of the run if it is live or its past is in view; else that of the next run."""
        recording = self.timeline.recording
        return recording.spec if recording and (self.in_run or self.in_past) else self.next_run.spec

    @property
    def in_run(self) -> bool:
        """Whether the run is live: its child process still runs."""
        return self.run is not None and self.run.ended is None

    @property
    def in_past(self) -> bool:
        """Whether an instant before the newest one is in view."""
        return self.timeline.at is not None

    @property
    def state(self) -> RunPhase:
        """The state of the run, such as running, paused or ended."""
        run = self.run
        if run is None:
            return RunPhase.ENDED if self.timeline.recording else RunPhase.IDLE
        if run.ended is not None:
            return RunPhase.ENDED
        if run.waiting_for_input is not None and not run.paused:
            return RunPhase.WAITING
        if self._branch is not None:
            return RunPhase.STARTING
        if run.paused:
            return RunPhase.PAUSED
        return RunPhase.RUNNING if run.started else RunPhase.STARTING

    @property
    def run_id(self) -> str:
        """Id of the current or last run, empty if there was no run."""
        return self.timeline.recording.run_id if self.timeline.recording else ""

    @property
    def pose(self) -> Pose:
        """The pose of the robot at the instant in view."""
        return self._find_moment(self._record())[0].pose

    @property
    def pen_down(self) -> bool:
        """Whether the pen is down at the instant in view."""
        return self._find_moment(self._record())[2]

    def build_snapshot(self) -> Snapshot:
        """Return the state of robot and run at the instant in view, for the panels."""
        timeline = self.timeline
        recording = timeline.recording
        spec = self.spec
        newest = recording.telemetry.last() if recording else None
        past = timeline.at is not None
        now_tick = newest.tick if newest else 0
        record = None if self._moved else newest
        if past:
            record = timeline.record()
        instant, line, pen_down = self._find_moment(record)
        state = self.state
        face = timeline.face(timeline.tick if past else now_tick)
        hz = timeline.tick_hz
        turns = face.extrapolate_turns(instant.tick / hz, hz) if record else ()
        if record and (present := self._find_present(record)):
            turns = present.turns[2:]
        return Snapshot(
            state=state,
            end=self._end if state == RunPhase.ENDED else None,
            spec=spec,
            field=self._find_field(spec, record),
            instant=instant,
            line=line,
            speed=self.speed,
            pen_down=pen_down,
            stalled=recording.stalled(record)
            if record and recording and self._is_of_run
            else (False, False),
            next_spec=self.next_run.spec,
            recorded_spec=recording.spec if recording else None,
            face=face,
            turns=turns,
            pressed=self._find_pressed(record),
            wheels=recording.commands.describe_wheels() if recording else WHEEL_WORDS[-1],
            placed=recording is not None and self._moved and not past,
            past=past,
            now_tick=now_tick,
            now_pose=newest.pose if newest and past else None,
            earlier_pose=self._find_earlier_pose(instant) if record else None,
            program=recording.program if recording and self._is_of_run else self.program,
        )

    def _find_earlier_pose(self, instant: Instant) -> Pose | None:
        if self.earlier is None or not self.shows_earlier:
            return None
        pose = find_pose(self.earlier, instant.tick / self.timeline.tick_hz)
        return None if pose == instant.pose else pose

    def _build_rest(self, pose: Pose) -> Instant:
        spec = self.next_run.spec
        flags = build_start_flags(spec.robot)
        return Instant(
            0,
            pose,
            gyro_zero_deg=pose.heading_deg,
            press_flags=flags,
            noise=spec.world.noise,
            drift=find_drift(spec),
            profile=spec.profile,
            seed=spec.seed,
        )

    @property
    def _is_of_run(self) -> bool:
        """Return whether an instant of the run is in view; if not, the robot was placed again after the run."""
        return self.in_run or self.in_past

    def _record(self) -> TickRecord | None:
        """Return the record of the tick in view; None if there is no run, or the robot was moved after the run."""
        recording = self.timeline.recording
        if recording is None or (self._moved and not self.in_past):
            return None
        return self.timeline.record() or recording.telemetry.last()

    def _find_moment(self, record: TickRecord | None) -> tuple[Instant, int, bool]:
        """Return the instant of a record, the line that runs then (0 for none), and whether the pen is down.

        If the record is None, the instant and the pen are those of the robot before the next run.
        """
        recording = self.timeline.recording
        if record is None or recording is None:
            return self._still, 0, self.next_run.spec.robot.pen.down
        noise = recording.find_noise(record) if self._is_of_run else self.next_run.spec.world.noise
        instant, down = recording.read_instant(record, self.spec, noise)
        if not self._is_of_run:
            # Before a run, the pen is up or down as at the start of the next run.
            down = self.next_run.spec.robot.pen.down
        paused_line = self.shown_pause and self.shown_pause.line
        exact = dict(known for known in (paused_line, self.chosen_line) if known)
        if present := self._find_present(record):
            instant, down = present.apply(instant), present.pen_down
        line = exact.get(record.tick, record.line)
        if self.in_run and not self.in_past:
            instant, down = self._pending.apply_pending(record, instant, down)
        return instant, line, down

    def _find_present(self, record: TickRecord) -> Present | None:
        """Return the values that the program would read at the pause in view.

        The result is None if the program is not paused, or `record` is not the record of the pause.
        """
        pause = self.shown_pause
        is_there = pause is not None and (pause.past or self._is_paused)
        return pause.find_present(record, self.spec.robot) if pause and is_there else None

    def _find_pressed(self, record: TickRecord | None) -> frozenset[str]:
        """Return the buttons that are pressed at the instant in view; empty if this is no instant of a run.

        While the newest instant is in view, these are the buttons that the user holds down. If there are none, or the
        past is in view, they are the buttons that were pressed at `record`.

        Args:
            record: The record of the instant in view; None if there is none.
        """
        recording = self.timeline.recording
        if record is None or recording is None or not self._is_of_run:
            return frozenset()
        return (not self.in_past and self.pressed) or recording.pressed_at(record.tick)

    def _find_field(self, spec: RunSpec, record: TickRecord | None) -> Field | None:
        """Return the mat as the sensors saw it at the tick of a record; None while the mat is not prepared."""
        mat = self.find_mat(spec)
        recording = self.timeline.recording
        return (
            mat
            if mat is None or record is None or recording is None
            else recording.find_field(record.tick, mat)
        )

    def find_mat(self, spec: RunSpec) -> Field | None:
        """Return the prepared mat that a specification names.

        The result is None if this is not the mat of the next run or of the run in view, or if it is not prepared yet.
        """
        recording = self.timeline.recording
        mats = (self.mat, self._mat_of_run)
        mat = next((mat for mat in mats if mat and mat.serves(spec)), None)
        if recording and spec is recording.spec:
            self._mat_of_run = mat
        return mat.field if mat else None

    # The following methods do what the user wants.

    def start(self, breaks: tuple[str, ...] = (), paused: bool = False) -> None:
        """Start the program at the pose at which the robot was last placed.

        Args:
            breaks: The breakpoints.
            paused: Whether the program pauses at its first line.

        Raises:
            TuisimError: the run cannot be started, or the chosen profile is not for the program's library.
        """
        if self.program is None or self.in_run:
            return
        program = replace(
            self.program,
            arguments=self.next_run.settings["arguments"],
            shown_ports=self.next_run.shown_ports if "robot" in self.next_run.free else None,
        )
        if "profile" not in self.next_run.free:
            require_library(program, self.next_run.spec.profile)
        options = replace(
            self.next_options or self._options,
            breaks=breaks,
            hold_at=FIRST_LINE if paused else None,
            actions=self.next_run.actions,
        )
        self.next_options = None
        self._show_run(start_run(program, self.next_run.spec, options))

    def prepare_next(self) -> None:
        """Prepare a process for later runs of the same robot in the same world, so that they start sooner.

        Do nothing before the first run.
        """
        if self.run:
            self.run.prepare_next()

    @property
    def _options(self) -> RunOptions:
        return RunOptions(
            live=True,
            speed=self.speed,
            time_limit_s=TIME_LIMIT_S,
            stall_limit_s=0.0,
            asks_user=True,
        )

    def start_branch(self, branch: Branch) -> None:
        """Start a branch: repeat a former run as fast as possible up to an instant, and continue from there.

        The current run is closed.

        Raises:
            TuisimError: the run cannot be started.
        """
        noise = branch.noise
        hold_at = branch.tick, protocol.BEFORE_NEXT_TICK
        options = replace(
            self._options, answers=branch.of.answers, actions=branch.script(), hold_at=hold_at
        )
        run = start_run(branch.runs, branch.of.first_spec, options)
        RunStore().tag(run.run_id, branch.tags)
        self._show_run(run, branch.of.answers)
        # The next run has the noise of the branch, too, as if the user had chosen it.
        self.next_run = plans.change_noise(self.next_run, noise)
        self._branch = branch

    def _finish_branch(self, paused: protocol.Paused | None = None) -> Branch | None:
        """Finish the start of a branch, whose run has paused at the instant up to which it repeats the former run.

        Apply the user's action at that instant, and continue the run if the branch is to go on. If the program has
        ended before that instant, the run has paused at its end, and is continued without the action.

        Args:
            paused: The pause; None if the run has ended, so that there is nothing to continue.

        Returns:
            The branch; None if no branch is being started.
        """
        branch = self._branch
        self._branch = None
        if branch is not None and paused is not None:
            early = paused.tick < branch.tick
            self.send(protocol.SetSpeed(self.speed))
            if branch.of.pressed_at(branch.tick + 1) and not early:
                # The user no longer holds the buttons that were pressed at that tick.
                self.send(protocol.SetButtons(()))
            if branch.then is not None and not early:
                self.send(branch.then)
            if early or (branch.goes_on and not self.in_past):
                self.send(protocol.Resume())
        return branch

    def replay(self, run: StoredRun) -> None:
        """Show a stored run as a run that has ended; call this only while no run is live."""
        self.close()
        self._end = run.state
        self._show_recording(Recording(run))

    def show_earlier(self, earlier: Recording | None) -> None:
        """Draw an earlier run beside the run in view, if both drove on the same mat; None draws no earlier run."""
        later = self.timeline.recording
        self.earlier = earlier if earlier and later and is_comparable(earlier, later) else None

    def set_companion(self, companion: Recording | None) -> None:
        """Draw the same run beside each run, instead of the run before it.

        Args:
            companion: The run to draw, such as that of a model answer; None draws the run before each run again.
        """
        self.companion = companion
        self.shows_earlier = True
        self.show_earlier(companion)

    def _show_run(self, run: RunHandle, answers: tuple[str, ...] = ()) -> None:
        """Show a run that was just started, with the former run beside it.

        Args:
            run: The run.
            answers: The answers to `input()` that were given in advance.
        """
        before = self.timeline.recording
        self.close()
        self.run = run
        self._end = None
        self._show_recording(Recording(run, answers))
        self.show_earlier(self.companion or before)

    def _show_recording(self, recording: Recording) -> None:
        # New data stays unread until the next poll, so that everything in a frame belongs to one instant.
        recording.hold()
        self.timeline.show_run(recording)
        self.show_earlier(self.companion)
        self._pending.forget()
        self.pressed = frozenset()
        self._moved = False

    def stop(self) -> None:
        """Send the program a request to stop; a later `poll` reports its end."""
        if self.run:
            self.run.stop()

    def stop_now(self) -> None:
        """Stop the program immediately, without its cooperation; its run stays the current run."""
        if self.run:
            self.run.close()

    def pause(self) -> None:
        """Pause the live run; do nothing without one, or if it is paused already."""
        if self.in_run and self.state is not RunPhase.PAUSED:
            self.send(protocol.Pause())

    def set_speed(self, speed: float) -> None:
        """Change the speed of the live run and of later runs: 1.0 is real time, 0 as fast as possible."""
        self.speed = speed
        self.send(protocol.SetSpeed(speed))

    def set_pen(self, down: bool) -> None:
        """Put the pen down, or lift it if `down` is False, in the live run and in the next run."""
        if self.propose(protocol.SetPen(down)):
            return
        self._send_action(protocol.SetPen(down))
        self.next_run = plans.change_pen(self.next_run, down)

    def press(self, buttons: frozenset[str]) -> None:
        """Hold down these buttons and touch sensors, which are named as in `PRESSABLE`, and release all others."""
        if buttons == self.pressed:
            return
        self.pressed = buttons
        self.send(protocol.SetButtons(tuple(name for name in PRESSABLE if name in buttons)))

    def set_noise(self, noise: NoiseSpec) -> None:
        """Change the noise of the live run and of the next run."""
        present = self._find_moment(self._record())[0] if self.in_past else self.next_run.spec.world
        change = protocol.SetNoise(noise.light, noise.motor)
        if noise == present.noise or self.propose(change):
            return
        self.next_run = plans.change_noise(self.next_run, noise)
        self._still = replace(self._still, noise=noise)
        if self.in_run:
            self._send_action(change)

    def set_seed(self, seed: int) -> None:
        """Set the seed of the next run."""
        self.next_run = plans.change_seed(self.next_run, seed)
        self._still = replace(self._still, seed=seed)

    def place(self, pose: Pose) -> None:
        """Place the robot at a pose: in a live run as a user action, else as the start pose of the next run.

        If a past instant is in view, only ask the user whether to start a branch there with this pose.
        """
        command = protocol.SetPose(pose.x_mm, pose.y_mm, pose.heading_deg)
        if self.propose(command):
            return
        if self.in_run:
            # While paused, placing the robot where it already is would only add a needless action to the record.
            if not self._is_paused or pose != self.pose:
                self._send_action(command)
            return
        self._set_start(pose)

    def _set_start(self, pose: Pose) -> None:
        self.next_run = plans.move_start(self.next_run, pose)
        self._still = self._build_rest(pose)
        self._moved = True

    def load(self, plan: NextRun, program: Program | None) -> None:
        """Set another world or program for the next run; the robot goes to the start pose of that world.

        Call this only while no run is live.

        Args:
            plan: The plan of the next run.
            program: The program of the next run; None for none.
        """
        self.timeline.go(None)
        self.next_run = plan
        self.program = program
        self.home = plan.spec.world.start
        self._set_start(plan.spec.world.start)

    def change(self, plan: NextRun) -> None:
        """Set a plan of the next run with the same start pose; call this only while no run is live.

        The robot stays where it is. The view returns from the past, so that the change is visible.
        """
        self.timeline.go(None)
        self.next_run = plan
        world = plan.spec.world
        self._still = replace(
            self._still, noise=world.noise, drift=find_drift(plan.spec), seed=plan.spec.seed
        )

    def close(self) -> None:
        """Close the current run, and kill its child process if that still runs."""
        if self.run:
            if self.run.ended is None:
                self.run.kill()
            self.run.close()
            self.run = None
        self._branch = None
        self.timeline.show_run(None)

    def _send_action(self, action: protocol.Message) -> None:
        """Send a user action that changes the world; during a pause, show its effect before the run has recorded it."""
        record = self._record()
        if record is not None and self._branch is None and self._is_paused:
            self._pending.note(record, action)
        self.send(action)

    @property
    def _is_paused(self) -> bool:
        return self.run is not None and self.run.paused

    def send(self, command: protocol.Message) -> None:
        """Send a command to the live run; do nothing without one."""
        # On the way to its instant, a branch must repeat the run exactly, so only answers to `input()` are sent.
        if self.run is not None and (self._branch is None or isinstance(command, protocol.Answer)):
            self.run.send(command)

    # The following methods handle messages of the run.

    def poll(self) -> RunUpdate:
        """Process what the run has sent, and return it; never blocks.

        Raises:
            HostError: the child sent malformed data.
            LogError: the recording is damaged.
        """
        recording = self.timeline.recording
        if recording is None:
            return RunUpdate([])
        ended = branched = None
        spoken: list[protocol.Spoke] = []
        pauses: list[protocol.Message] = []
        remarks: list[str] = []
        for event in self.run.pump() if self.run else ():
            match event:
                case protocol.Ended():
                    ended = event
                    self._end = event.end
                    branched = self._finish_branch()
                case protocol.Paused() if self._branch:
                    branched = self._finish_branch(event)
                    pauses.append(event)
                case protocol.Paused() | protocol.Resumed() | protocol.Inspected():
                    pauses.append(event)
                    if (
                        isinstance(event, protocol.Paused)
                        and event.reason is protocol.PauseReason.BREAK
                    ):
                        self.timeline.breaks.append(event.tick)
                case protocol.Spoke() if self._branch is None:
                    spoken.append(event)
                case protocol.BusyLoop() | protocol.Plugged() if self._branch is None:
                    remarks += describe_remarks(event, recording)
        stood = describe_contacts(recording.telemetry, recording.spec) if ended else ""
        if not self.in_past:
            remarks += self._waits.look(
                recording, ended, self.state is RunPhase.RUNNING, self.find_mat
            )
        rows = recording.take_rows(ROWS_A_POLL)
        remarks += self._near_samples.look(recording, rows)
        prompt = self.run.waiting_for_input if self.run else None
        return RunUpdate(
            rows, ended, stood, tuple(spoken), prompt, branched, tuple(pauses), tuple(remarks)
        )
