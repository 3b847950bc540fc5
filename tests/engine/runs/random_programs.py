"""Programs that do anything to motors and sensors: of each library, drawn by a seed."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

from tuisim.engine.core.profile import PROFILES, Library

Step = Callable[[random.Random], str]

EV3DEV2 = """\
from time import sleep
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
tank, left, right = MoveTank(OUTPUT_B, OUTPUT_C), LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
"""

PYBRICKS = """\
from pybricks.ev3devices import *
from pybricks.parameters import *
from pybricks.robotics import DriveBase
from pybricks.tools import wait
left, right = Motor(Port.B), Motor(Port.C)
base = DriveBase(left, right, 56, 114)
"""


def _speed(chance: random.Random) -> int:
    return chance.choice((-100, -40, -7, 0, 3, 20, 35, 50, 80, 100, chance.randint(-100, 100)))


def _motor(chance: random.Random) -> str:
    return chance.choice(("left", "right"))


def _time(chance: random.Random) -> str:
    return f"{chance.choice((0, 0.003, 0.01, 0.0137, 0.1, 0.25, 0.5, chance.random())):.4f}"


def _drive(chance: random.Random) -> str:
    call = chance.choice(("tank.on", "steer.on"))
    speeds = (_speed(chance), _speed(chance))
    return f"{call}({speeds[0]}, {speeds[1]}); sleep({_time(chance)})"


def _move(chance: random.Random) -> str:
    amount = chance.choice(("seconds", "degrees", "rotations"))
    much = {"seconds": chance.random(), "degrees": chance.randint(-400, 400), "rotations": 0.7}
    more = f"brake={chance.random() < 0.5}, block={chance.random() < 0.7}"
    return f"tank.on_for_{amount}({_speed(chance)}, {_speed(chance)}, {much[amount]:.3f}, {more})"


def _command(chance: random.Random) -> str:
    command = chance.choice(
        ("run_forever", "run_timed", "run_to_abs_pos", "run_to_rel_pos", "run_direct", "stop")
    )
    speed = 10 * _speed(chance)
    position = chance.randint(-300, 300)
    stop = chance.choice(("coast", "brake", "hold"))
    given = f"speed_sp={speed}, position_sp={position}, duty_cycle_sp={_speed(chance)}"
    given += f", time_sp={chance.randint(0, 500)}, stop_action='{stop}'"
    return f"{_motor(chance)}.{command}({given}); sleep({_time(chance)})"


def _set(chance: random.Random) -> str:
    name, value = chance.choice(
        (
            ("position", chance.randint(-500, 500)),
            ("polarity", chance.choice(("'normal'", "'inversed'"))),
            ("ramp_up_sp", chance.choice((0, 200, 1500))),
            ("ramp_down_sp", chance.choice((0, 200, 1500))),
            ("duty_cycle_sp", _speed(chance)),
            ("position_p", chance.randint(0, 90_000)),
            ("speed_i", chance.randint(0, 200)),
            ("speed_sp", 5 * _speed(chance)),
        )
    )
    return f"{_motor(chance)}.{name} = {value}"


def _read(chance: random.Random) -> str:
    return chance.choice(
        (
            f"print({_motor(chance)}.position, {_motor(chance)}.speed, {_motor(chance)}.state)",
            "print(ColorSensor().reflected_light_intensity, GyroSensor().angle)",
            "GyroSensor().reset()",
            "GyroSensor().mode = 'GYRO-RATE'; GyroSensor().mode = 'GYRO-ANG'",
            "print(UltrasonicSensor().distance_centimeters)",
        )
    )


def _loop(chance: random.Random) -> str:
    speed = _speed(chance)
    turns = chance.randint(2, 25)
    wait = _time(chance)
    return (
        f"for turn in range({turns}):\n"
        f"        error = (ColorSensor().reflected_light_intensity + left.position) % 40 - turn\n"
        f"        tank.on({speed} / 2 + error / 2, {speed} / 2 - error / 2); sleep({wait} / 20)"
    )


def _wait_ev3dev2(chance: random.Random) -> str:
    return chance.choice(
        (
            f"sleep({_time(chance)})",
            f"{_motor(chance)}.wait_until_not_moving(timeout={chance.randint(1, 700)})",
            f"{_motor(chance)}.reset()",
            "tank.off()",
        )
    )


EV3DEV2_STEPS: Sequence[Step] = (_drive, _move, _command, _set, _read, _loop, _wait_ev3dev2)


def _then(chance: random.Random) -> str:
    stop = chance.choice(("COAST", "BRAKE", "HOLD"))
    wait = chance.random() < 0.6
    return f"then=Stop.{stop}, wait={wait}"


def _motor_call(chance: random.Random) -> str:
    speed = 8 * _speed(chance)
    angle = chance.randint(-400, 400)
    duty = _speed(chance)
    call = chance.choice(
        (
            f"run({speed})",
            f"run_time({speed}, {chance.randint(0, 600)}, {_then(chance)})",
            f"run_angle({speed}, {angle}, {_then(chance)})",
            f"run_target({speed}, {angle}, {_then(chance)})",
            f"track_target({angle})",
            f"dc({duty})",
            "stop()",
            "brake()",
            "hold()",
            f"reset_angle({angle})",
            f"control.limits(acceleration={chance.randint(100, 2000)})",
            f"control.pid(kp={chance.randint(50, 900)})",
        )
    )
    return f"{_motor(chance)}.{call}; wait({chance.choice((0, 1, 7, 60, 250))})"


def _base_call(chance: random.Random) -> str:
    call = chance.choice(
        (
            f"straight({chance.randint(-150, 150)})",
            f"turn({chance.randint(-120, 120)})",
            f"drive({3 * _speed(chance)}, {_speed(chance)})",
            "stop()",
            f"settings({chance.randint(50, 300)}, {chance.randint(50, 600)}, 90, 180)",
            f"heading_control.pid({chance.randint(50, 900)})",
            "reset()",
        )
    )
    return f"base.{call}; wait({chance.choice((0, 1, 13, 120, 300))})"


def _read_pybricks(chance: random.Random) -> str:
    return chance.choice(
        (
            f"print({_motor(chance)}.angle(), {_motor(chance)}.speed(), base.distance())",
            "print(ColorSensor(Port.S3).reflection())",
            "print(GyroSensor(Port.S4).angle(), GyroSensor(Port.S4).speed())",
            "left = Motor(Port.B, Direction.COUNTERCLOCKWISE)",
        )
    )


PYBRICKS_STEPS: Sequence[Step] = (_motor_call, _motor_call, _base_call, _base_call, _read_pybricks)


def draw_program(seed: int, profile: str) -> str:
    """Return a program of the library of a profile; what it is refused it passes over."""
    chance = random.Random(seed)
    is_ev3dev2 = PROFILES[profile].motor_law.library is Library.EV3DEV2
    begin, steps = (EV3DEV2, EV3DEV2_STEPS) if is_ev3dev2 else (PYBRICKS, PYBRICKS_STEPS)
    parts = [begin]
    for _ in range(chance.randint(5, 25)):
        step = chance.choice(steps)(chance)
        parts.append(f"try:\n    {step}\nexcept Exception as error:\n    print(error)\n")
    return "".join(parts)
