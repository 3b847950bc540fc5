"""A motor with the kernel's driver in the simulation: it runs in ticks, meets obstacles, and carries a load."""

from __future__ import annotations

from itertools import accumulate, repeat
from math import copysign, floor, inf
from typing import TYPE_CHECKING

from tuisim.engine.core.drive import EvenGlide, Glide
from tuisim.engine.core.driver.counter import TICKS_PER_NS
from tuisim.engine.core.driver.jiffies import Jiffies
from tuisim.engine.core.driver.motor import NEVER_NS, DriverMotor
from tuisim.engine.core.driver.plant import NS_PER_S, STEP_NS, Axle, PlantSpec
from tuisim.engine.core.driver.regulator import MODELS
from tuisim.engine.core.motor_columns import MOTOR_RECORD
from tuisim.engine.core.motors import (
    ENDLESS,
    FOREVER,
    POSITION,
    STANDSTILL_DEG,
    STOPPED,
    TIMED,
    MotorState,
)

if TYPE_CHECKING:
    from tuisim.engine.core.spec import RobotSpec, RunSpec
    from tuisim.engine.core.tick_record import Buffer

_pack_into = MOTOR_RECORD.pack_into

WHEEL_KG = 0.0194
"""Mass of a wheel, which is taken for a disc."""
ROLLING_SHARE = 0.046
"""Friction of a wheel and a castor at the axle, as a share of the weight on the wheel times its radius: an estimate."""
GRAVITY_M_S2 = 9.81
EVEN_TICKS = 12
"""A motor whose speed has been right for this many ticks then runs on evenly, without single steps of the control."""
MAX_ERROR_DPS = 2
MIN_CRUISE_DPS = 80
CUT_OFF_DPS = 0.5
"""A motor that runs evenly turns this much faster than its measured speed, which is rounded down."""
MARGIN_S = 0.03
"""The even motion of a motor ends this long before the motor arrives at a target or a stop."""
MAX_CRUISE_S = 1e9
PUSH_DEG = 0.05
"""Estimate of how far a motor that pushes at rest would turn, to find out whether an obstacle blocks it."""


def load_wheel(plant: PlantSpec, robot: RobotSpec) -> PlantSpec:
    """Return the constants of a motor that carries one wheel of a robot and its share of the robot's mass.

    Args:
        plant: The constants of the motor without this load.
        robot: The robot.
    """
    radius_m = robot.wheel_diameter_mm / 2000
    gears = robot.gear_ratio
    inertia_kg_m2 = (robot.mass_kg + WHEEL_KG) / 2 * radius_m**2
    friction_nm = ROLLING_SHARE * robot.mass_kg / 2 * GRAVITY_M_S2 * radius_m
    return plant.add_load(inertia_kg_m2 / gears**2, friction_nm / gears)


def choose_plant(spec: RunSpec, kind: str, *, free: bool) -> PlantSpec:
    """Return the constants of a motor with its load.

    Args:
        spec: The run.
        kind: One of `MOTOR_KINDS`.
        free: Whether the motor drives no wheel; otherwise it carries a wheel with its share of the robot.
    """
    plant = MODELS[kind].plant if kind in MODELS else _find_hub_plant(kind)
    return plant if free else load_wheel(plant, spec.robot)


def _find_hub_plant(kind: str) -> PlantSpec:
    from tuisim.engine.core.servo.hub_motors import PLANTS

    return PLANTS[kind]


def build_motor(spec: RunSpec, kind: str, *, free: bool) -> SimulatedMotor:
    """Return a motor with a driver, in its initial state.

    Args:
        spec: The run.
        kind: One of `MOTOR_KINDS`.
        free: Whether the motor drives no wheel; otherwise it carries a wheel with its share of the robot.
    """
    plant = choose_plant(spec, kind, free=free)
    return SimulatedMotor(spec.profile.tick_hz, kind, plant, spec.robot.battery_v)


def build_axle(spec: RunSpec, kind: str, *, free: bool) -> Axle:
    """Return the axle of a motor that is not controlled by the EV3 driver.

    Args:
        spec: The run.
        kind: One of `MOTOR_KINDS`.
        free: Whether the motor drives no wheel; otherwise it carries a wheel with its share of the robot.
    """
    return Axle(choose_plant(spec, kind, free=free), spec.robot.battery_v)


