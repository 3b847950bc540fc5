"""What the app shows: one frozen state a frame, and how users read phases and speeds."""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum
from functools import cached_property
from typing import TYPE_CHECKING, assert_never

from tuisim.base.data_class import dataclass
from tuisim.base.source import Program
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors import color, measure_sensors, ultrasonic
from tuisim.engine.core.sensors.color import ColorReading
from tuisim.engine.core.spec import RobotSpec, RunSpec
from tuisim.engine.core.state import Instant, Present
from tuisim.engine.protocol import BusyLoop, End, Ended, Inspected, Paused, RunState, Unended
from tuisim.engine.runs.brick_state import BrickState
from tuisim.engine.runs.command_words import WHEEL_WORDS
from tuisim.engine.runs.run_folder import format_end

if TYPE_CHECKING:
    from tuisim.engine.runs.views import TickRecord

CHART_PERIOD_S = 0.33
"""Drawing a chart takes tens of milliseconds: three times a second is enough to follow it."""


class RunPhase(StrEnum):
    """The state of the run in view, such as running, paused or ended."""

    IDLE = "idle"
    """There is no run yet."""
    STARTING = "starting"
    """The child process starts, or a branch is on the way to its instant."""
    RUNNING = "running"
    PAUSED = "paused"
    WAITING = "waiting"
    """The program waits in `input()`."""
    ENDED = "ended"


IN_RUN = frozenset({RunPhase.STARTING, RunPhase.RUNNING, RunPhase.PAUSED, RunPhase.WAITING})
"""The phases in which a child process runs."""

AT_REST = frozenset({RunPhase.PAUSED, RunPhase.ENDED})
"""The phases in which a run stands still."""

GOOD_ENDS: frozenset[RunState | None] = frozenset({End.FINISHED, End.STOPPED})
"""Ways to end a run that are no failure."""

_DARK = BrickState()


