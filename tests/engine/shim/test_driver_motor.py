"""Motors of a brick with ev3dev: what a program writes, reads and waits for."""

from __future__ import annotations

from itertools import chain
from math import isfinite

import pytest

from tests.cases import cases
from tests.engine.shim.conftest import RunOn
from tuisim.engine.core.tick_record import TICK_RECORD

HEAD = "import time\nfrom ev3dev2.motor import *\nm = LargeMotor(OUTPUT_B)\n"
LINES = {
    "set points keep their direction if the polarity is written after them": (
        "m.speed_sp = 300; m.position_sp = 90; m.polarity = 'inversed'\n"
        "print(m.speed_sp, m.position_sp, m.duty_cycle_sp)\n"
        "m.stop_action = 'hold'; m.command = 'run-to-rel-pos'; time.sleep(1.5)\n"
        "print(abs(m.position + 90) <= 1)",
        ["-300 -90 0", "True"],
    ),
    "set points wait for the next command": (
        "m.run_forever(speed_sp=300)\ntime.sleep(1)\nm.speed_sp = 600\ntime.sleep(0.5)\n"
        "print(abs(m.speed - 300) <= 2)\nm.command = 'run-forever'\ntime.sleep(1)\n"
        "print(abs(m.speed - 600) <= 2)",
        ["True", "True"],
    ),
    "the duty of run-direct acts at once": (
        "m.run_direct(duty_cycle_sp=50)\nm.duty_cycle_sp = -50\ntime.sleep(1)\n"
        "print(m.duty_cycle, -450 < m.speed < -400, m.state)",
        ["-50 True ['running']"],
    ),
    "reset restores everything": (
        "m.speed_p = 7; m.polarity = 'inversed'; m.stop_action = 'hold'; m.ramp_up_sp = 100\n"
        "m.run_forever(speed_sp=300)\ntime.sleep(1)\nm.reset()\n"
        "print(m.speed_p, m.polarity, m.stop_action, m.ramp_up_sp, m.speed_sp, m.state, -9 < m.position < 0)",
        ["1000 normal coast 0 0 [] True"],
    ),
    "what is out of range is refused": (
        "for name, value in dict(speed_sp=1051, duty_cycle_sp=-101, time_sp=-1, ramp_up_sp=60001,"
        " speed_p=-1, stop_action='fly', command='jump').items():\n"
        "    try:\n        setattr(m, name, value)\n"
        "    except ValueError:\n        print(name)",
        [
            "speed_sp",
            "duty_cycle_sp",
            "time_sp",
            "ramp_up_sp",
            "speed_p",
            "stop_action",
            "command",
        ],
    ),
    "a motor that is held back is stalled": (
        "m.on(0)\nm.wait_until('stalled', 1000)\nprint(m.state)",
        ["['running', 'stalled']"],
    ),
    "each attribute takes its time, and what the library remembers a little": (
        "begin = time.time()\nm.max_speed\nremembered = time.time()\nm.position\nread = time.time()\n"
        "m.speed_sp = 9\nwritten = time.time()\nms = lambda a, b: round((b - a) * 1000, 2)\n"
        "print(ms(begin, remembered), ms(remembered, read), ms(read, written))",
        # With 0.02 ms for each look at the clock.
        ["0.16 1.22 1.12"],
    ),
    "the shell sees the same": (
        "import subprocess\nm.on_for_degrees(50, 90)\ntime.sleep(1)\n"
        "path = f'/sys/class/tacho-motor/motor{m.device_index}/'\n"
        "for name in ('state', 'speed_sp', 'position_sp', 'stop_action'):\n"
        "    print(subprocess.check_output(['cat', path + name], text=True).strip())\n"
        "path += 'position'\nprint(int(subprocess.check_output(['cat', path])) == m.position)",
        ["holding", "525", "90", "hold", "True"],
    ),
}


@cases("text, lines", LINES)
def test_motor_calls_read_and_wait_as_the_ev3_driver_does(
    run_on: RunOn, text: str, lines: list[str]
) -> None:
    done = run_on(HEAD + text, profile="ev3")
    assert done.lines == lines, done.errors


def test_a_move_on_the_ev3_overshoots_and_swings_back(run_on: RunOn) -> None:
    text = "m.on_for_degrees(50, 360)\nprint(m.position)\ntime.sleep(1)\nprint(m.position)"
    first, last = map(int, run_on(HEAD + text, profile="ev3").lines)
    assert 365 <= first <= 380
    assert 358 <= last <= 362


@pytest.mark.parametrize("seconds", [0.25, 1.0, 2.0])
def test_a_timed_move_ends_as_late_as_with_the_ev3_driver(run_on: RunOn, seconds: float) -> None:
    text = f"t = time.time()\nm.on_for_seconds(50, {seconds})\nprint(time.time() - t)"
    [line] = run_on(HEAD + text, profile="ev3").lines
    # By the kernel's timer, by the driver's look, and by four attributes that are written.
    assert 0.004 < float(line) - seconds < 0.16


