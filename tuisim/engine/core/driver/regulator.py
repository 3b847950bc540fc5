"""The driver of one motor: every 2 ms it reads the counter and sets a duty, by one of two controllers or none."""

from __future__ import annotations

from enum import StrEnum
from math import copysign

from tuisim.base.data_class import dataclass
from tuisim.engine.core.driver.control import (
    MAX_DUTY,
    SPEED_CONSTANTS,
    Controller,
    divide,
)
from tuisim.engine.core.driver.counter import TICKS_PER_NS, Counter
from tuisim.engine.core.driver.plant import LARGE, MEDIUM, STEP_NS, STEP_S, Axle, PlantSpec
from tuisim.engine.core.driver.roll import Roll, begin_roll

STEP_TICKS = STEP_NS * TICKS_PER_NS
STALL_NS = 100_000_000
"""A running motor whose speed reads 0 for longer than this is stalled."""
COUNTED_DEG = 2
"""The position that the driver reads differs from the axle's true angle by less than this."""


class StopAction(StrEnum):
    """The action with which a motor stops at the end of a command."""

    COAST = "coast"
    BRAKE = "brake"
    HOLD = "hold"


COAST, BRAKE, HOLD = StopAction
"""Members as plain names: to look one up in its class takes longer than a call."""


@dataclass(frozen=True, slots=True)
class Model:
    """Constants of a kind of motor, as its driver uses them."""

    plant: PlantSpec
    max_speed_dps: int
    hold_kp: int


MODELS = {"large": Model(LARGE, 1050, 80_000), "medium": Model(MEDIUM, 1560, 160_000)}


