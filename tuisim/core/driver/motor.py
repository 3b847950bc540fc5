"""A motor as programs see it: attributes, commands, ramps, timed moves and states of the class of all motors.

A command takes a copy of all set points: what is written later waits for the next command.
"""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum

from tuisim.core.driver.control import divide
from tuisim.core.driver.jiffies import Jiffies, round_up
from tuisim.core.driver.plant import STEP_NS, PlantSpec
from tuisim.core.driver.regulator import Model, MotorDriver, StopAction
from tuisim.data_class import dataclass

NEVER_NS = 1 << 62
RAMP_JIFFIES = 10
"""A ramp changes the setpoint again after about this time, less the time since its change before."""
RAMP_LEAD_JIFFIES = 5
"""A ramp begins this long before its command."""


class Command(StrEnum):
    """What a program writes to `command`."""

    RUN_FOREVER = "run-forever"
    RUN_TO_ABS_POS = "run-to-abs-pos"
    RUN_TO_REL_POS = "run-to-rel-pos"
    RUN_TIMED = "run-timed"
    RUN_DIRECT = "run-direct"
    STOP = "stop"
    RESET = "reset"


class State(StrEnum):
    """What `state` can list, in this order."""

    RUNNING = "running"
    RAMPING = "ramping"
    HOLDING = "holding"
    OVERLOADED = "overloaded"
    STALLED = "stalled"


@dataclass(frozen=True, slots=True)
class SetPoints:
    """What a program has set for the next command, in the motor's own direction."""

    speed_dps: int = 0
    position: int = 0
    duty: int = 0
    time_ms: int = 0
    ramp_up_ms: int = 0
    ramp_down_ms: int = 0
    stop_action: StopAction = StopAction.COAST

    @property
    def ramped(self) -> bool:
        """Whether the speed changes by ramps."""
        return bool(self.ramp_up_ms or self.ramp_down_ms)


@dataclass(frozen=True, slots=True)
class Ramp:
    """A change of the speed setpoint."""

    start_jiffy: int
    jiffies: int
    """How long it takes."""
    start_dps: int
    end_dps: int

    def compute_setpoint(self, jiffy: int) -> int:
        """Return the setpoint at a time."""
        left = self.start_jiffy + self.jiffies - jiffy
        if left <= 0:
            return self.end_dps
        return self.end_dps - divide((self.end_dps - self.start_dps) * left, self.jiffies)


