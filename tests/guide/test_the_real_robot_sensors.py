"""The table of what sensors do on bricks and here, in the guide's page *From simulator to real robot*."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.engine.core.memory_sink import MemorySink
from tuisim.engine.core.drift import draw_echo_bias_mm
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import EV3, PROFILES
from tuisim.engine.core.sensors.ultrasonic import measure_noisy_mm
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import FIELD_WIDTH_MM, RobotSpec, RunSpec, UltrasonicSpec, WorldSpec
from tuisim.engine.core.state import Instant
from tuisim.engine.core.values import list_values
from tuisim.guide.catalogue import load_pages

TYPICAL: DriftSpec = list_values(WorldSpec)["drift"].parse_text("typical")

LIGHT = """
from ev3dev2.sensor.lego import ColorSensor
print(ColorSensor('in2').reflected_light_intensity)
"""
SWITCH = """
import time
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor
eye = ColorSensor('in2')
old = eye.value(0)
eye.mode = 'RGB-RAW'
MoveTank(OUTPUT_B, OUTPUT_C).on_for_degrees(20, 20, 360)
before = time.time()
eye.mode = 'COL-REFLECT'
while eye.value(0) == old:
    last = time.time()
print(f"old until {1000 * (last - before):.0f} ms, new from {1000 * (time.time() - before):.0f} ms on")
"""
INFRARED = """
import time
from ev3dev2.sensor.lego import InfraredSensor
eye, before = InfraredSensor(), time.time()
eye.mode = 'IR-SEEK'
print(f"{time.time() - before:.1f} s")
"""
GYRO = """
import time
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import GyroSensor
gyro = GyroSensor()
MoveTank(OUTPUT_B, OUTPUT_C).on_for_degrees(20, -20, 180)
time.sleep(1)
gyro.angle, gyro.rate
gyro.mode = 'GYRO-ANG'
time.sleep(1)
print(gyro.angle)
"""


@pytest.fixture
def tell(here: Command, tmp_path: Path) -> Callable[..., str]:
    """`tell(text, …)`: what a program prints under `ev3`."""

    def run(text: str, *words: object) -> str:
        (tmp_path / "row.py").write_text(text)
        done = here("run", "row.py", "--profile", "ev3", *words)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    return run


def is_in_table(name: str, here: str) -> bool:
    """Return whether the table has a row of a name that ends in what comes out here."""
    lines = load_pages()["the-real-robot"].source.splitlines()
    (row,) = (line for line in lines if line.startswith(f"| {name} |"))
    return row.endswith(f"| {here} |")


def read_distance_mm(distance_mm: float, seed: int) -> int:
    sensor = UltrasonicSpec(ray_angles_deg=(0.0,))
    pose = Pose(FIELD_WIDTH_MM - sensor.y_mm - distance_mm, 500.0, 0.0)
    instant = Instant(0, pose, drift=TYPICAL, profile=EV3, seed=seed)
    return measure_noisy_mm(sensor, instant, WorldSpec(drift=TYPICAL))


def spin(sign: int, robot: RobotSpec, drift: DriftSpec) -> Simulation:
    """Return a robot after about a whole turn."""
    spec = RunSpec(robot, WorldSpec(drift=drift), PROFILES["lego-micropython"])
    sim = Simulation(spec, MemorySink())
    for motor, speed in ((sim.left, sign * 9000), (sim.right, -sign * 9000)):
        assert isinstance(motor, ServoMotor)
        motor.run_freely(0, speed)
    while abs(sim.pose.heading_deg) < 360:
        sim.advance(1)
    return sim


@pytest.mark.parametrize(("name", "x_mm"), [("white", 150), ("black", 1525)])
def test_the_guides_row_of_reflected_light_is_what_comes_out(
    tell: Callable[..., str], name: str, x_mm: int
) -> None:
    percent = tell(LIGHT, "-b", "Grey_bands", "-x", x_mm, "-y", 500)
    assert is_in_table(f"reflected light of {name} paper", f"{percent} %")


def test_the_guides_row_of_a_change_of_mode_is_what_comes_out(tell: Callable[..., str]) -> None:
    shown = tell(SWITCH, "-b", "Grey_bands", "-x", 150, "-y", 500)
    assert is_in_table("first values of a colour sensor after a change of mode", shown)
    assert is_in_table("angle of an older gyro after its rate was read", f"{tell(GYRO)}°")


def test_the_guides_row_of_infrared_is_what_comes_out(
    tell: Callable[..., str], tmp_path: Path
) -> None:
    (tmp_path / "eye.toml").write_text('gyro = false\n\n[infrared]\nport = "in4"\n')
    shown = tell(INFRARED, "-r", "eye.toml")
    assert is_in_table("change of mode of the infrared sensor", shown)


@pytest.mark.parametrize(("name", "sign"), [("clockwise", 1), ("counter-clockwise", -1)])
def test_the_guides_row_of_a_whole_turn_is_what_comes_out(name: str, sign: int) -> None:
    sim = spin(sign, RobotSpec(), DriftSpec(gyro_scale_pc=TYPICAL.gyro_scale_pc))
    counted_deg = 360 * sim.build_instant().gyro_deg / abs(sim.pose.heading_deg)
    assert is_in_table(f"a whole turn {name}", f"{abs(counted_deg):.0f}°, with typical drift")


def test_the_guides_row_of_the_fastest_turn_is_what_comes_out() -> None:
    instant = spin(1, RobotSpec(wheel_spacing_mm=60.0), DriftSpec()).build_instant()
    assert is_in_table("highest rate of turn", f"{instant.gyro_rate_dps}°/s")


def test_the_guides_row_of_distances_is_what_comes_out() -> None:
    errors = [draw_echo_bias_mm("in1", TYPICAL, seed) for seed in range(300)]
    shown = f"{min(errors)} to {max(errors)} mm, with typical drift"
    assert is_in_table("error of an ultrasonic sensor", shown)
    assert all(read_distance_mm(250, seed) == 250 + errors[seed] for seed in range(9))
    assert is_in_table("a wall 2 cm ahead", f"{read_distance_mm(20, 1) / 10:g} cm")