@dataclass(frozen=True)
class Snapshot:
    """The state of the robot and the run at the instant in view, for the panels.

    Readings of sensors are computed when a panel reads them first.
    """

    state: RunPhase
    end: RunState | None
    """How the run ended; None unless `state` is ended."""
    spec: RunSpec
    field: Field | None
    """The mat as the sensors see it; None until it has been prepared."""
    instant: Instant
    line: int
    """Line of the program during which time passes, 0 for none."""
    speed: float
    """Speed of the run: 1.0 is real time, 0 as fast as possible."""
    pen_down: bool
    stalled: tuple[bool, bool] = (False, False)
    """Whether the left and the right motor are commanded to run but cannot turn."""
    next_spec: RunSpec | None = None
    """Settings of the next run; differ from `spec` in what was changed during the run. None: the same."""

    recorded_spec: RunSpec | None = None
    """Settings of the run whose records charts show; None without a run."""

    face: BrickState = _DARK
    """What the brick shows."""
    turns: tuple[tuple[float, float], ...] = ()
    """Position in degrees and speed in degrees per second of each motor that does not drive the robot; empty before
    a run, and after the robot was placed following it: all motors are reset."""
    pressed: frozenset[str] = frozenset()
    """The brick's buttons that are held down."""
    wheels: str = WHEEL_WORDS[-1]
    """How the program has left wheels that turn, of `WHEEL_WORDS`."""

    placed: bool = False
    """Whether the robot was placed since the run, so that this is what the next one begins with."""
    past: bool = False
    """Whether this is a past instant, and not the newest one."""
    now_tick: int = 0
    """The newest tick of the run."""
    now_pose: Pose | None = None
    """The current pose of the robot, while another instant is viewed."""
    earlier_pose: Pose | None = None
    """The pose of the robot of an earlier run at the same time; None if none is shown, or if it is the same."""
    program: Program | None = None
    """The program of the run, or of the next one."""

    @cached_property
    def time_s(self) -> float:
        """The simulated time in s."""
        return self.instant.tick / self.tick_hz

    @property
    def tick_hz(self) -> int:
        """Ticks per simulated second of the run in view."""
        return (self.recorded_spec or self.spec).profile.tick_hz

    def list_turns(self) -> list[tuple[float, float]]:
        """Return position in degrees and speed in degrees/s of each motor, as the program reads them.

        The wheel motors come first, the left one before the right one.
        """
        now = self.instant
        turns = (
            (now.left_position_deg, now.left_speed_dps),
            (now.right_position_deg, now.right_speed_dps),
            *(self.turns or [(0.0, 0.0)] * len(self.spec.robot.extra_motors)),
        )
        return [
            (now.get_scale(number) * position_deg, now.get_scale(number) * dps)
            for number, (position_deg, dps) in enumerate(turns)
        ]

    @cached_property
    def colors(self) -> Mapping[str, ColorReading]:
        """The readings of the colour sensors by their names, such as `left`; empty without a mat."""
        if self.field is None:
            return {}
        return {
            s.name: color.measure_color(s, self.instant, self.field)
            for s in self.spec.robot.color_sensors
        }

    @cached_property
    def ultrasonic_mm(self) -> int | None:
        """The distance that the ultrasonic sensor measures, in mm; None without such a sensor."""
        sensor = self.spec.robot.ultrasonic
        return (
            ultrasonic.measure_noisy_mm(sensor, self.instant, self.spec.world) if sensor else None
        )

    @cached_property
    def rays(self) -> tuple[tuple[float, float], ...]:
        """The rays of the ultrasonic sensor as (world angle in degrees, length in mm); empty without such a sensor."""
        sensor = self.spec.robot.ultrasonic
        return (
            tuple(ultrasonic.measure_rays_mm(self.instant.pose, sensor, self.spec.world))
            if sensor
            else ()
        )

    @cached_property
    def gyro_deg(self) -> int:
        """The angle that the gyro measures, in degrees; 0 without a gyro."""
        return self.instant.gyro_deg if self.spec.robot.gyro is not None else 0

    @cached_property
    def gyro_rate_dps(self) -> int:
        """The rate of turn that the gyro measures, in degrees/s; 0 without a gyro."""
        return self.instant.gyro_rate_dps if self.spec.robot.gyro is not None else 0

    @cached_property
    def further(self) -> Mapping[str, float]:
        """The readings of sensors that most robots do not have, by telemetry column, such as `bumper_pressed`."""
        if self.field is None:
            return {}
        return measure_sensors(self.spec.robot.further_sensors, self.instant, self.spec, self.field)

    @property
    def state_label(self) -> str:
        """The state at the instant in view: `past`, `moved` for a robot that was placed since, or that of the run."""
        if self.past:
            return "past"
        if self.placed:
            return "moved"
        return end_label(self.end) if self.state is RunPhase.ENDED else self.state.value

    @property
    def turning(self) -> str:
        """Words to append to the state of an ended run whose wheels still turn; empty in any other case."""
        is_end = self.state is RunPhase.ENDED and not (self.past or self.placed)
        turns = self.instant.left_speed_dps or self.instant.right_speed_dps
        return f", {self.wheels}" if is_end and turns else ""

    def has_stopped_since(self, before: Snapshot | None) -> bool:
        """Return whether the run has paused or ended since an earlier snapshot.

        Args:
            before: The earlier snapshot; if it is None, the result is False.
        """
        return before is not None and self.state in AT_REST and before.state is not self.state

    @property
    def failed(self) -> bool:
        """Whether the end of a run that has failed is in view."""
        return (
            not (self.past or self.placed)
            and self.state == RunPhase.ENDED
            and self.end is not None
            and self.end not in GOOD_ENDS
        )

    @property
    def planned(self) -> RunSpec:
        """The specification of the next run; if there is no plan for it, that of the run in view."""
        return self.next_spec or self.spec


@dataclass(frozen=True, slots=True)
class PauseView:
    """A pause of a program: the line at which it is paused, and the frames and variables at that line."""

    paused: Paused
    inspected: Inspected
    past: bool
    """Whether this is a past instant."""

    @property
    def line(self) -> tuple[int, int]:
        """The tick of the pause, and the line of the program.

        The line is 0 if the program is paused in another module.
        """
        return self.paused.tick, 0 if self.paused.file else self.paused.line

    def find_present(self, record: TickRecord, robot: RobotSpec) -> Present | None:
        """Return what the program would read at the pause; None if that is unknown.

        The result is also None if the record is not of the instant of the pause, or the user has changed something
        since then.
        """
        present = self.inspected.present
        key = record.tick, record.actions
        if present is None or (self.inspected.tick, present.actions) != key:
            return None
        # The program could have forged the message, so its numbers must fit the robot.
        counts = {len(present.turns), len(present.scales), len(present.motors) or len(robot.motors)}
        return present if counts == {len(robot.motors)} else None