class MotorDriver:
    """A motor with its driver, the part of the brick's kernel that controls it.

    At first the axle is at rest, and no controller is active.

    Args:
        model: The kind of motor.
        plant: The motor with its load.
        battery_v: The voltage of the battery without load.
    """

    __slots__ = (
        "_arrival_action",
        "_control",
        "_is_regulated",
        "_moved_ns",
        "_offset",
        "_raw",
        "_roll",
        "_still_ns",
        "axle",
        "counter",
        "duty",
        "hold_control",
        "is_lowering",
        "is_running",
        "is_stalled",
        "model",
        "position",
        "ramp_down_ms",
        "speed_control",
        "speed_dps",
        "target",
    )

    def __init__(self, model: Model, plant: PlantSpec, battery_v: float) -> None:
        self.model = model
        self.axle, self.counter = Axle(plant, battery_v), Counter()
        self.speed_control = Controller(SPEED_CONSTANTS)
        self.hold_control = Controller((model.hold_kp, 0, 0))
        self._control: Controller | None = None
        """The active controller."""
        self._moved_ns = 0
        """Time in ns up to which the axle's motion has been computed."""
        self._raw = self._offset = 0
        self.position = self.speed_dps = 0
        """Position in degrees and speed in degrees per second, as the last step of the control read them."""
        self.duty = 0
        """The duty that was set last, in percent; the bridge may still have an earlier one."""
        self.target = 0
        """The position in degrees at which the last move to a position ends."""
        self._arrival_action: StopAction | None = None
        """The action with which the motor stops at `target`; None if no move to a position is active."""
        self._is_regulated = False
        """Whether only the speed control is active, and perhaps a target at which the move ends."""
        self._roll: Roll | None = None
        """The motion of an axle that rolls without any control; None if the axle does not roll so."""
        self.ramp_down_ms = 0
        self.is_running = self.is_lowering = self.is_stalled = False
        self._still_ns: int | None = None
        """Time in ns since which the speed of the running motor reads 0; None if its speed does not read 0."""

    @property
    def lowering_s(self) -> float:
        """How many seconds before its target the motor begins to slow down."""
        return abs(self.speed_dps) * self.ramp_down_ms / self.model.max_speed_dps / 2000

    # Commands

    def run_regulated(self, speed_dps: int) -> None:
        """Run the motor at a speed that the speed control keeps, from the next step of the control on."""
        self.speed_control.setpoint = speed_dps
        self._start(self.speed_control)

    def run_direct(self, time_ns: int, duty: int) -> None:
        """Run the motor with a constant duty in percent, without any controller."""
        self._start(None)
        self._set_duty(time_ns, duty)

    def run_to(self, target: int, speed_dps: int, action: StopAction) -> None:
        """Run the motor to the position `target`, in degrees, where it stops with the stop action `action`.

        The sign of the speed is ignored.
        """
        self.speed_control.setpoint = -abs(speed_dps) if self.position > target else abs(speed_dps)
        self._start(self.speed_control)
        self.target = target
        self._arrival_action = action
        if self.ramp_down_ms:
            self._is_regulated = False

    def _start(self, control: Controller | None) -> None:
        self._control = control
        self._arrival_action = None
        self.is_running = True
        self._is_regulated = control is not None and control.setpoint != 0

    def halt(self, time_ns: int, action: StopAction, held: int | None = None) -> None:
        """Stop the motor with a stop action.

        Args:
            time_ns: The present time.
            action: The stop action.
            held: The position in degrees that the action `hold` holds; None for the present one.
        """
        self.speed_control.clear()
        self.hold_control.clear()
        self._control = self._arrival_action = self._still_ns = None
        self._is_regulated = self.is_running = self.is_lowering = self.is_stalled = False
        self.duty = 0
        if action is HOLD:
            self._control = self.hold_control
            self.hold_control.setpoint = self.position if held is None else held
        else:
            self.move_axle(time_ns)
            self.axle.power(None if action is COAST else 0)

    def set_position(self, position: int) -> None:
        """Set the value that the motor reports for its present position, in degrees; it also becomes the target."""
        self._offset = position - self._raw
        self.position = self.target = self.hold_control.setpoint = position

    # Time

    def move_axle(self, time_ns: int) -> None:
        """Turn the motor's axle until a time in ns, and record the counts of its encoder."""
        axle = self.axle
        left_ns = float(time_ns - self._moved_ns)
        self._moved_ns = time_ns
        while left_ns:
            begin_ns, begin_deg, begin_dps = left_ns, axle.angle_deg, axle.speed_dps
            left_ns = axle.advance(begin_ns)
            if axle.angle_deg != begin_deg:
                both_dps = begin_dps + axle.speed_dps
                self.counter.record(
                    (time_ns - begin_ns) * TICKS_PER_NS,
                    (begin_ns - left_ns) * TICKS_PER_NS,
                    begin_deg,
                    axle.angle_deg,
                    0.25 + 0.5 * begin_dps / both_dps if both_dps else 0.5,
                )
            else:
                self.counter.record_rest(time_ns * TICKS_PER_NS)

    def read_counts(self, count: int) -> None:
        """Set the motor's position, in degrees, from the count of its encoder, in half degrees."""
        self._raw = raw = count // 2 if count >= 0 else -(-count // 2)
        self.position = raw + self._offset

    def control(self, time_ns: int) -> None:
        """Run one step of the control: read the counter, and set the duty."""
        axle = self.axle
        counter = self.counter
        begin_deg, begin_dps = axle.angle_deg, axle.speed_dps
        if time_ns - self._moved_ns == STEP_NS and axle.turn_step():
            # The usual case of `move_axle`, with fewer calls: this runs every 2 ms.
            self._moved_ns = time_ns
            middle = 0.25 + 0.5 * begin_dps / (begin_dps + axle.speed_dps)
            begin = (time_ns - STEP_NS) * TICKS_PER_NS
            counter.record(begin, STEP_TICKS, begin_deg, axle.angle_deg, middle)
        else:
            self.move_axle(time_ns)
        count = counter.count
        self._raw = raw = count // 2 if count >= 0 else -(-count // 2)
        self.position = raw + self._offset
        self.speed_dps = speed_dps = counter.measure_speed_dps()
        if self.is_running and (speed_dps == 0 or self._still_ns is not None):
            self._watch_stall(time_ns)
        control = self._control
        if control is None:
            return
        if control is self.hold_control:
            duty = control.compute_duty(self.position)
        elif control.setpoint:
            duty = control.compute_duty(speed_dps)
        else:
            control.clear()
            duty = 0
        if duty != self.duty:
            self.duty = duty
            axle.power(duty)
        if self._arrival_action is not None:
            self._slow_down(time_ns, self._arrival_action)

    def _try_to_roll(self) -> bool:
        """Begin a `Roll`, which needs no single steps, if the motor turns freely; return whether it rolls."""
        if self.is_running and not self.speed_dps:
            return False
        self._roll = begin_roll(self.axle, self.counter, self._moved_ns)
        return self._roll is not None

    def _advance_roll(self, time_ns: int) -> bool:
        """Advance the present `Roll` to the last step that is due up to a time; return whether it goes on after that.

        A roll that has ended is removed. Return False if there is no roll.
        """
        roll = self._roll
        if roll is None:
            return False
        step_ns = min(time_ns // STEP_NS * STEP_NS, roll.end_ns)
        if step_ns > roll.time_ns:
            self._moved_ns = step_ns
            roll.turn_to(step_ns)
            self.read_counts(roll.count)
            self.speed_dps = roll.measure_speed_dps()
        if time_ns < roll.end_ns + STEP_NS:
            return True
        self.leave_roll()
        return False

    def leave_roll(self) -> None:
        """End the present `Roll`, and go on in single steps from the axle's present angle."""
        if self._roll is not None:
            self._roll.tell_counter()
            self._roll = None

    def _can_regulate(self, step_ns: int) -> bool:
        """Return whether the next step of the control, at the time `step_ns`, needs only the speed control.

        That is so while the motor turns freely, and is not about to be reported as stalled.
        """
        return (
            self.speed_dps != 0
            and self._still_ns is None
            and self._moved_ns == step_ns - STEP_NS
            and self.axle.turns_freely
        )

    def _find_arrival_ns(self, step_ns: int) -> int:
        """Return a time, in ns, before which the motor cannot reach its target.

        `step_ns` is the time of the next step.
        """
        way = self.target - self.position
        way_deg = (way if self.speed_control.setpoint > 0 else -way) - COUNTED_DEG
        top_dps = max(abs(self.axle.speed_dps), MAX_DUTY * self.axle.circuit.dps_per_percent)
        return step_ns + int(way_deg / (top_dps * STEP_S)) * STEP_NS

    def _run_speed_control(self, step_ns: int, end_ns: int) -> int:
        """Run steps of the speed control alone, in few calls, as long as the motor turns on.

        Args:
            step_ns: When the first step is due.
            end_ns: Steps that are due from this time on are not run.

        Returns:
            When the next step is due, in ns. It is before `end_ns` if that step needs more than the speed control.
        """
        axle = self.axle
        counter = self.counter
        control = self.speed_control
        angle_deg = axle.angle_deg
        speed_dps = axle.speed_dps
        read_dps = self.speed_dps
        circuit = axle.circuit
        duty = self.duty
        goal_dps = axle.goal_dps
        friction_dps = copysign(circuit.friction_dps, speed_dps)
        decay = circuit.step_decay
        constant_s = circuit.time_constant_s
        end_dps = goal_dps - friction_dps
        begin = self._moved_ns * TICKS_PER_NS
        while step_ns < end_ns and read_dps:
            after_dps = end_dps + (speed_dps - end_dps) * decay
            if after_dps * speed_dps <= 0.0:
                break
            begin_deg = angle_deg
            angle_deg += end_dps * STEP_S + (speed_dps - after_dps) * constant_s
            middle = 0.25 + 0.5 * speed_dps / (speed_dps + after_dps)
            counter.record(begin, STEP_TICKS, begin_deg, angle_deg, middle)
            read_dps = counter.measure_speed_dps()
            speed_dps = after_dps
            next_duty = control.compute_duty(read_dps)
            if next_duty != duty:
                duty = next_duty
                goal_dps = next_duty * circuit.dps_per_percent
                end_dps = goal_dps - friction_dps
            # Both terms are whole numbers, so the sum is exact: the same as `step_ns * TICKS_PER_NS`.
            begin += STEP_TICKS
            step_ns += STEP_NS
        axle.angle_deg = angle_deg
        axle.speed_dps = speed_dps
        axle.goal_dps = goal_dps
        self.duty = duty
        self.speed_dps = read_dps
        self._moved_ns = step_ns - STEP_NS
        self.read_counts(counter.count)
        if not read_dps:
            self._still_ns = self._moved_ns
        return step_ns

    def _is_count_known(self) -> bool:
        """Whether the motor's position is up to date: the counter has not changed since the last step."""
        return self._raw == divide(self.counter.count, 2)

    def _is_control_at_rest(self) -> bool:
        """Whether the control of a motor at rest sets the same duty in every step."""
        control = self._control
        value = self.speed_dps if control is self.speed_control else self.position
        return control is None or control.is_steady(value, self.duty)

    def _set_duty(self, time_ns: int, duty: int) -> None:
        if duty != self.duty:
            self.duty = duty
            self.move_axle(time_ns)
            self.axle.power(duty)

    def _watch_stall(self, time_ns: int) -> None:
        if self.speed_dps:
            self._still_ns = None
            self.is_stalled = False
        elif self._still_ns is None:
            self._still_ns = time_ns
        elif time_ns - self._still_ns > STALL_NS:
            self.is_stalled = True

    def _slow_down(self, time_ns: int, action: StopAction) -> None:
        """Lower the speed setpoint before the target, and stop the motor with the stop action `action` there."""
        target = self.target
        position = self.position
        speed_dps = self.speed_dps
        setpoint = self.speed_control.setpoint
        ramp = divide(abs(speed_dps) * self.ramp_down_ms, 1 + self.model.max_speed_dps)
        end = position + divide(speed_dps * ramp, 2000)
        if (end > target and setpoint > 0) or (end < target and setpoint < 0):
            self.speed_control.setpoint = divide(2000 * (target - position), 1 + ramp)
            self.is_lowering = True
        # With a setpoint of 0 the move ends only if the motor is at the target already.
        if (position >= target or setpoint < 0) and (position <= target or setpoint > 0):
            self.end_move(time_ns, action)

    def end_move(self, time_ns: int, action: StopAction) -> None:
        """End a move to a position with a stop action; the action `hold` holds the target of the move."""
        self.halt(time_ns, action, held=self.target)
