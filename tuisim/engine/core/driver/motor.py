"""A motor as programs see it: attributes, commands, ramps, timed moves and states of the kernel's `tacho-motor` class.

A command uses the set points of its time: a set point that a program writes later takes effect at the next command.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.engine.core.driver.control import divide
from tuisim.engine.core.driver.jiffies import JIFFY_US, LOOK_JIFFIES, NS_PER_US, Jiffies, round_up
from tuisim.engine.core.driver.plant import STEP_NS, PlantSpec
from tuisim.engine.core.driver.regulator import COAST, Model, MotorDriver, StopAction
from tuisim.engine.core.motor_columns import (
    HOLDING,
    OVERLOADED,
    RAMPING,
    RUNNING,
    STALLED,
    STATE_BITS,
)

NEVER_NS = 1 << 62
RAMP_JIFFIES = 10
"""Number of jiffies for which a ramp waits between two changes of the setpoint, approximately."""
LOOK_NS = LOOK_JIFFIES * JIFFY_US * NS_PER_US
"""Interval in ns at which the driver checks whether the motor's state has changed."""
RAMP_LEAD_JIFFIES = 5
"""A ramp is computed as if it had begun this number of jiffies before its command."""


class Command(StrEnum):
    """The commands that a program can write to the attribute `command` of a motor."""

    RUN_FOREVER = "run-forever"
    RUN_TO_ABS_POS = "run-to-abs-pos"
    RUN_TO_REL_POS = "run-to-rel-pos"
    RUN_TIMED = "run-timed"
    RUN_DIRECT = "run-direct"
    STOP = "stop"
    RESET = "reset"


RUN_FOREVER, RUN_TO_ABS_POS, RUN_TO_REL_POS, RUN_TIMED, RUN_DIRECT, STOP, RESET = Command
"""Members as plain names: to look one up in its class takes longer than a call."""


STATES = tuple(
    " ".join(
        state
        for state in ("running", "ramping", "holding", "overloaded", "stalled")
        if STATE_BITS[state] & bits
    )
    for bits in range(2 * max(STATE_BITS.values()))
)
"""The text of the attribute `state`, by the bits that are recorded."""


class SetPoints(NamedTuple):
    """The values of a motor's attributes at the time of a command, with the sign of the motor's own direction."""

    speed_dps: int = 0
    position: int = 0
    duty: int = 0
    time_ms: int = 0
    ramp_up_ms: int = 0
    ramp_down_ms: int = 0
    stop_action: StopAction = COAST

    @property
    def ramped(self) -> bool:
        """Whether the speed changes gradually, by ramps."""
        return bool(self.ramp_up_ms or self.ramp_down_ms)


@dataclass(frozen=True, slots=True)
class Ramp:
    """A gradual change of the speed that the motor has to keep, its speed setpoint."""

    start_jiffy: int
    jiffies: int
    """How long the ramp takes, in jiffies."""
    start_dps: int
    end_dps: int

    def compute_setpoint(self, jiffy: int) -> int:
        """Return the speed setpoint at a jiffy, in degrees per second."""
        left = self.start_jiffy + self.jiffies - jiffy
        if left <= 0:
            return self.end_dps
        return self.end_dps - divide((self.end_dps - self.start_dps) * left, self.jiffies)


