"""Names, numbers and times of drawn log files, with what a reader has to make of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import pairwise
from random import Random

Points = list[tuple[float | None, float | None]]
"""Time in s and value of each sample; None where there is none."""

NAMES = (
    *("left", "right", "speed", "gyro", "angle", "distance", "battery", "error", "x", "y", "CH1"),
    *("light_left", "motor.A", "Lichtstärke", "température", "Abstand_ä", "Größe"),
)
NAMES_WITH_BLANKS = ("motor A", "Channel B", "température intérieure", "Drehzahl groß")
UNITS = ("V", "mV", "cm", "mm", "°C", "°", "m/s", "deg/s", "A", "%")
WORDS = ("forward", "left turn", "stop", "black", "white", "zurück")
START = datetime(2025, 3, 1, 12, 0)


@dataclass(frozen=True)
class Draft:
    """The text of a file, and what stands in it."""

    lines: tuple[str, ...]
    points: Mapping[str, Points]
    rows: int | None
    kinds: tuple[str, ...]
    suffixes: tuple[str, ...]
    refusable: str = ""


@dataclass(frozen=True)
class Clock:
    """The cells that tell the time of each row: none, one or two."""

    headings: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    times_s: tuple[float | None, ...]


def draw_names(random: Random, count: int, *, with_blanks: bool) -> list[str]:
    """Return different names of variables."""
    return random.sample((*NAMES, *NAMES_WITH_BLANKS) if with_blanks else NAMES, count)


def draw_numbers(random: Random, style: str, count: int, *, with_comma: bool) -> list[str]:
    """Return numbers with a decimal point, in a style: whole, decimals, exponents, grouped.

    They rise and fall, so that nobody takes them for times.
    """
    low, high = random.choice(((0, 100), (0, 1023), (-500, 500), (-40, 0), (0, 1)))
    # With three digits behind it, a decimal comma looks like one between thousands.
    digits = random.choice((1, 2, 4)) if with_comma else random.randint(1, 6)
    letter = random.choice("eE")
    power = random.randint(-6, 9)
    while True:
        values = [random.uniform(low, high) for _ in range(count)]
        if style == "whole":
            texts = [str(round(value)) for value in values]
        elif style == "exponents":
            texts = [
                f"{value * 10.0 ** random.randint(power - 3, power):.{digits}{letter}}"
                for value in values
            ]
        elif style == "grouped":
            texts = [f"{random.uniform(-9_000, 3_000_000):.2f}" for _ in values]
        else:
            texts = [f"{value:.{digits}f}" for value in values]
        numbers = [float(text) for text in texts]
        steps = [later - number for number, later in pairwise(numbers)]
        if min(steps) < 0 < max(steps):
            return texts


def localize(text: str, decimal: str, thousands: str) -> str:
    """Write a number with another decimal sign, and a sign between thousands."""
    whole, point, fraction = text.partition(".")
    if thousands:
        whole = f"{int(whole):,}".replace(",", thousands) if whole != "-0" else whole
    return whole + (decimal if point else "") + fraction


def draw_steps_ms(random: Random, count: int, unit_ms: int) -> list[int]:
    """Return rising times from 0, mostly of one step, in multiples of a unit."""
    step = random.choice((1, 2, 5, 10)) * unit_ms
    jitter = random.choice((0, 0, unit_ms))
    times_ms = [0]
    while len(times_ms) < count:
        times_ms.append(times_ms[-1] + step + random.choice((0, jitter)))
    return times_ms


def write_moment(moment: datetime, pattern: str, fraction: str) -> str:
    """Write a date or a clock; `fraction` is the sign before milliseconds, empty for none."""
    text = moment.strftime(pattern)
    return f"{text}{fraction}{moment.microsecond // 1000:03}" if fraction else text


CLOCKS = (
    *("none", "seconds", "milliseconds", "ISO with T", "ISO with blank", "German date"),
    *("date and clock", "time of day", "epoch seconds", "epoch milliseconds", "secs and nsecs"),
)
"""Forms of time."""

PATTERNS = {
    "ISO with T": "%Y-%m-%dT%H:%M:%S",
    "ISO with blank": "%Y-%m-%d %H:%M:%S",
    "German date": "%d.%m.%Y %H:%M:%S",
    "time of day": "%H:%M:%S",
}
HEADINGS: dict[str, tuple[tuple[str, ...], ...]] = {
    "seconds": (("time",), ("t",), ("time (s)",), ("Time [s]",), ("t_s",), ("Zeit (s)",)),
    "milliseconds": (("time_ms",), ("t [ms]",), ("Time (ms)",), ("Zeit [ms]",), ("t_ms",)),
    "date and clock": (("date", "time"), ("Date", "Time"), ("Datum", "Uhrzeit")),
    "time of day": (("time",), ("clock",), ("Uhrzeit",)),
    "epoch seconds": (("time",), ("timestamp",), ("epoch",)),
    "epoch milliseconds": (("time",), ("timestamp",), ("timestamp_ms",)),
    "secs and nsecs": (
        ("secs", "nsecs"),
        ("sec", "nanosec"),
        ("header.stamp.secs", "header.stamp.nsecs"),
    ),
}
OF_DATES = (("timestamp",), ("time",), ("date",), ("Zeitpunkt",), ("recorded",))
TIME_UNITS = {"seconds": ("s",), "milliseconds": ("ms",), "secs and nsecs": ("s", "ns")}


def draw_clock(random: Random, kind: str, count: int, decimal: str, fraction: str) -> Clock:
    """Return the cells of a form of time.

    Args:
        kind: One of `CLOCKS`.
        decimal: The decimal sign of numbers.
        fraction: The sign before the milliseconds of a clock; empty for whole seconds.
    """
    if kind == "none":
        return Clock((), (), ((),) * count, (None,) * count)
    is_clock = kind in PATTERNS or kind == "date and clock"
    times_ms = draw_steps_ms(random, count, 1000 if is_clock and not fraction else 10)
    if kind in ("seconds", "milliseconds"):
        offset_ms = random.choice((0, 0, 12_340))
        times_ms = [time_ms + offset_ms for time_ms in times_ms]
    start = START + timedelta(seconds=random.randrange(6 * 3600), days=random.randrange(90))
    rows = write_times(random, kind, start, times_ms, (decimal, fraction))
    shift_s = (start - datetime(start.year, start.month, start.day)).seconds
    times_s = [time_ms / 1000 + (shift_s if kind == "time of day" else 0) for time_ms in times_ms]
    headings = random.choice(HEADINGS.get(kind, OF_DATES))
    return Clock(headings, TIME_UNITS.get(kind, ("",) * len(headings)), rows, tuple(times_s))


def write_times(
    random: Random, kind: str, start: datetime, times_ms: Sequence[int], signs: tuple[str, str]
) -> tuple[tuple[str, ...], ...]:
    """Return the cells of times: of each row one or two."""
    decimal, fraction = signs
    epoch_ms = int((start - datetime(1970, 1, 1)).total_seconds() * 1000)
    zone = random.choice(("", "Z")) if kind in ("ISO with T", "ISO with blank") else ""
    day = random.choice(("%Y-%m-%d", "%d.%m.%Y"))
    rows: list[tuple[str, ...]] = []
    for time_ms in times_ms:
        moment = start + timedelta(milliseconds=time_ms)
        if kind == "seconds":
            cells: tuple[str, ...] = (f"{time_ms / 1000:.2f}".replace(".", decimal),)
        elif kind == "milliseconds":
            cells = (str(time_ms),)
        elif kind == "date and clock":
            cells = (moment.strftime(day), write_moment(moment, "%H:%M:%S", fraction))
        elif kind == "epoch seconds":
            cells = (f"{(epoch_ms + time_ms) / 1000:.2f}".replace(".", decimal),)
        elif kind == "epoch milliseconds":
            cells = (str(epoch_ms + time_ms),)
        elif kind == "secs and nsecs":
            seconds, rest_ms = divmod(epoch_ms + time_ms, 1000)
            cells = (str(seconds), str(rest_ms * 1_000_000))
        else:
            cells = (write_moment(moment, PATTERNS[kind], fraction) + zone,)
        rows.append(cells)
    return tuple(rows)