class DriverMotor(MotorDriver):
    """A motor with the class of all motors above its driver.

    Args:
        model: The kind of motor.
        plant: The motor with its load.
        battery_v: The voltage of the battery, open.
        jiffies: The kernel's clock.
    """

    __slots__ = (
        "_active",
        "_due_ns",
        "_ends_at_target",
        "_jiffies",
        "_last_command",
        "_ramp",
        "_ramp_goal_dps",
        "_ramp_jiffy",
        "_ramp_ns",
        "_ramp_setpoint",
        "_step_ns",
        "_stops_after_ramp",
        "_timed_ns",
        "is_ramping",
        "setpoints",
    )

    def __init__(self, model: Model, plant: PlantSpec, battery_v: float, jiffies: Jiffies) -> None:
        super().__init__(model, plant, battery_v)
        self._jiffies = jiffies
        self.setpoints = self._active = SetPoints()
        self._last_command: Command | None = None
        self._step_ns = STEP_NS
        self._ramp_ns = self._timed_ns = self._due_ns = NEVER_NS
        """When a ramp's next change and the end of a timed move are due, and the earlier of the two."""
        self._ramp = Ramp(0, 0, 0, 0)
        self._ramp_goal_dps = self._ramp_jiffy = self._ramp_setpoint = 0
        self.is_ramping = self._stops_after_ramp = self._ends_at_target = False

    @property
    def states(self) -> list[State]:
        """What `state` lists."""
        states = {
            State.RUNNING: self.is_running,
            State.RAMPING: self.is_ramping or self.is_lowering,
            State.HOLDING: self.is_holding,
            State.OVERLOADED: self.is_overloaded,
            State.STALLED: self.is_stalled,
        }
        return [state for state, applies in states.items() if applies]

    # Time

    def run_until(self, time_ns: int) -> None:
        """Run all steps and timers that are due."""
        while self._step_ns <= time_ns:
            if self._due_ns <= self._step_ns:
                self._fire()
            else:
                self.control(self._step_ns)
                self._step_ns += STEP_NS
        while self._due_ns <= time_ns:
            self._fire()

    def _fire(self) -> None:
        """Do what a timer is for."""
        time_ns = self._due_ns
        if self._timed_ns == time_ns:
            self._set_timers(ramp_ns=self._ramp_ns)
            self._end_timed(time_ns)
        else:
            self._set_timers(timed_ns=self._timed_ns)
            self._continue_ramp(time_ns)

    def _set_timers(self, ramp_ns: int = NEVER_NS, timed_ns: int = NEVER_NS) -> None:
        self._ramp_ns, self._timed_ns = ramp_ns, timed_ns
        self._due_ns = min(ramp_ns, timed_ns)

    # Commands

    def set_points(self, time_ns: int, setpoints: SetPoints) -> None:
        """Take set points for the next command; the duty of `run-direct` applies at once."""
        self.run_until(time_ns)
        self.setpoints = setpoints
        if self._last_command is Command.RUN_DIRECT and setpoints.duty != self._active.duty:
            self._active = replace(self._active, duty=setpoints.duty)
            self.run_direct(time_ns, setpoints.duty)

    def set_position(self, time_ns: int, position: int) -> None:
        """Make the present position another one."""
        self.run_until(time_ns)
        self.renumber(position)

    def command(self, time_ns: int, command: Command) -> None:
        """Carry out a command, after all steps and timers that are due."""
        self.run_until(time_ns)
        self._set_timers()
        last, self._last_command = self._last_command, command
        active = self._active = self.setpoints
        self.ramp_down_ms = active.ramp_down_ms
        match command:
            case Command.RUN_FOREVER | Command.RUN_TIMED:
                self._run_on(time_ns, active.speed_dps)
                if command is Command.RUN_TIMED:
                    jiffies = round_up(active.time_ms)
                    end_ns = self._jiffies.find_expiry_ns(time_ns, jiffies)
                    self._set_timers(self._ramp_ns, end_ns)
            case Command.RUN_TO_ABS_POS:
                self.target = active.position
                self._run_to_target(time_ns)
            case Command.RUN_TO_REL_POS:
                base = self.target if last is command else self.position
                self.target = base + active.position
                if active.position:
                    self._run_to_target(time_ns)
                else:
                    self._stop(time_ns)
            case Command.RUN_DIRECT:
                self.run_direct(time_ns, active.duty)
            case Command.STOP:
                self._stop(time_ns)
            case Command.RESET:
                self._reset(time_ns)

    def _run_on(self, time_ns: int, speed_dps: int) -> None:
        self._ends_at_target = self._stops_after_ramp = False
        if self._active.ramped:
            self._begin_ramp(time_ns, speed_dps)
        else:
            self._run(speed_dps)

    def _run_to_target(self, time_ns: int) -> None:
        self._ends_at_target, self._stops_after_ramp = True, False
        if self._active.ramp_up_ms:
            speed_dps = abs(self._active.speed_dps)
            self._begin_ramp(time_ns, -speed_dps if self.position > self.target else speed_dps)
        else:
            self._run(self._active.speed_dps)

    def _run(self, speed_dps: int) -> None:
        if self._ends_at_target:
            self.run_to(self.target, speed_dps, self._active.stop_action)
        else:
            self.run_regulated(speed_dps)

    def _stop(self, time_ns: int) -> None:
        if self._active.ramped:
            self._ramp_down(time_ns)
        else:
            self.halt(time_ns, self._active.stop_action)

    def _end_timed(self, time_ns: int) -> None:
        self._set_timers()
        if self._active.ramp_down_ms:
            self._ramp_down(time_ns)
        else:
            self.halt(time_ns, self._active.stop_action)

    def _ramp_down(self, time_ns: int) -> None:
        self._ends_at_target, self._stops_after_ramp = False, True
        self._begin_ramp(time_ns, 0)

    def _reset(self, time_ns: int) -> None:
        self.setpoints = self._active = SetPoints()
        self.halt(time_ns, StopAction.COAST)
        self.speed_control.reset()
        self.hold_control.reset()
        self.renumber(0)

    def arrive(self, time_ns: int, action: StopAction) -> None:
        """End a move to a position, and all ramps and timers with it."""
        super().arrive(time_ns, action)
        self._set_timers()
        self.is_ramping = False

    # Ramps

    def _begin_ramp(self, time_ns: int, goal_dps: int) -> None:
        """Begin to change the speed setpoint: first to 0 if it changes its sign."""
        start_dps = self._ramp_setpoint if self.is_ramping else self.speed_dps
        self._ramp_goal_dps = goal_dps
        end_dps = 0 if start_dps * goal_dps < 0 else goal_dps
        leads_away = abs(end_dps) > abs(start_dps)
        ramp_ms = self._active.ramp_up_ms if leads_away else self._active.ramp_down_ms
        change_dps = abs(end_dps - start_dps)
        jiffies = round_up(ramp_ms) * change_dps // self.model.max_speed_dps
        start_jiffy = self._jiffies.count(time_ns) - RAMP_LEAD_JIFFIES
        self._ramp = Ramp(start_jiffy, jiffies, start_dps, end_dps)
        self._ramp_jiffy, self.is_ramping = start_jiffy, True
        if jiffies:
            self._change_ramp(time_ns)
        else:
            self._ramp_setpoint = end_dps
            self._run(end_dps)
            self._continue_ramp(time_ns)

    def _change_ramp(self, time_ns: int) -> None:
        jiffy = self._jiffies.count(time_ns)
        wait = max(RAMP_JIFFIES - (jiffy - self._ramp_jiffy), 0)
        self._ramp_jiffy = jiffy
        setpoint = self._ramp_setpoint = self._ramp.compute_setpoint(jiffy)
        self._run(setpoint)
        self._set_timers(self._jiffies.find_expiry_ns(time_ns, wait), self._timed_ns)

    def _continue_ramp(self, time_ns: int) -> None:
        """Change the setpoint again, or end the ramp if the last change was its last."""
        if self._ramp_setpoint != self._ramp.end_dps:
            self._change_ramp(time_ns)
        elif self._ramp_setpoint != self._ramp_goal_dps:
            self._begin_ramp(time_ns, self._ramp_goal_dps)
        else:
            self.is_ramping = False
            if self._stops_after_ramp:
                self.halt(time_ns, self._active.stop_action)
