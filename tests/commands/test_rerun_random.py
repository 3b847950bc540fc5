"""Random programs that move several motors and wait for them do the same live and headless."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.running import run_live_and_headless
from tuisim.base.source import Program

BEGIN = """
from time import sleep
from ev3dev2.motor import LargeMotor, MediumMotor, MoveSteering, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
left = LargeMotor(OUTPUT_B)
right = LargeMotor(OUTPUT_C)
arm = MediumMotor(OUTPUT_A)
light = ColorSensor()
"""
MOVES = (
    "tank.on_for_seconds({a}, {b}, {s}, brake={brake})",
    "tank.on_for_degrees({a}, {b}, {deg}, brake={brake})",
    "tank.on_for_rotations({a}, {b}, {s})",
    "steer.on_for_seconds({deg} % 100, {a}, {s})",
    "left.on_for_seconds({a}, {s}, block=False); right.on_for_seconds({b}, {s}, block=False)",
    "left.wait_until_not_moving(timeout=1000); right.wait_until_not_moving(timeout=1000)",
    "arm.on_for_degrees({a}, {deg}, block={brake})",
    "arm.on_for_seconds({a}, {s}, block={brake})",
    "arm.on({a})",
    "arm.off(brake={brake})",
    "left.ramp_up_sp = {deg}; right.ramp_down_sp = {deg}",
    "tank.on({a}, {b}); sleep({s}); tank.off(brake={brake})",
    "left.run_to_rel_pos(position_sp={deg}, speed_sp=400); left.wait_while('running', timeout=1500)",
    "tank.on({a}, {b}); left.wait_until('stalled', {deg}); tank.off()",
    "print('Light:', light.reflected_light_intensity, left.position, right.speed, arm.state)",
)


def _draw_program(draw: random.Random) -> str:
    moves = (
        draw.choice(MOVES).format(
            a=draw.choice((5, 20, 30, 50, 80, -30, -50)),
            b=draw.choice((10, 30, 30, 50, -30)),
            s=draw.choice((0.1, 0.5, 1, 1.5)),
            deg=draw.choice((30, 90, 200, 720)),
            brake=draw.random() < 0.5,
        )
        for _ in range(draw.randint(4, 16))
    )
    return BEGIN + "\n".join(moves) + "\n"


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["ev3", "robolab", "nbev3devsim"])
def test_a_random_program_does_the_same_live_and_headless(home: Path, profile: str) -> None:
    seed = random.randrange(2**32)
    draw = random.Random(seed)
    for number in range(25):
        program = Program("p.py", _draw_program(draw))
        choices = {"robot": "Explorer", "profile": profile, "walls": draw.random() < 0.5}
        _, diff = run_live_and_headless(program, {**choices, "seed": number}, speed=100.0)
        assert diff.same, f"seed {seed}, program {number}: {diff}\n{program.text}"