@dataclass(frozen=True, slots=True)
class Situation:
    """The state of the app that decides whether a key is available."""

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
    has_reasons: bool = False
    """Whether the run in view went wrong, or repeats an earlier one that it is compared with."""
    can_undo: bool = False
    """Whether there is a change that the undo key can undo."""
    lesson_actions: tuple[str, ...] = ()
    """Ids of the actions that help in the step of the open lesson."""


@dataclass(frozen=True, slots=True)
class AppState:
    """Everything that the panels and the footer show at one moment; made once for each frame."""

    run: Snapshot
    """The run at the instant in view."""
    situation: Situation
    looks_back: bool
    """Whether a past instant is viewed, even one within the newest tick."""
    playing: bool
    """Whether the recording is being played."""

    @property
    def status(self) -> str:
        """The state and the speed of the run, in words."""
        run = self.run
        status = run.state_label
        if self.looks_back:
            status = "playing" if self.playing else f"past {run.time_s:.2f} s"
        return (
            f"{status} {speed_label(run.speed)}"
            if run.state in IN_RUN or run.speed != 1
            else status
        )

    @property
    def failed(self) -> bool:
        """Whether the end of a run that has failed is in view."""
        return self.run.failed and not self.looks_back


def speed_label(speed: float) -> str:
    """Return the speed of a run as users read it: ¼×, 2×, max."""
    return {0.0: "max", 0.25: "¼×", 0.5: "½×"}.get(speed, f"{speed:g}×")


def end_words(ended: Ended, stood: str) -> tuple[str, str]:
    """Return two texts about the end of a run: one for the notice, one for the end of the output.

    Args:
        ended: How the run ended.
        stood: Where something solid stopped the robot, in words; may be empty.
    """
    words = ended.summary or end_label(ended.end)
    if caught := ended.end is End.FINISHED and not ended.exit_code and bool(ended.summary):
        words = f"{end_label(ended.end)}: {ended.summary}"
    # The output already shows the traceback, so the last line need not repeat the error.
    known = ended.end in (End.FINISHED, End.RAISED) and not caught
    end = end_label(ended.end) if known else words
    if ended.end is End.RAISED and ended.error_line:
        end = f"line {ended.error_line}"
    last = f"— {end} at {format_end(ended.time_ns / 1e9)} s"
    return ", ".join(filter(None, (words, stood))), ", ".join(filter(None, (last, stood)))


def describe_busy_loop(busy_loop: BusyLoop) -> str:
    """Return what the output says about a program that is in a loop without a wait; ids of actions are in braces."""
    since = f"{busy_loop.since_ns / 1e9:.2f} s"
    return f"— line {busy_loop.line}: a loop without a wait since {since}. {{stop}} stops it"


_NUMBERS = re.compile(r"""'[^']*'|"[^"]*"|(?<![\w.])-?\d+\.\d+(?:e[+-]?\d+)?(?![\w.])""")

_SHORT = 6
"""Characters of a number that stays as it is."""


def shorten_value(text: str) -> str:
    """Return the text of a value in which long decimal numbers have four digits, except in strings."""

    def shorten_number(match: re.Match[str]) -> str:
        word = match[0]
        if word[0] in "'\"" or len(word) <= _SHORT:
            return word
        number = float(word)
        # The time since 1970, which has ten digits, gets decimals, since only its last digits differ between readings.
        form = ".1f" if 1000 <= abs(number) < 1e9 else ".2f" if 1e9 <= abs(number) < 1e10 else ".4g"
        return min(word, format(number, form), key=len)

    return _NUMBERS.sub(shorten_number, text)


def end_label(state: RunState | None) -> str:
    """Return in words how a run ended; empty if its end is unknown."""
    match state:
        case End.RAISED:
            return "error"
        case End() | Unended():
            return state.replace("_", " ")
        case None:
            return ""
        case _:
            assert_never(state)
