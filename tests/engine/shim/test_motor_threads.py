"""A program of three threads gives the same log every time: headless, live, paced or not."""

from __future__ import annotations

from hashlib import md5

import pytest

from tests.engine.shim.conftest import RunOn
from tests.running import Done

PROGRAM = """\
import threading, time
from ev3dev2.button import Button
from ev3dev2.led import Leds
from ev3dev2.motor import MoveTank
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor

tank, color, gyro, eye = MoveTank('outB', 'outC'), ColorSensor('in2'), GyroSensor(), UltrasonicSensor()
buttons, leds = Button(), Leds()
going, side = True, 1

def drive():
    while going:
        tank.on_for_degrees(20 + 10 * side, 30, 90)
        time.sleep(0.05)
    tank.off()

def sense():
    while going:
        print('Red:', color.reflected_light_intensity)
        print('Turned:', gyro.angle)
        print('Far:', eye.distance_centimeters)
        time.sleep(0.03)

def turn(pressed):
    global side
    if pressed:
        side = -side
        print('Side:', side)

def leave(pressed):
    global going
    going = pressed
    leds.set_color('LEFT', 'RED' if pressed else 'AMBER')

def watch():
    buttons.on_enter, buttons.on_backspace = turn, leave
    buttons.on_change = lambda changes: print('changes', sorted(changes))
    while going:
        buttons.process()
        time.sleep(0.02)

threads = [threading.Thread(target=work) for work in (drive, sense, watch)]
leds.animate_police_lights('RED', 'GREEN', sleeptime=0.11, duration=None, block=False)
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
leds.animate_stop()
print('End:', time.monotonic())
"""

PRESSES = ("enter@0.4", "up@0.65-1.2", "enter@0.9-1.1", "backspace@1.5-1.6")

SPEEDS = (None,) * 10 + (0.0,) * 6 + (16.0,) * 4
"""By run: None is headless, 0 live as fast as possible, above that live so many times real time."""


def summary(done: Done) -> str:
    """Return the sum over everything that was recorded."""
    assert done.ended.end == "finished", done.errors
    return md5(b"".join(done.recording)).hexdigest()


@pytest.mark.slow
def test_three_threads_give_the_same_log_in_20_runs(run_on: RunOn) -> None:
    runs = [
        run_on(
            PROGRAM,
            "default",
            "lollipop",
            "robolab",
            live=speed is not None,
            presses=PRESSES,
            speed=speed or 0.0,
        )
        for speed in SPEEDS
    ]
    assert len({summary(done) for done in runs}) == 1
    lines = runs[0].lines
    assert [line for line in lines if line.startswith(("Side", "changes"))] == [
        "Side: -1",
        "changes [('enter', True)]",
        "changes [('enter', False)]",
        "changes [('up', True)]",
        "Side: 1",
        "changes [('enter', True)]",
        "changes [('enter', False)]",
        "changes [('up', False)]",
        "changes [('backspace', True)]",
        "changes [('backspace', False)]",
    ]
    assert lines[-1].startswith("End: 2.")
    assert len(lines) > 60


def test_a_press_at_another_time_gives_another_log(run_on: RunOn) -> None:
    first, second = (
        run_on(PROGRAM, "default", "lollipop", "robolab", presses=presses)
        for presses in (PRESSES, ("enter@0.41", *PRESSES[1:]))
    )
    assert summary(first) != summary(second)
