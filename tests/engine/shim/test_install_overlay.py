"""The guide's table of what is put right in the library: each row is run, under both profiles."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from tests.engine.shim.checking import Check, Table, differences
from tests.engine.shim.conftest import RunOn
from tuisim.commands.guide import find_page

SETUP = """
import time
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
from ev3dev2.sound import Sound
from ev3dev2.wheel import EV3EducationSetTire

def ms(call):
    start = time.time()
    call()
    return round(1000 * (time.time() - start))

class Tank:
    pass
"""


@dataclass(frozen=True)
class Row:
    """One row of the table: what a program does, and what that shows under either profile."""

    text: str
    robolab: str
    ev3: str
    robot: str = "default"
    setup: str = ""


def same(text: str, shows: str, robot: str = "default", setup: str = "") -> Row:
    """Return a row that is the same under both profiles."""
    return Row(text, shows, shows, robot, setup)


ROWS: dict[str, Row] = {
    "`reflected_light_intensity` on white": Row(
        "ColorSensor().reflected_light_intensity", "255", "85"
    ),
    "`red`, `green`, `blue` on white": Row(
        "(lambda c: (c.red, c.green, c.blue))(ColorSensor())", "(255, 255, 255)", "(256, 256, 256)"
    ),
    "`reflected_light_intensity_pc`, `full_reflected_light_intensity`": Row(
        "(lambda c: (c.reflected_light_intensity_pc, c.full_reflected_light_intensity))(ColorSensor())",
        "(100.0, 100.0)",
        "(85.09803921568627, 85.09803921568627)",
    ),
    "`ev3dev2_glue.get_clock()`": same(
        "get_clock() - now > 1",
        "True",
        setup="from ev3dev2_glue import get_clock\nnow = get_clock()\ntime.sleep(1.5)",
    ),
    "`Sound.get_volume()`": Row(
        "Sound().set_volume(40), Sound().get_volume()",
        "(None, 40)",
        "TypeError: invalid cmd type (<class 'list'>",
    ),
    "`Sound.speak()` with `'` in the text": Row(
        'Sound().speak("It\'s")', "None", "ValueError: No closing quotation"
    ),
    "a missing part": same(
        "LargeMotor(OUTPUT_A)",
        "DeviceNotFound: LargeMotor(ev3-ports:outA) is not connected. This robot has: outB lego-ev3-l-motor",
    ),
    "`Display` text without a font": same(
        "Display().draw.textbbox((0, 0), 'iiii') == Display().draw.textbbox((0, 0), 'WWWW')",
        "True",
        setup="from ev3dev2.display import Display",
    ),
    "`Leds.animate_flash(block=False)`": same(
        "leds.animate_flash('AMBER', duration=1, block=False), time.sleep(3), leds.animate_stop()",
        "(None, None, None)",
        setup="from ev3dev2.led import Leds\nleds = Leds()",
    ),
    "reading `Led.trigger`": Row(
        "light.trigger",
        "'default-on'",
        "ValueError: too many values to unpack",
        setup="from ev3dev2.led import Led\nlight = Led()\nlight.trigger = 'default-on'",
    ),
    "`Button.wait_for_released()` of a button that is not pressed": same(
        "Button().wait_for_released('up', 500)", "True", setup="from ev3dev2.button import Button"
    ),
    "`==`, `<` of two speeds": same("SpeedPercent(50) == SpeedPercent(50)", "TypeError"),
    "`ColorSensor.lab`, `hls`": Row(
        "[round(value) for value in (*c.lab, *c.hls)]",
        "[9342, 0, 0, 0, 255, 0]",
        "[8209, 0, 0, 0, 217, 0]",
        setup="c = ColorSensor()",
    ),
    "`play_song()` with `/`": same(
        "ms(lambda: Sound().play_song([('C4', 'q/2')], delay=0))", "1000"
    ),
    "`play_note()` with a lower-case note": same(
        "Sound().play_note('a4', 1)", "ValueError: invalid note (a4)"
    ),
    "`GyroSensor.circle_angle()`": same(
        "g.circle_angle()", "360", setup="g = GyroSensor(); g._init_angle = 270"
    ),
    "`MotorSet.run_to_rel_pos()` and similar methods": Row(
        "t.run_to_rel_pos(position_sp=90, speed_sp=200), t.wait_while('running'), t.left_motor.position",
        "(None, None, 180)",
        "(None, None, 185)",
        "plain",
        "t = MoveTank(OUTPUT_B, OUTPUT_C)",
    ),
    "`follow_for_ms` after an exception": same(
        "follow_for_ms(t, 1000), time.sleep(1.5), follow_for_ms(t, 1000)",
        "(True, None, False)",
        setup="t = Tank()",
    ),
    "`odometry_start()` after driving": Row(
        "d.odometry_start(), time.sleep(0.1), d.odometry_stop(), round(d.y_pos_mm)",
        "(None, None, None, 100)",
        "(None, None, None, 101)",
        "plain",
        "d = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 168)\nd.on_for_distance(30, 100)",
    ),
    "button methods that `InfraredSensor` inherits": same(
        "i.any(), i.check_buttons(['up'])", "TypeError", "eyes", "i = InfraredSensor()"
    ),
}
"""By the item's text in the guide."""

EXERCISED = {
    "ev3dev2.sound:Sound.set_volume",
    "ev3dev2.sound:Sound.get_volume",
    "ev3dev2.sound:Sound.channel",
}
"""Items that only these tests exercise."""


@pytest.mark.quick_cases("robolab-*")
@pytest.mark.parametrize(
    "profile, robot",
    [
        *(
            (profile, robot)
            for profile in ("robolab", "ev3")
            for robot in ("default", "plain", "eyes")
        ),
        # Moves, which only the plain robot makes, are its own in this profile.
        *(("nbev3devsim", robot) for robot in ("default", "eyes")),
    ],
)
def test_each_changed_library_call_does_what_the_guides_row_says(
    run_on: RunOn, profile: str, robot: str
) -> None:
    checks = []
    for row in ROWS.values():
        if row.robot == robot:
            checks += [
                Check(row.setup or "pass"),
                Check(row.text, row.ev3 if profile == "ev3" else row.robolab),
            ]
    table = Table("ev3dev2", SETUP, tuple(checks))
    done = run_on(table.program, robot, profile=profile)
    assert "\n".join(differences(table, done.lines)) == ""
    assert done.ended.end == "finished", done.errors


def test_the_guides_table_of_changed_calls_has_exactly_the_tested_rows() -> None:
    section = find_page("library-differences").source.partition("## What is not simulated")[0]
    rows = [
        line.split(" | ")[0].removeprefix("| ") for line in section.splitlines() if " | " in line
    ]
    assert rows[2:] == list(ROWS)


def test_the_volume_is_shared_by_all_sound_objects_and_stays(run_on: RunOn) -> None:
    done = run_on(
        "from ev3dev2.sound import Sound\ns, t = Sound(), Sound()\nprint(s.get_volume())\n"
        "s.set_volume(70)\nprint(t.get_volume(), t.channel, s.channel)\n"
        "t.play_tone(440, 0.1, volume=20)\nprint(s.get_volume(), s.get_volume('Playback'))\n"
        "s.set_volume(250)\ns.set_volume(5, channel='Beep')\nprint(t.get_volume(), t.get_volume('Beep'))\n"
        "s.set_volume(1.5)",
        profile="robolab",
    )
    assert done.lines == ["100", "70 None Playback", "20 20", "100 5"]
    assert done.errors[-1].startswith("ValueError: Unknown format code 'd'")