def test_a_wait_for_a_motor_ends_when_the_driver_updates_its_state(run_on: RunOn) -> None:
    text = (
        "for _ in range(6):\n    m.on_for_degrees(50, 90, block=False)\n"
        "    while 'running' in m.state: pass\n    t = time.time()\n"
        "    m.on_for_degrees(50, 90, block=False)\n    m.wait_until_not_moving()\n"
        "    u = time.time()\n    print(round(u * 1000) - round(t * 1000))\n"
    )
    lines = [int(line) for line in run_on(HEAD + text, profile="ev3").lines]
    assert all(200 < line < 320 for line in lines), lines
    assert len(set(lines)) > 1


EV3DEV = """
import random, time
from ev3dev2.motor import *
chance = random.Random({seed})
motors = [LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C), MediumMotor(OUTPUT_A)]
for _ in range(25):
    m = chance.choice(motors)
    m.polarity = chance.choice(['normal', 'normal', 'inversed'])
    m.ramp_up_sp = m.ramp_down_sp = chance.choice([0, 0, 0, 300])
    m.stop_action = chance.choice(['coast', 'brake', 'hold'])
    m.speed_sp, m.position_sp = chance.randrange(-900, 900), chance.randrange(-500, 500)
    m.duty_cycle_sp, m.time_sp = chance.randrange(-100, 101), chance.randrange(800)
    if chance.random() < 0.1:
        m.position = chance.randrange(-90, 90)
    m.command = chance.choice(m.commands + ['run-forever'] * 2)
    if chance.random() < 0.3:
        m.wait_until_not_moving(timeout=chance.randrange(1, 900))
    elif chance.random() < 0.2:
        m.on_for_degrees(chance.randrange(1, 90), chance.randrange(-200, 200))
    else:
        time.sleep(chance.random() / 3)
    print(time.time(), [(m.position, m.speed, m.duty_cycle, m.state) for m in motors])
for m in motors:
    # A move that a wall holds up never ends.
    m.stop()
"""
PYBRICKS = """
import urandom as random
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop
from pybricks.tools import wait
random.seed({seed})
motors = [Motor(Port.B), Motor(Port.C), Motor(Port.A)]
for _ in range(25):
    m, speed = random.choice(motors), random.randrange(-900, 900)
    then = random.choice([Stop.COAST, Stop.BRAKE, Stop.HOLD])
    call = random.choice([
        lambda: m.dc(speed // 9), lambda: m.run(speed), lambda: m.run_time(speed, 300, then, False),
        lambda: m.run_angle(speed, 200, then, False), lambda: m.run_target(speed, 90, then, False),
        m.stop, m.brake, m.hold, lambda: m.reset_angle(speed // 9),
    ])
    call()
    wait(random.randrange(300))
    print([(m.angle(), m.speed()) for m in motors])
for m in motors:
    m.stop()
"""
LIBRARIES = {"ev3": EV3DEV, "lego-micropython": PYBRICKS}


@pytest.mark.parametrize("profile", LIBRARIES)
@pytest.mark.parametrize("seed", range(2))
def test_random_motor_programs_give_the_same_output_twice(
    run_on: RunOn, profile: str, seed: int
) -> None:
    """A random program on a robot with an arm, among obstacles, comes out the same in every way of running it."""
    text = LIBRARIES[profile].format(seed=seed)
    done = run_on(text, "arm", "furnished", profile)
    assert done.ended.end == "finished", done.errors
    assert len(done.lines) == 25
    fields = chain.from_iterable(TICK_RECORD.iter_unpack(done.recording[0][64:]))
    assert all(map(isfinite, fields))
    for live in (False, True):
        again = run_on(text, "arm", "furnished", profile, live)
        assert again.recording == done.recording
        assert again.lines == done.lines


def test_the_battery_is_the_one_that_motors_feel(run_on: RunOn) -> None:
    text = "from ev3dev2.power import PowerSupply\nprint(PowerSupply().measured_volts)"
    [line] = run_on(text, profile="ev3").lines
    # Less what the brick takes.
    assert 7.9 < float(line) < 8.0


def test_polling_a_motors_state_file_returns_when_the_driver_updates_it(run_on: RunOn) -> None:
    text = (
        "import select\n"
        "f = open(f'/sys/class/tacho-motor/motor{m.device_index}/state')\np = select.poll()\n"
        "p.register(f, select.POLLPRI | select.POLLERR)\nf.read()\n"
        "m.run_timed(speed_sp=300, time_sp=500)\nt = time.time()\n"
        "while 'running' not in f.read(): p.poll(); f.seek(0)\n"
        "while p.poll(2000):\n    f.seek(0)\n    if 'running' not in f.read(): break\n"
        "print(round(1000 * (time.time() - t)))"
    )
    [line] = run_on(HEAD + text, profile="ev3").lines
    assert 490 <= int(line) <= 590