class DriverMotor(MotorDriver):
    """A motor with its driver and the kernel's `tacho-motor` class, whose attributes programs use.

    Args:
        model: The kind of motor.
        plant: The motor with its load.
        battery_v: The voltage of the battery without load.
        jiffies: The kernel's clock.
    """

    __slots__ = (
        "_due_ns",
        "_ends_at_target",
        "_jiffies",
        "_last_command",
        "_looked_bits",
        "_ramp",
        "_ramp_goal_dps",
        "_ramp_jiffy",
        "_ramp_ns",
        "_ramp_setpoint",
        "_step_ns",
        "_stops_after_ramp",
        "_timed_ns",
        "_timers_ns",
        "active",
        "is_at_rest",
        "is_ramping",
        "next_look_ns",
        "noticed_ns",
    )

    def __init__(self, model: Model, plant: PlantSpec, battery_v: float, jiffies: Jiffies) -> None:
        super().__init__(model, plant, battery_v)
        self.start_clock(jiffies)
        self.active = SetPoints()
        """The set points of the last command."""
        self._last_command: Command | None = None
        self._step_ns = STEP_NS
        self._ramp_ns = self._timed_ns = self._timers_ns = NEVER_NS
        """When a ramp's next change and the end of a timed move are due, in ns, and the earlier of these times."""
        self._ramp = Ramp(0, 0, 0, 0)
        self._ramp_goal_dps = self._ramp_jiffy = self._ramp_setpoint = 0
        self.is_ramping = self._stops_after_ramp = self._ends_at_target = False
        self._looked_bits = 0
        self.noticed_ns = -1
        """When a change of the state was last noticed, in ns: a program that waits for the change then continues."""
        self.is_at_rest = True
        """Whether the passing of time changes nothing: the motor is new, or `settle` has found this."""

    def start_clock(self, jiffies: Jiffies) -> None:
        """Set the kernel's clock, before any time has passed."""
        self._jiffies = jiffies
        self.next_look_ns = jiffies.begin_ns(jiffies.first + jiffies.first_look)
        """When the driver next checks whether the motor's state has changed, in ns."""
        self._due_ns = self.next_look_ns
        """When a timer or the driver's next check is due, in ns."""

    @property
    def state_bits(self) -> int:
        """The present states of the motor as the bits of `STATE_BITS`."""
        bits = 0
        if self.is_running:
            bits = STALLED | RUNNING if self.is_stalled else RUNNING
        if self.is_ramping or self.is_lowering:
            bits |= RAMPING
        control = self._control
        if control is not None:
            if control is self.hold_control:
                bits |= HOLDING
            if control.overloaded:
                bits |= OVERLOADED
        return bits

    @property
    def ends_alone(self) -> bool:
        """Whether the motor runs, and will stop by itself: at a time, at a position, or at the end of a ramp."""
        return self.is_running and (
            self._timed_ns < NEVER_NS
            or self._arrival_action is not None
            or (self._stops_after_ramp and self._ramp_ns < NEVER_NS)
        )

    # Time

    def find_last_look_ns(self, time_ns: int) -> int:
        """Return the time in ns of the driver's last check of the motor's state that is not after `time_ns`.

        If no check remains before `time_ns`, return the time of the next one.
        """
        return self.next_look_ns + max(0, time_ns - self.next_look_ns) // LOOK_NS * LOOK_NS

    def run_until(self, time_ns: int) -> None:
        """Run all steps of the control and all timers that are due until `time_ns`."""
        if self.is_at_rest:
            self._skip(time_ns)
            return
        if self._roll is not None and self._follow_roll(time_ns):
            return
        while (step_ns := self._step_ns) <= time_ns:
            if self._due_ns <= step_ns:
                self._fire()
                continue
            if self._is_regulated and self._can_regulate(step_ns):
                end_ns = min(self._due_ns, time_ns + 1)
                if self._arrival_action is not None:
                    end_ns = min(end_ns, self._find_arrival_ns(step_ns))
                self._step_ns = self._run_speed_control(step_ns, end_ns)
                if self._step_ns != step_ns:
                    continue
            elif self._control is None and self._try_to_roll():
                if self._follow_roll(time_ns):
                    return
                continue
            if not self.is_running and self._is_still():
                step_ns = time_ns // STEP_NS * STEP_NS
            self.control(step_ns)
            self._step_ns = step_ns + STEP_NS
            if self.is_stalled and self.settle():
                self._skip(time_ns)
                return
        while self._due_ns <= time_ns:
            self._fire()

    def _try_to_roll(self) -> bool:
        """Begin a `Roll`, which needs no single steps, if the motor turns freely; return whether it rolls.

        A motor with a timer, such as that of a timed move, does not roll.
        """
        return self._timers_ns == NEVER_NS and super()._try_to_roll()

    def _follow_roll(self, time_ns: int) -> bool:
        """Advance the present `Roll` to a time, and run the timers that are due.

        Return whether the motor still rolls then.
        """
        rolls_on = self._advance_roll(time_ns)
        self._step_ns = (self._moved_ns // STEP_NS + 1) * STEP_NS
        while rolls_on and self._due_ns <= time_ns:
            self._fire()
        return rolls_on

    def _is_still(self) -> bool:
        """Return whether only the measured speed can still change: the axle is at rest, and no timer is set."""
        return (
            self._timers_ns == NEVER_NS
            and self.axle.stands
            and self._is_count_known()
            and self._is_control_at_rest()
        )

    def settle(self) -> bool:
        """Set `is_at_rest` to whether the passing of time no longer changes the motor, and return it."""
        self.is_at_rest = (
            self.is_stalled == self.is_running
            and not (self.speed_dps or self._timers_ns < NEVER_NS)
            and self._is_control_at_rest()
            and self.state_bits == self._looked_bits
            and (self.axle.stands or self.axle.is_blocked)
        )
        return self.is_at_rest

    def _skip(self, time_ns: int) -> None:
        """Set the time of a motor at rest to `time_ns`, without the steps and checks before it: they change nothing."""
        if self._step_ns <= time_ns:
            self._step_ns = (time_ns // STEP_NS + 1) * STEP_NS
            self._moved_ns = time_ns
        self._skip_looks(time_ns)

    def _skip_looks(self, time_ns: int) -> None:
        """Skip the driver's checks up to a time: the motor's state cannot change until then."""
        if self.next_look_ns <= time_ns:
            passed = (time_ns - self.next_look_ns) // LOOK_NS + 1
            self.next_look_ns += passed * LOOK_NS
            self._due_ns = min(self._timers_ns, self.next_look_ns)

    def _fire(self) -> None:
        """Run the timer that is due: the end of a timed move, a change of a ramp, or a check of the state."""
        time_ns = self._due_ns
        if self._timed_ns == time_ns:
            self._set_timers(ramp_ns=self._ramp_ns)
            self._end_timed(time_ns)
        elif self._ramp_ns == time_ns:
            self._set_timers(timed_ns=self._timed_ns)
            self._continue_ramp(time_ns)
        else:
            self.next_look_ns += LOOK_NS
            self._due_ns = min(self._timers_ns, self.next_look_ns)
            bits = self.state_bits
            if bits != self._looked_bits:
                self._looked_bits = bits
                self.noticed_ns = time_ns

    def _set_timers(self, ramp_ns: int = NEVER_NS, timed_ns: int = NEVER_NS) -> None:
        self._ramp_ns, self._timed_ns = ramp_ns, timed_ns
        self._timers_ns = min(ramp_ns, timed_ns)
        self._due_ns = min(self._timers_ns, self.next_look_ns)

    # Commands

    def wake(self, time_ns: int) -> None:
        """Run the motor until `time_ns`, and make it run in single steps from then on.

        It is called when a command or an obstacle changes the motor.
        """
        if self._step_ns <= time_ns or self._due_ns <= time_ns:
            self.run_until(time_ns)
        if self._roll is not None:
            self.leave_roll()
        self.is_at_rest = False

    def set_duty(self, time_ns: int, duty: int) -> None:
        """Set the power of the motor in percent, called duty; ignored unless the last command was `run-direct`."""
        if self._last_command is RUN_DIRECT:
            self.wake(time_ns)
            self.run_direct(time_ns, duty)

    def obey(self, time_ns: int, command: Command, active: SetPoints) -> None:
        """Run all steps and timers due until `time_ns`, then execute a command with the set points `active`."""
        if command is RUN_FOREVER and self._keeps_running(active):
            if active != self.active:
                self.wake(time_ns)
                self.active = active
                self.run_regulated(active.speed_dps)
            return
        self.wake(time_ns)
        if self._timers_ns < NEVER_NS:
            self._set_timers()
        last = self._last_command
        self._last_command = command
        self.active = active
        self.ramp_down_ms = active.ramp_down_ms
        if command is RUN_FOREVER or command is RUN_TIMED:
            self._take_up_speed(time_ns, active.speed_dps)
            if command is RUN_TIMED:
                end_ns = self._jiffies.find_expiry_ns(time_ns, round_up(active.time_ms))
                self._set_timers(self._ramp_ns, end_ns)
        elif command is RUN_TO_ABS_POS:
            self.target = active.position
            self._run_to_target(time_ns)
        elif command is RUN_TO_REL_POS:
            self.target = (self.target if last is command else self.position) + active.position
            if active.position:
                self._run_to_target(time_ns)
            else:
                self._stop(time_ns)
        elif command is RUN_DIRECT:
            self.run_direct(time_ns, active.duty)
        elif command is STOP:
            self._stop(time_ns)
        else:
            self._reset(time_ns)

    def _keeps_running(self, active: SetPoints) -> bool:
        """Return whether the command `run-forever` only changes the speed of a motor.

        It does if the motor already runs by `run-forever`, and neither command has ramps.
        """
        before = self.active
        return (
            self._last_command is RUN_FOREVER
            and self.is_running
            and not self.is_ramping
            and not (active.ramp_up_ms or active.ramp_down_ms)
            and not (before.ramp_up_ms or before.ramp_down_ms)
        )

    def _take_up_speed(self, time_ns: int, speed_dps: int) -> None:
        self._ends_at_target = self._stops_after_ramp = False
        if self.active.ramped:
            self._begin_ramp(time_ns, speed_dps)
        else:
            self._run(speed_dps)

    def _run_to_target(self, time_ns: int) -> None:
        self._ends_at_target = True
        self._stops_after_ramp = False
        if self.active.ramp_up_ms:
            speed_dps = abs(self.active.speed_dps)
            self._begin_ramp(time_ns, -speed_dps if self.position > self.target else speed_dps)
        else:
            self._run(self.active.speed_dps)

    def _run(self, speed_dps: int) -> None:
        if self._ends_at_target:
            self.run_to(self.target, speed_dps, self.active.stop_action)
        else:
            self.run_regulated(speed_dps)

    def _stop(self, time_ns: int) -> None:
        if self.active.ramped:
            self._ramp_down(time_ns)
        else:
            self.halt(time_ns, self.active.stop_action)

    def _end_timed(self, time_ns: int) -> None:
        self._set_timers()
        if self.active.ramp_down_ms:
            self._ramp_down(time_ns)
        else:
            self.halt(time_ns, self.active.stop_action)

    def _ramp_down(self, time_ns: int) -> None:
        self._ends_at_target = False
        self._stops_after_ramp = True
        self._begin_ramp(time_ns, 0)

    def _reset(self, time_ns: int) -> None:
        self.active = SetPoints()
        self.halt(time_ns, COAST)
        self.speed_control.reset()
        self.hold_control.reset()
        self.set_position(0)

    def end_move(self, time_ns: int, action: StopAction) -> None:
        """End a move to a position with a stop action, and cancel all ramps and timers."""
        super().end_move(time_ns, action)
        self._set_timers()
        self.is_ramping = False

    # Ramps

    def _begin_ramp(self, time_ns: int, goal_dps: int) -> None:
        """Begin to change the speed setpoint to a goal. If the sign changes, the first ramp leads to 0."""
        start_dps = self._ramp_setpoint if self.is_ramping else self.speed_dps
        self._ramp_goal_dps = goal_dps
        end_dps = 0 if start_dps * goal_dps < 0 else goal_dps
        leads_away = abs(end_dps) > abs(start_dps)
        ramp_ms = self.active.ramp_up_ms if leads_away else self.active.ramp_down_ms
        change_dps = abs(end_dps - start_dps)
        jiffies = round_up(ramp_ms) * change_dps // self.model.max_speed_dps
        start_jiffy = self._jiffies.count(time_ns) - RAMP_LEAD_JIFFIES
        self._ramp = Ramp(start_jiffy, jiffies, start_dps, end_dps)
        self._ramp_jiffy = start_jiffy
        self.is_ramping = True
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
        """Set the next speed setpoint of the ramp; end the ramp if it has reached its goal."""
        if self._ramp_setpoint != self._ramp.end_dps:
            self._change_ramp(time_ns)
        elif self._ramp_setpoint != self._ramp_goal_dps:
            self._begin_ramp(time_ns, self._ramp_goal_dps)
        else:
            self.is_ramping = False
            if self._stops_after_ramp:
                self.halt(time_ns, self.active.stop_action)