def change_load(axle: Axle, spec: RunSpec, kind: str, *, free: bool) -> None:
    """Change the load of an axle to that of a motor with or without a wheel.

    Args:
        axle: The axle.
        spec: The run.
        kind: The kind of motor, one of `MOTOR_KINDS`.
        free: Whether the motor drives no wheel now; otherwise it carries a wheel with its share of the robot.
    """
    axle.change_load(choose_plant(spec, kind, free=free), spec.robot.battery_v)


class SimulatedMotor(DriverMotor):
    """One motor of a robot with its EV3 driver, which is advanced tick by tick.

    Args:
        tick_hz: Ticks per second.
        kind: One of `MODELS`.
        plant: The motor with its load.
        battery_v: The voltage of the battery without load.
    """

    __slots__ = (
        "_angle_deg",
        "_cruise_dps",
        "_cruise_end_ns",
        "_even_ticks",
        "_hz",
        "_tick",
        "_tick_ns",
        "blocked_ticks",
        "counting_dps",
        "is_barred",
        "position_deg",
    )

    def __init__(self, tick_hz: int, kind: str, plant: PlantSpec, battery_v: float) -> None:
        super().__init__(MODELS[kind], plant, battery_v, Jiffies())
        self._hz = tick_hz
        self._tick_ns = NS_PER_S / tick_hz
        self._angle_deg = self.axle.angle_deg
        """The axle's angle at the end of the last tick, from the counter's zero."""
        self.position_deg = 0.0
        """Encoder position at the end of the last tick."""
        self.counting_dps = 0.0
        """Speed of the encoder at the end of the last tick; it does not change within a tick."""
        self.blocked_ticks = 0
        self.is_barred = False
        """Whether an obstacle in the world keeps the motor from turning any farther."""
        self._tick = 0
        """Number of the last tick that has been run."""
        self._even_ticks = 0
        """Number of successive ticks for which the motor's speed has been as the control wants it."""
        self._cruise_dps = 0.0
        """The speed at which the motor runs evenly, without single steps, in degrees per second; 0 if it does not."""
        self._cruise_end_ns = 0
        """The latest time at which the even motion ends, in ns."""

    # The state of the motor, for other modules

    @property
    def mode(self) -> int:
        """One of the modes in `engine.core.motors`; the motor runs in all of them but `STOPPED`."""
        if not self.is_running:
            return STOPPED
        if self._timed_ns < NEVER_NS:
            return TIMED
        return POSITION if self._arrival_action is not None else FOREVER

    @property
    def goal_deg(self) -> float:
        """Target of the motor's last move to a position, in degrees."""
        return float(self.target)

    @property
    def end_tick(self) -> float:
        """The tick at which a timed move ends, which need not be whole; `ENDLESS` without a timed move."""
        return ENDLESS if self._timed_ns == NEVER_NS else self._timed_ns / self._tick_ns

    @property
    def moving_dps(self) -> float:
        """Current speed of the wheel in degrees per second, negative if it turns backwards."""
        return self.axle.speed_dps

    @property
    def aim_dps(self) -> float:
        """The speed that the speed control has to reach, in degrees per second; negative backwards.

        While the speed control is not active, it is the speed that the motor would reach with its present power and
        without friction.
        """
        if self._control is self.speed_control:
            return float(self.speed_control.setpoint)
        return self.axle.goal_dps

    @property
    def resting(self) -> bool:
        """Whether the motor stays unchanged until its next command."""
        return self.is_at_rest

    @property
    def ramping_ticks(self) -> int:
        """Approximate number of ticks until the speed is steady; 0 only if it is steady."""
        return 0 if self.is_at_rest or self._cruise_dps else 1

    def read_turn(self, now_ns: int) -> tuple[float, float]:
        """Advance the driver to a time in ns, and return the position and the speed that it reports.

        The position is in degrees, the speed in degrees per second.
        """
        if not self.is_at_rest:
            self.run_until(now_ns)
        return self.position, self.speed_dps

    def set_position(self, position: int) -> None:
        """Set the value that the motor reports for its present position, in degrees; it also becomes the target."""
        before = self.position
        super().set_position(position)
        self.position_deg += position - before

    def record(self, buffer: Buffer, at: int) -> None:
        """Write the motor's `MOTOR_RECORD` to a buffer, at the offset `at`.

        Its `asked_dps` is 0 unless the speed control is active.
        """
        control = self.speed_control
        asked_dps = control.setpoint if self._control is control else 0
        _pack_into(buffer, at, asked_dps, self.speed_dps, self.duty, self.state_bits)

    # Ticks

    def _end_ns(self, tick: int) -> int:
        return -(-tick * NS_PER_S // self._hz)

    def step(self, tick: int, noise_dps: float) -> float:
        """Run the tick `tick` with noise added to the motor's speed; return the rotation of the wheel in degrees."""
        end_ns = self._end_ns(tick)
        if self._cruise_dps:
            if end_ns < self._cruise_end_ns and not noise_dps:
                turned_deg = self._cruise_dps / self._hz
                self._tick = tick
                self._angle_deg += turned_deg
                self.position_deg += turned_deg
                return turned_deg
            self._leave_cruise()
        self._tick = tick
        axle = self.axle
        if self.is_at_rest and axle.angle_deg == self._angle_deg:
            return 0.0
        DriverMotor.run_until(self, end_ns)
        if self._moved_ns != end_ns:
            self.leave_roll()
            self.move_axle(end_ns)
        if noise_dps and axle.speed_dps:
            self._turn_axle(end_ns, axle.angle_deg + noise_dps / self._hz)
        turned_deg = axle.angle_deg - self._angle_deg
        self._angle_deg = axle.angle_deg
        self.position_deg += turned_deg
        if axle.speed_dps == 0.0:
            if not self.is_at_rest:
                self.settle()
            if turned_deg == 0.0 and (axle.low_deg > -inf or axle.high_deg < inf):
                self.blocked_ticks = 0 if axle.stands else self.blocked_ticks + 1
        elif self._control is self.speed_control:
            self._begin_cruise(end_ns, noise_dps)
        self.counting_dps = axle.speed_dps
        return turned_deg

    # Even speed

    def _begin_cruise(self, now_ns: int, noise_dps: float) -> None:
        """Begin to run at constant speed, without single steps, if the motor has had its target speed for some ticks.

        The motor does not begin if a timer will soon fire, or if its target or an end stop is near.
        """
        setpoint = self.speed_control.setpoint
        if noise_dps or not -MAX_ERROR_DPS <= self.speed_dps - setpoint <= MAX_ERROR_DPS:
            self._even_ticks = 0
            return
        self._even_ticks += 1
        if self._even_ticks < EVEN_TICKS or abs(setpoint) < MIN_CRUISE_DPS:
            return
        cruise_dps = setpoint + copysign(CUT_OFF_DPS, setpoint)
        end_ns = min(self._timers_ns, now_ns + self._estimate_free_ns(cruise_dps))
        if end_ns > now_ns + self._tick_ns and self.state_bits == self._looked_bits:
            self._cruise_dps = cruise_dps
            self._cruise_end_ns = end_ns
            self.axle.speed_dps = cruise_dps

    def _estimate_free_ns(self, cruise_dps: float) -> int:
        """Return for how many ns a motor at a constant speed stays away from its target and its end stops."""
        axle = self.axle
        end_deg = axle.high_deg if cruise_dps > 0 else axle.low_deg
        free_s = (end_deg - axle.angle_deg) / cruise_dps
        if self._arrival_action is not None:
            free_s = min(free_s, (self.target - self.position) / cruise_dps - self.lowering_s)
        return int(min((free_s - MARGIN_S), MAX_CRUISE_S) * NS_PER_S)

    def _leave_cruise(self) -> None:
        """End the run at constant speed, and go on in single steps from the end of the last tick."""
        now_ns = self._end_ns(self._tick)
        cruise_dps = self._cruise_dps
        axle = self.axle
        self._cruise_dps = 0.0
        self._even_ticks = 0
        axle.angle_deg = self._angle_deg
        self._moved_ns = now_ns
        self.counter.add_evenly(now_ns * TICKS_PER_NS, axle.angle_deg, cruise_dps)
        self._step_ns = (now_ns // STEP_NS + 1) * STEP_NS
        self.read_counts(self.counter.count)

    def wake(self, time_ns: int) -> None:
        """Run the motor until `time_ns`, and make it run in single steps from then on.

        It is called when a command or an obstacle changes the motor.
        """
        if self._cruise_dps:
            self._leave_cruise()
        DriverMotor.wake(self, time_ns)
        self._even_ticks = 0

    def run_until(self, time_ns: int) -> None:
        """Run all steps of the control and all timers that are due until `time_ns`."""
        if self._cruise_dps and time_ns >= self._cruise_end_ns:
            self._leave_cruise()
        if not self._cruise_dps:
            DriverMotor.run_until(self, time_ns)
            return
        self._skip_looks(time_ns)
        since_s = (time_ns // STEP_NS * STEP_NS - self._end_ns(self._tick)) / NS_PER_S
        self.read_counts(floor(2 * (self._angle_deg + self._cruise_dps * since_s)))

    def _turn_axle(self, time_ns: int, angle_deg: float) -> None:
        """Set the axle to an angle that noise or an obstacle causes; the turn takes no time."""
        self.leave_roll()
        axle = self.axle
        before_deg = self.axle.angle_deg
        axle.angle_deg = min(max(angle_deg, axle.low_deg), axle.high_deg)
        self.counter.record(time_ns * TICKS_PER_NS, 0.0, before_deg, axle.angle_deg, 0.5)

    def count_quiet_ticks(self, tick: int) -> int:
        """Return the number of ticks after `tick` in which the motor is at rest or runs at constant speed."""
        self._tick = tick
        if self.is_at_rest:
            return ENDLESS
        return int((self._cruise_end_ns - 1) // self._tick_ns) - tick if self._cruise_dps else 0

    def glide(self, ticks: int) -> Glide:
        """Advance the motor by several ticks at rest or at constant speed; return how it moves."""
        even = self.glide_evenly(ticks)
        counts_deg = [*even.counts_deg]
        self.position_deg = counts_deg[-1]
        return Glide([even.roll_deg] * ticks, counts_deg)

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Return the motor's motion over several ticks at constant speed.

        `position_deg` is not changed: the caller sets it after that.
        """
        self._tick += ticks
        turned_deg = self._cruise_dps / self._hz
        if not turned_deg:
            return EvenGlide(0.0, repeat(self.position_deg, ticks))
        turns_deg = repeat(turned_deg, ticks)
        *_, self._angle_deg = accumulate(turns_deg, initial=self._angle_deg)
        first_deg = self.position_deg + turned_deg
        return EvenGlide(turned_deg, accumulate(repeat(turned_deg, ticks - 1), initial=first_deg))

    # Obstacles

    def state(self) -> MotorState:
        """Return the motor's state for `hold_back`, which uses only the axle's angle at the end of the last tick."""
        return STOPPED, 1.0, 0.0, self._angle_deg

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Set the axle to the angle at which an obstacle stopped it in the last tick.

        Args:
            before: The motor's `state` before the tick.
            turned_deg: How far the wheel would have turned in the tick without the obstacle.
            part: The fraction of the tick's motion that the obstacle allowed, below 1.
        """
        if turned_deg == 0.0:
            return
        if self._cruise_dps:
            self._leave_cruise()
        self.leave_roll()
        axle = self.axle
        before_deg = before[-1]
        there_deg = before_deg + (self._angle_deg - before_deg) * part
        self.counter.take_back(there_deg)
        self._turn_axle(self._moved_ns, there_deg)
        self.position_deg += axle.angle_deg - self._angle_deg
        self._angle_deg = axle.angle_deg
        axle.speed_dps = self.counting_dps = 0.0
        self.bar(turned_deg)
        self.blocked_ticks = (
            self.blocked_ticks + 1 if abs(turned_deg * part) < STANDSTILL_DEG else 0
        )

    @property
    def tendency_deg(self) -> float:
        """Rough estimate of the wheel's turn in the next tick, in degrees. Only its sign is reliable."""
        axle = self.axle
        if axle.speed_dps:
            return axle.speed_dps / self._hz
        if axle.stands:
            return 0.0
        if axle.goal_dps > 0:
            return PUSH_DEG
        return -PUSH_DEG

    def bar(self, direction: float) -> None:
        """Block turns of the axle in one direction.

        Args:
            direction: Its sign is that of the turns to block; 0 removes the block.
        """
        axle = self.axle
        low_deg = axle.angle_deg if direction < 0 else -inf
        high_deg = axle.angle_deg if direction > 0 else inf
        if self.is_at_rest and (low_deg, high_deg) != (axle.low_deg, axle.high_deg):
            self.wake(self._end_ns(self._tick))
        self.leave_roll()
        axle.low_deg, axle.high_deg = low_deg, high_deg
        self.is_barred = bool(direction)
        if not direction:
            self.blocked_ticks = 0

    def limit_axle(self, low_deg: float, high_deg: float) -> None:
        """Keep the axle between two angles, both relative to its present one."""
        self.leave_roll()
        angle_deg = self.axle.angle_deg
        self.axle.low_deg, self.axle.high_deg = angle_deg + low_deg, angle_deg + high_deg
