"""A brick with motors and no robot around it, on a clock that looks every 10 ms."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

from tuisim.engine.core.driver.plant import Axle, PlantSpec
from tuisim.engine.core.profile import PROFILES, MotorLaw
from tuisim.engine.core.servo.drive_base import DriveBase
from tuisim.engine.core.servo.hub_motors import PLANTS
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import BATTERY_V, MODELS
from tuisim.engine.core.simulation import CommandHook
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.display import Screen
from tuisim.engine.shim.pybricks.brick import Brick, Connected
from tuisim.engine.shim.sound import Mixer
from tuisim.settings.robots import ROBOTS

TICK_NS = 10_000_000
WHEEL_KG_M2 = 0.0003
"""What a motor of a recorded drive base of a hub has to turn besides itself."""


def build_plants(load_kg_m2: float) -> dict[str, PlantSpec]:
    """Return the motors of the recordings by kind, with the firmware's own data and not those of a brick."""
    loaded = {kind: plant.add_load(load_kg_m2, 0.0) for kind, plant in PLANTS.items()}
    return {**MODELS, **loaded}


class MotorsOnly:
    """A simulation without a robot: it obeys commands to motors and drive bases."""

    def __init__(self, motors: list[ServoMotor], hub: str, robot: dict[str, float]) -> None:
        usual = ROBOTS["Prime_Robot"] if hub else RobotSpec()
        self.spec = SimpleNamespace(profile=PROFILES["lego-micropython"], robot=usual)
        self._robot = robot
        self.zero_deg = 0.0
        self.motors = motors
        self.bases: dict[int, DriveBase] = {}
        self.scales: dict[ServoMotor, float] = {}
        self.find_number = motors.index
        self.on_command: CommandHook = lambda *_: None

    @property
    def gyro_deg(self) -> float:
        """The heading that a gyro shows, clockwise, with its errors."""
        robot, (left, right) = self._robot, self.motors
        ways = (left.position_deg * left.sign * robot["left"], right.position_deg * robot["right"])
        turned_deg = (ways[0] - ways[1]) / 2 / robot["track"]
        return turned_deg * robot["scale"] + self.zero_deg

    def reset_gyro(self, shown_deg: float) -> None:
        """Let the gyro show another heading: of a robot with motors only, it shows 0."""
        self.zero_deg += shown_deg - self.gyro_deg if self._robot else 0.0


class Lab:
    """A session whose time passes in ticks of 10 ms.

    Args:
        law: Which firmware moves the motors.
        kinds: The kind of motor on each port.
        stop_deg: Where an end stop blocks every motor, to either side; None for nowhere.
    """

    def __init__(
        self,
        law: MotorLaw,
        kinds: dict[str, str],
        stop_deg: float | None = None,
        hub: str = "",
        robot: dict[str, float] | None = None,
    ) -> None:
        plants = build_plants(WHEEL_KG_M2 if robot else 0.0)
        self.motors = {
            port: ServoMotor(100, law, kind, Axle(plants[kind], BATTERY_V))
            for port, kind in kinds.items()
        }
        self.now = self.tick = 0
        self.free = 1
        """The recordings have no costs of calls."""
        self.stop_deg = stop_deg
        self.held_up = ""
        self.pressed: frozenset[str] = frozenset()
        self.until_ns = 1 << 62
        self.shown: list[tuple[str, Stream]] = []
        self.looks: list[Callable[[int], None]] = []
        self.sim = MotorsOnly([*self.motors.values()], hub, robot or {})
        built: Any = SimpleNamespace(motors=self.motors, sensors={}, lights=None, battery=None)
        plugs: Any = SimpleNamespace(
            add=lambda *_: False,
            take_hold=lambda _: None,
            find_path=lambda _: "",
            make_wheels=lambda *_: None,
        )
        self.mixer, self.sounds = Mixer(), list[tuple[str, int, str]]()
        Connected.brick = self.brick = Brick(
            cast(Any, self),
            built,
            plugs,
            Screen(cast(Any, self)),
            self.mixer,
            lambda _: "",
        )

    def spend(self, duration_ns: int, code: int = -1) -> None:
        """Let time pass.

        Raises:
            TimeoutError: the time of the experiment is over.
        """
        until = self.now + duration_ns
        while (self.tick + 1) * TICK_NS <= min(until, self.until_ns):
            self.tick += 1
            self.now = self.tick * TICK_NS
            for motor in self.motors.values():
                before = motor.state()
                turned = motor.step(self.tick, 0.0)
                if self.stop_deg is not None and abs(motor.position_deg) > self.stop_deg and turned:
                    beyond = abs(motor.position_deg) - self.stop_deg
                    motor.hold_back(before, turned, max(0.0, 1 - beyond / abs(turned)))
            for look in self.looks:
                look(self.tick * 10)
        if until > self.until_ns:
            raise TimeoutError
        self.now = until

    def note_reading(self, code: int) -> None:
        """Record nothing."""

    def charge(self, _cost_ns: int) -> None:
        """Charge nothing: the recordings have no costs of calls."""

    def show(self, row: str, stream: Stream) -> None:
        """Keep what is recorded."""
        self.shown.append((row, stream))

    def speak(self, text: str, wait_ns: int, tones: str = "", file: str = "") -> None:
        """Keep a sound with its time in ms, and wait."""
        self.sounds.append((text, self.now // 1_000_000, tones))
        self.spend(wait_ns)

    def command(self) -> None:
        """Count nothing."""

    def wait_for_motor(self, timeout_ns: int, again: bool = False) -> None:
        """Wait to the end."""
        self.spend(timeout_ns)
