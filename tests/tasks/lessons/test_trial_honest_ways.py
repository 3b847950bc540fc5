"""Ways in which students write the programs of lessons 1 to 8, which must all pass."""

from __future__ import annotations

import pytest

from tests.tasks.lessons.test_trial import LESSONS
from tuisim.tasks.goals.judgement import GoalState
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons.spec import Lesson, RunCheck
from tuisim.tasks.lessons.trial import build_task
from tuisim.tasks.pool import run_many

_ROWS = """\
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
light = 100
rows = 0
while light > 5:
    light = colorLeft.reflected_light_intensity_pc
    print("Colour: " + str(light))
    rows += 1
    time.sleep({period_s})
tank_drive.off()
print("Rows: " + str(rows))
"""
"""The rows of lesson 6, one each period."""
WAYS: dict[str, str] = {
    "band-values names in-a-sentence": """\
import time
tank_drive.on(20, 20)
done = ["white"]
before = ""
while "black" not in done:
    light = colorLeft.reflected_light_intensity_pc
    band = "dark" if light < 66 else "mid" if light < 84.5 else "pale" if light < 93 else "white"
    if light < 25:
        band = "black"
    if band == before and band != done[-1]:
        done.append(band)
        if band != "white":
            print(f"Band: {band}")
    before = band
    time.sleep(0.1)
tank_drive.off()
""",
    "sensor-eyes alike cut": """\
W = 3.14159 * 56
tank_drive.on_for_rotations(30, 30, 795 / W)
print("Grey:", int(colorLeft.reflected_light_intensity_pc))
tank_drive.on_for_rotations(30, 30, 300 / W)
print("Edge:", int(colorLeft.reflected_light_intensity_pc))
""",
    "places-colours all lower-case": """\
tank_drive.on(30, 30)
last = "white"
while last != "black":
    name = colorLeft.color_name.lower()
    if name != last and name != "white":
        print(name)
    last = name
tank_drive.off()
""",
    "places-colours all right-sensor": """\
tank_drive.on(30, 30)
last = "White"
while last != "Black":
    name = colorRight.color_name
    if name != last and name != "White":
        print(f"Now I see {name}")
    last = name
tank_drive.off()
""",
    "places-colours places two-in-a-line": """\
tank_drive.on(30, 30)
last = "White"
while last != "Black":
    name = colorLeft.color_name
    if name != last and name != "White":
        print(name); print(f"Place: {130 + tank_drive.left_motor.position / 360 * 176:.0f}")
    last = name
tank_drive.off()
""",
    "band-values names as-the-hints-say": """\
import time
def name_of(light):
    if light < 25: return "black"
    elif light < 66: return "dark"
    elif light < 84.5: return "mid"
    elif light < 93: return "pale"
    return "white"
tank_drive.on(30, 30)
last = "white"
while last != "black":
    name = name_of(colorLeft.reflected_light_intensity_pc)
    time.sleep(0.1)
    again = name_of(colorLeft.reflected_light_intensity_pc)
    if name == again and name != last:
        last = name
        if name != "white":
            print(name)
tank_drive.off()
""",
    "first-run say by-degrees": """\
tank_drive.on_for_degrees(SpeedPercent(50), SpeedPercent(50), 2050)
print("Now I stand on dark gray.")
""",
    "first-run say by-seconds": """\
tank_drive.on_for_seconds(SpeedPercent(30), SpeedPercent(30), 6.5)
print("grey")
""",
    "first-run say on-sleep-off": """\
import time
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
time.sleep(6.5)
tank_drive.off()
print("Grey!")
""",
    "first-run say two-moves": """\
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 2)
print("not there yet")
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 3.7)
name = "grey"
print(f"I am on the {name} band")
""",
    "first-run say coast": """\
tank_drive.on_for_rotations(SpeedPercent(60), SpeedPercent(60), 5.7, brake=False)
print("I'm on GREY")
""",
    "sensor-eyes alike looks-for-the-edge": """\
wheel = 56 * 3.1416
tank_drive.on_for_rotations(50, 50, 795 / wheel)
print(f"Grey: {colorLeft.reflected_light_intensity_pc:.1f}")
tank_drive.on(10, 10)
while colorLeft.reflected_light_intensity_pc < 90:
    pass
while True:
    light = colorLeft.reflected_light_intensity_pc
    if light < 55:
        break
tank_drive.off()
print(f"Edge: {light:.1f}")
""",
    "sensor-eyes alike print-at-the-end": """\
W = 3.14159 * 56
tank_drive.on_for_rotations(30, 30, 795 / W)
grey = colorLeft.reflected_light_intensity_pc
tank_drive.on_for_rotations(30, 30, 300 / W)
edge = colorLeft.reflected_light_intensity_pc
print("Grey: " + str(grey))
print(f"Edge: {edge:.1f}")
""",
    "sensor-eyes alike other-order": """\
W = 3.14159 * 56
tank_drive.on_for_rotations(30, 30, 1095 / W)
print("Edge:", round(colorLeft.reflected_light_intensity_pc, 1))
tank_drive.on_for_rotations(-30, -30, 300 / W)
print("Grey:", round(colorLeft.reflected_light_intensity_pc, 1))
""",
    "sensor-eyes alike function": """\
def go(mm):
    tank_drive.on_for_degrees(SpeedPercent(20), SpeedPercent(20), mm / (3.14159 * 56) * 360)
    return colorLeft.reflected_light_intensity_pc
for name, mm in (("Grey", 795), ("Edge", 300)):
    print(name + ": " + str(go(mm)))
""",
    "exact-moves far 3.41": """\
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 3.41)
""",
    "exact-moves far degrees": """\
tank_drive.on_for_degrees(SpeedPercent(80), SpeedPercent(80), 600 / 175.93 * 360)
""",
    "exact-moves far loop": """\
for _ in range(6):
    tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 100 / 175.93)
""",
    "exact-moves far by-position": """\
tank_drive.on(SpeedPercent(10), SpeedPercent(10))
while tank_drive.left_motor.position < 600 / 175.93 * 360:
    pass
tank_drive.off()
""",
    "exact-moves far steering": """\
tank_turn.on_for_rotations(0, SpeedPercent(30), 3.41)
""",
    "poll-or-block poll while-true": """\
tank_drive.on(30, 30)
while True:
    d = ultrasonic.distance_centimeters
    if d <= 20:
        break
tank_drive.off()
""",
    "poll-or-block poll sleep": """\
import time
tank_drive.on(SpeedPercent(25), SpeedPercent(25))
distance = ultrasonic.distance_centimeters
while distance > 21:
    time.sleep(0.05)
    distance = ultrasonic.distance_centimeters
    print("Distance: " + str(distance))
tank_drive.off()
""",
    "poll-or-block poll slower-near": """\
d = ultrasonic.distance_centimeters
while d > 20:
    tank_drive.on(SpeedPercent(min(30, d / 2)), SpeedPercent(min(30, d / 2)))
    d = ultrasonic.distance_centimeters
tank_drive.off()
""",
    "poll-or-block poll stop-then-slower": """\
tank_drive.on(60, 60)
while ultrasonic.distance_centimeters > 40:
    pass
tank_drive.off()
tank_drive.on(15, 15)
while ultrasonic.distance_centimeters > 20:
    pass
tank_drive.off()
""",
    "poll-or-block poll too-near-and-back": """\
tank_drive.on(40, 40)
while ultrasonic.distance_centimeters > 15:
    pass
tank_drive.on(-20, -20)
while ultrasonic.distance_centimeters < 20:
    pass
tank_drive.off()
""",
    "poll-or-block poll function": """\
def far():
    return ultrasonic.distance_centimeters > 20
tank_drive.on(30, 30)
while far():
    pass
tank_drive.off()
""",
    "places-colours red while-true": """\
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
while True:
    name = colorLeft.color_name
    if name == "Red":
        break
tank_drive.off()
print(name)
""",
    "places-colours red literal-after-loop": """\
tank_drive.on(SpeedPercent(10), SpeedPercent(10))
while colorLeft.color_name != "Red":
    pass
tank_drive.off()
print("Red")
""",
    "places-colours all wanted": """\
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
for wanted in ["Red", "Green", "Blue", "Black"]:
    while colorLeft.color_name != wanted:
        pass
    print(wanted)
tank_drive.off()
""",
    "places-colours all seen-list": """\
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
seen = []
while "Black" not in seen:
    name = colorLeft.color_name
    if name in ("Red", "Green", "Blue", "Black") and name not in seen:
        print("I see " + name)
        seen.append(name)
tank_drive.off()
""",
    "places-colours all ifs": """\
tank_drive.on(SpeedPercent(15), SpeedPercent(15))
last = ""
while True:
    name = colorLeft.color_name
    if name == "Red" and last != "Red":
        print("Red")
    elif name == "Green" and last != "Green":
        print("Green")
    elif name == "Blue" and last != "Blue":
        print("Blue")
    elif name == "Black":
        print("Black")
        break
    last = name
tank_drive.off()
""",
    "places-colours all no-four-whiles": """\
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
while colorLeft.color_name != "Red":
    pass
print("Red")
while colorLeft.color_name != "Green":
    pass
print("Green")
while colorLeft.color_name != "Blue":
    pass
print("Blue")
while colorLeft.color_name != "Black":
    pass
print("Black")
tank_drive.off()
""",
    "places-colours all two-equal": """\
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
before = last = "White"
while last != "Black":
    name = colorLeft.color_name
    if name == before and name != last:
        last = name
        if name != "White":
            print(name)
    before = name
    time.sleep(0.1)
tank_drive.off()
""",
    "places-colours places seen-list": """\
seen = []
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while "Black" not in seen:
    name = colorLeft.color_name
    if name not in seen and name != "White":
        seen.append(name)
        print(name)
        print("Place: " + str(130 + tank_drive.right_motor.position / 360 * 175.93))
tank_drive.off()
""",
    "places-colours places rotations": """\
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
for wanted in ["Red", "Green", "Blue", "Black"]:
    while colorLeft.color_name != wanted:
        pass
    print(wanted)
    print("Place: %.1f" % (130 + tank_drive.left_motor.rotations * 175.9))
tank_drive.off()
""",
    "places-colours places both-wheels": """\
W = 3.14159 * 56
def place():
    return 130 + (tank_drive.left_motor.position + tank_drive.right_motor.position) / 2 / 360 * W
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
last = ""
while last != "Black":
    name = colorLeft.color_name
    if name not in (last, "White"):
        x = place()
        print(name)
        print("Place:", x)
    last = name
tank_drive.off()
""",
    "log-period log own": """\
import time
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while True:
    light = colorLeft.reflected_light_intensity_pc
    print(f"Colour: {light:.1f}")
    if light < 1:
        break
    time.sleep(0.1)
tank_drive.off()
""",
    "log-period faster enumerate": """\
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
values = []
while not values or values[-1] > 5:
    values.append(colorLeft.reflected_light_intensity_pc)
    print("Colour: " + str(values[-1]))
    time.sleep(0.015)
tank_drive.off()
print("Rows: " + str(len(values)))
""",
    "log-period faster sleep-.02-plus": """\
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
light = 100
rows = 0
while light > 2:
    light = colorLeft.reflected_light_intensity_pc
    rows += 1
    print("Colour: " + str(round(light, 1)))
    time.sleep(0.02)
tank_drive.off()
print(f"Rows: {rows}")
""",
    "log-period faster many-rows": _ROWS.format(period_s=0.008),
    "log-period faster few-rows": _ROWS.format(period_s=0.0225),
    "band-values log slower": """\
import time
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
light = 100
while light > 1:
    light = colorLeft.reflected_light_intensity_pc
    print("Colour:", light)
    time.sleep(0.1)
tank_drive.off()
""",
    "band-values names ranges": """\
import time
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
last = name = before = "white"
while last != "black":
    light = colorLeft.reflected_light_intensity_pc
    if light < 25:
        name = "black"
    elif 45 < light < 55:
        name = "dark"
    elif 82 < light < 84:
        name = "mid"
    elif 85 < light < 88:
        name = "pale"
    else:
        name = "white"
    if name == before and name != last:
        if name != "white":
            print(name)
        last = name
    before = name
    time.sleep(0.1)
tank_drive.off()
""",
    "band-values names seen": """\
import time
LIMITS = [(25, "black"), (66, "dark"), (84.5, "mid"), (93, "pale"), (101, "white")]
def name_now():
    light = colorLeft.reflected_light_intensity_pc
    for limit, name in LIMITS:
        if light < limit:
            return name
seen = ["white"]
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
while "black" not in seen:
    first = name_now()
    time.sleep(0.15)
    if name_now() == first and first not in seen:
        print(first)
        seen.append(first)
tank_drive.off()
""",
    "band-values names wanted": """\
import time
tank_drive.on(SpeedPercent(30), SpeedPercent(30))
def in_band(low, high):
    a = colorLeft.reflected_light_intensity_pc
    time.sleep(0.1)
    b = colorLeft.reflected_light_intensity_pc
    return low < a < high and low < b < high
for name, low, high in [("pale", 84.5, 93), ("mid", 66, 84.5), ("dark", 25, 66), ("black", -1, 25)]:
    while not in_band(low, high):
        pass
    print(name)
tank_drive.off()
""",
    "noise scatter rounded": """\
light = colorLeft.reflected_light_intensity_pc
print(f"Light: {light:.1f}")
""",
    "noise mean list": """\
values = [colorLeft.reflected_light_intensity_pc for _ in range(100)]
print("Light: " + str(sum(values) / len(values)))
""",
    "noise mean statistics": """\
import statistics
values = []
while len(values) < 150:
    values.append(colorLeft.reflected_light_intensity_pc)
print("Light:", round(statistics.mean(values), 3))
""",
    "noise mean function": """\
def mean(n):
    total = 0
    for i in range(n):
        total += colorLeft.reflected_light_intensity_pc
    return total / n
print("Light: {:.2f}".format(mean(200)))
""",
    "exact-moves corner degrees": """\
S = SpeedPercent(40)
tank_drive.on_for_degrees(S, S, 600 / 175.93 * 360)
tank_drive.on_for_degrees(-20, 20, 0.804 * 360)
tank_drive.on_for_degrees(S, S, 400 / 175.93 * 360)
""",
    "exact-moves corner function": """\
def mm(n):
    tank_drive.on_for_rotations(SpeedPercent(60), SpeedPercent(60), n / 175.9)
mm(600)
tank_turn.on_for_rotations(-100, SpeedPercent(10), 0.804)
mm(400)
""",
    "exact-moves corner degrees-by-right-wheel": """\
S = SpeedPercent(30)
tank_drive.on_for_rotations(S, S, 3.41)
tank_turn.on_for_degrees(-100, S, 289)
tank_drive.on_for_rotations(S, S, 2.27)
""",
}
"""By lesson, step and what is special."""


@pytest.mark.quick_cases("poll-or-block poll while-true", "places-colours all wanted")
@pytest.mark.parametrize("way", WAYS)
def test_an_honest_program_passes_its_step(way: str) -> None:
    name, step_name, _ = way.split()
    lesson = LESSONS[name]
    (check,) = [step.check for step in lesson.steps if step.name == step_name]
    assert isinstance(check, RunCheck)
    for other in (None, *check.also):
        assert _missed(lesson, check, other, WAYS[way]) == []


def _missed(lesson: Lesson, check: RunCheck, other: TrialWorld | None, text: str) -> list[str]:
    """The reasons of the goals that a program misses in a world."""
    (result,) = run_many([build_task(lesson, text, seed=1, other=other)], jobs=1)
    wanted = other.goals if other else check.goals
    missed = [
        each
        for each in result.judgements
        if each.goal.name in wanted and each.state is not GoalState.MET
    ]
    return [
        f"{other.where if other else 'in the lesson'}: {each.goal.name}: {each.reason}"
        for each in missed
    ]
