"""Sensors, lights, sound and battery by the documented rules: what is asked of them, and what must come back."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

from tests.proof.kind import FaultError

_SETUP = """\
import json, time
from ev3dev2.led import Leds
from ev3dev2.power import PowerSupply
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
from ev3dev2.sound import Sound
color, gyro, sonar, leds, sound, power = ColorSensor(), GyroSensor(), UltrasonicSensor(), Leds(), Sound(), PowerSupply()
def lit(group):
    return [led.brightness for led in leds.led_groups[group]]
for text in {texts!r}:
    error, value = '', None
    try:
        value = eval(text)
    except SyntaxError:
        exec(text)
    except Exception as raised:
        error = type(raised).__name__
    print(json.dumps([error, value]))
"""


@dataclass(frozen=True, slots=True)
class Ask:
    """Something that a program does, and what must come of it."""

    text: str
    value: Any = None
    """A tuple is the least and the most; `...` is anything."""
    error: str = ""


@dataclass(frozen=True, slots=True)
class Reading:
    """What a property reads."""

    mode: str
    low: float
    high: float
    values: int = 1
    decimals: int = 0


READINGS: Mapping[str, Reading] = {
    "color.reflected_light_intensity": Reading("COL-REFLECT", 0, 100),
    "color.ambient_light_intensity": Reading("COL-AMBIENT", 0, 100),
    "color.color": Reading("COL-COLOR", 0, 7),
    "color.red": Reading("RGB-RAW", 0, 1020, values=3),
    "gyro.angle": Reading("GYRO-ANG", -32768, 32767),
    "gyro.rate": Reading("GYRO-RATE", -440, 440),
    "gyro.angle_and_rate[0]": Reading("GYRO-G&A", -32768, 32767, values=2),
    "sonar.distance_centimeters": Reading("US-DIST-CM", 0, 255, decimals=1),
    "sonar.distance_inches": Reading("US-DIST-IN", 0, 100.3, decimals=1),
    "sonar.other_sensor_present": Reading("US-LISTEN", 0, 1),
}
COLORS: Mapping[str, tuple[float, float]] = {
    "BLACK": (0, 0),
    "RED": (1, 0),
    "GREEN": (0, 1),
    "AMBER": (1, 1),
    "ORANGE": (1, 0.5),
    "YELLOW": (0.1, 1),
}


def _sensor(random: Random) -> list[Ask]:
    text, reading = random.choice(list(READINGS.items()))
    name = text.partition(".")[0]
    return [
        # The first reading in another mode is still one of the mode before.
        Ask(text, ...),
        Ask("time.sleep(0.1)"),
        Ask(text, (reading.low, reading.high)),
        Ask(
            f"[{name}.mode, {name}.num_values, {name}.decimals]",
            [reading.mode, reading.values, reading.decimals],
        ),
        Ask(f"{name}.mode in {name}.modes", True),
        # What is read is the raw number, scaled.
        Ask(f"abs({text} - {name}.value(0) / 10 ** {name}.decimals) <= 1", True),
    ]


def _mode(random: Random) -> list[Ask]:
    text, reading = random.choice(list(READINGS.items()))
    name = text.partition(".")[0]
    wrong = random.choice(["", "ODD", reading.mode.lower(), f"{reading.mode} "])
    return [
        Ask(f"setattr({name}, 'mode', {reading.mode!r})"),
        Ask(f"setattr({name}, 'mode', {wrong!r})", error="ValueError"),
        Ask(f"{name}.mode", reading.mode),
        Ask(f"{name}.command", error="Exception"),
    ]


def _gyro(_random: Random) -> list[Ask]:
    return [Ask("gyro.reset()"), Ask("gyro.angle", 0)]


def _lights(random: Random) -> list[Ask]:
    group, name = random.choice(["LEFT", "RIGHT"]), random.choice(list(COLORS))
    percent = random.choice([1, 0.5, 0, random.random()])
    color = COLORS[name] if random.random() < 0.4 else (random.random(), random.random())
    given = name if color == COLORS[name] else color
    lit = [int(value * percent * 255) for value in color]
    return [
        Ask(f"leds.set_color({group!r}, {given!r}, {percent!r})"),
        Ask(f"lit({group!r})", lit),
        *random.choice(
            [
                [],
                [Ask("leds.all_off()"), Ask("lit('LEFT') + lit('RIGHT')", [0, 0, 0, 0])],
                [Ask("leds.reset()"), Ask("lit('LEFT') + lit('RIGHT')", [0, 255, 0, 255])],
                [
                    Ask(f"leds.set_color({group!r}, 'PINK')", error="AssertionError"),
                    Ask(f"lit({group!r})", lit),
                ],
                [
                    Ask("leds.set_color('TOP', 'RED')", error="AssertionError"),
                    Ask(f"lit({group!r})", lit),
                ],
            ]
        ),
    ]


def _sound(random: Random) -> list[Ask]:
    length, pause = random.choice([0.25, 0.5, 1.0]), random.choice([0.0, 0.3])
    waits = f"[time.time(), sound.play_tone(440, {length}, {pause}), time.time()]"
    return [
        Ask(f"(lambda t: t[1] is None and t[2] - t[0] >= {length + pause} - 0.02)({waits})", True),
        random.choice(
            [
                Ask("sound.play_tone(440, 0)", error="ValueError"),
                Ask("sound.play_tone(440, 1, -1)", error="ValueError"),
                Ask("sound.play_tone(440, 1, 0, 101)", error="ValueError"),
                Ask("sound.play_tone(440, 1, 0, 50, 3)", error="AssertionError"),
                Ask("sound.play_note('H4', 1)", error="ValueError"),
                Ask("sound.play_song([('X9', 'q')])", error="KeyError"),
                Ask("sound.play_song([('C4', 'q')], 0)", error="ValueError"),
                Ask("sound.play_file('none.wav')", error="ValueError"),
                Ask("sound.play_file('none.mp3')", error="ValueError"),
                Ask("sound.speak('x', play_type=7)", error="AssertionError"),
            ]
        ),
    ]


def _power(_random: Random) -> list[Ask]:
    return [
        Ask("abs(power.measured_volts - power.measured_voltage / 1e6) < 0.5", True),
        Ask("power.min_voltage < power.measured_voltage", True),
        Ask("power.measured_current > 0 and power.measured_amps < 20", True),
    ]


_CHOICES: tuple[Callable[[Random], list[Ask]], ...] = (
    _sensor,
    _sensor,
    _mode,
    _gyro,
    _lights,
    _lights,
    _sound,
    _power,
)


def check_devices(random: Random, printed: Callable[[str], list[str]]) -> None:
    """Ask the devices at random; `printed` runs a program and returns what it prints."""
    asked = [ask for _ in range(20) for ask in random.choice(_CHOICES)(random)]
    lines = printed(_SETUP.format(texts=[ask.text for ask in asked]))
    for ask, line in zip(asked, lines, strict=True):
        error, value = json.loads(line)
        is_right = (
            ask.value[0] <= value <= ask.value[1]
            if isinstance(ask.value, tuple)
            else ask.value is ... or value == ask.value
        )
        if error != ask.error or (not error and not is_right):
            raise FaultError(f"{ask.text}: {error or value}, not {ask.error or ask.value}")
