"""Readings that are used too often, questions that are asked too seldom, and values that are lost."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.reason import ReasonKind, describe_end, find_reasons

ONCE = """\
# %%sim_magic_preloaded -b Grey_bands
import time
light = colorLeft.reflected_light_intensity_pc
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
for step in range(30):
    if light < 90:
        tank_drive.off()
    time.sleep(0.05)
tank_drive.off()
"""
STEERS = """\
# %%sim_magic_preloaded -b Grey_bands
light = colorLeft.reflected_light_intensity_pc
while get_clock() < 4:
    error = light - 100
    tank_turn.on(error, SpeedPercent(50))
"""
STUCK = """\
# %%sim_magic -r Explorer --profile ev3 -b Empty_Map
from ev3dev2.sensor.lego import TouchSensor
hit = TouchSensor('in1').is_pressed
while not hit:
    print(1)
"""
STALE = """\
# %%sim_magic_preloaded -b Grey_bands
light = colorLeft.reflected_light_intensity_pc
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while light > 6:
    print(light)
"""
ASKS = """\
# %%sim_magic_preloaded -b Empty_Map -o Wall -x 400 -y 600
import time
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
if ultrasonic.distance_centimeters < {}:
    tank_drive.off()
time.sleep(1)
"""
TOUCHES = """\
# %%sim_magic -r Explorer --profile ev3 -b Empty_Map
from time import sleep
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import TouchSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)
bumper = TouchSensor('in1')
tank.on(20, 20)
sleep(0.5)
if bumper.is_pressed:
    tank.off()
{}
"""
LOST = """\
# %%sim_magic_preloaded -b Grey_bands
speed = 20
def go_faster():
    speed = 60
tank_drive.on_for_seconds(SpeedPercent(speed), SpeedPercent(speed), 0.5)
go_faster()
tank_drive.on_for_seconds(SpeedPercent(speed), SpeedPercent(speed), 0.5)
"""
WRONG = {
    "compared again and again": (
        ONCE,
        "0.61 s, line 6: colorLeft on in2 saw 89.02 % here, but line 3 read it only once, at "
        "0.01 s (100 %), before the loop in line 5: read it inside the loop",
    ),
    "a colour": (
        ONCE.replace("reflected_light_intensity_pc", "color_name")
        .replace("light < 90", "light == 'Black'")
        .replace("Grey_bands", "Grey_bands -x 1200"),
        "s, line 6: colorLeft on in2 saw black here, but line 3 read it only once, at 0.02 s (white)",
    ),
    "steered by": (STEERS, "s, line 5: colorLeft on in2 saw "),
    "asked once": (
        ASKS.format(15),
        "0.01 s, line 4: this line asked only once: ultrasonic on in1 read 108 cm, not less "
        "than 15 cm; so line 5 did not stop what line 3 started: a while loop asks until it comes",
    ),
    "asked once, never stopped": (
        TOUCHES.format(""),
        "line 9: this line asked only once, and the answer was no; so line 10 did not stop what line 7",
    ),
    "a name of a function": (
        LOST,
        "0.51 s, line 4: speed is a name of go_faster() alone here, so the speed of line 2 stays as it "
        "was: global speed in go_faster() changes that",
    ),
}


@cases("text, words", WRONG)
def test_a_misuse_is_named_with_its_instant_line_and_value(text: str, words: str) -> None:
    run = run_text(text, limit_s=5.0)
    first = find_reasons(run)[0]
    assert first.kind is ReasonKind.MISTAKEN
    assert words in first.words
    assert words in describe_end(run)["went_wrong"]


def test_a_truth_that_never_changes_is_named_without_a_wait_for_it() -> None:
    (read_once,) = find_reasons(run_text(STUCK, limit_s=0.5))
    assert (
        "line 4: hit never changes: line 3 read it only once, at 0.00 s, before" in read_once.words
    )


@pytest.mark.slow_cases("later grey")
@pytest.mark.parametrize("limit_s", [0.3, 1.5, 2.5], ids=["white", "first grey", "later grey"])
def test_a_loop_that_renews_no_reading_is_named_wherever_its_run_was_cut_off(
    limit_s: float,
) -> None:
    (stuck,) = find_reasons(run_text(STALE, limit_s=limit_s))
    assert stuck.words == (
        "0.02 s, line 4: from here on it waited for light to be 6 or less, but nothing changes it after "
        "line 2: read it inside the loop"
    )


@cases(
    "text",
    {
        "left by a break": STALE + "    if get_clock() > 1:\n        break\n",
        "left by an exit": STALE + "    if get_clock() > 1:\n        sys.exit()\n",
        "beside a thread": "import threading\nwhile True:\n    pass\n",
        "with a pause": "import time\nwhile True:\n    time.sleep(0.1)\n",
        "left at once": STALE.replace("> 6", "< 6"),
    },
)
def test_a_loop_that_something_else_ends_is_no_endless_wait(text: str) -> None:
    assert not [
        reason
        for reason in find_reasons(run_text("import sys\n" + text, limit_s=0.3))
        if reason.kind is ReasonKind.BLOCKED
    ]


@cases(
    "text",
    {
        "the light stays as it was": ONCE.replace("< 90", "< 20"),
        "read inside": ONCE.replace(
            "    if light", "    light = colorLeft.reflected_light_intensity_pc\n    if light"
        ),
        "also read inside": ONCE.replace("    time", "    print(colorLeft.color)\n    time"),
        "true at once": ASKS.format(150),
        "asked twice": ASKS.format(15).replace(
            "time.sleep(1)",
            "while ultrasonic.distance_centimeters > 100:\n    pass\ntank_drive.off()",
        ),
        "asked in each step": ASKS.format(15)
        .replace("tank_drive.on", "for step in range(4):\n    tank_drive.on")
        .replace("\nif", "\n    if")
        .replace("    tank_drive.off()", "        tank_drive.off()")
        .replace("time.sleep(1)", "    time.sleep(0.25)"),
        "stopped anyway": TOUCHES.format("sleep(0.2)\ntank.off()"),
        "global": LOST.replace("    speed = 60", "    global speed\n    speed = 60"),
    },
)
def test_a_program_that_means_it_is_not_blamed(text: str) -> None:
    run = run_text(text, limit_s=10.0)
    assert find_reasons(run) == ()
    assert not any(describe_end(run).values())


def test_a_stop_in_the_loop_that_needs_the_motors_comes_before_the_wait_in_vain() -> None:
    text = (
        "# %%sim_magic_preloaded -b Grey_bands\ntank_drive.on(20, 20)\n"
        "while colorLeft.reflected_light_intensity_pc > 6:\n"
        "    print(1)\n    tank_drive.off()\n"
    )
    first, wait, *_ = find_reasons(run_text(text))
    assert (
        "this stops the motors in the first pass of the loop: write tank_drive.off()" in first.words
    )
    assert wait.kind is ReasonKind.BLOCKED
