"""Checks of what needs no device: units, wheels, stop watch, the library's own errors."""

from __future__ import annotations

from tests.shim.checking import Check, Table


def _distance(name: str, attribute: str, text: str, mm: float) -> tuple[Check, ...]:
    return (
        Check(
            f"{name}(2).mm, {name}(2).{attribute}",
            f"({2 * mm!r}, 2)",
            f"{name} {name}.__init__ {name}.mm {name}.{attribute}",
        ),
        Check(f"str({name}(2))", repr(f"2{text}"), f"{name}.__str__"),
        Check(
            f"type({name}(2) * 3).__name__, round(({name}(2) * 3).mm, 6)",
            f"({name!r}, {round(6 * mm, 6)!r})",
            f"{name}.__mul__",
        ),
        Check(f"round((3 * {name}(2)).mm, 6)", repr(round(6 * mm, 6)), "DistanceValue.__rmul__"),
        Check(f"{name}(2) * 'x'", "AssertionError"),
    )


UNIT = Table(
    "ev3dev2.unit",
    "from ev3dev2.unit import *",
    (
        Check(
            "CENTIMETER_MM, DECIMETER_MM, METER_MM, INCH_MM, FOOT_MM, YARD_MM, STUD_MM",
            "(10, 100, 1000, 25.4, 304.8, 914.4, 8)",
            "CENTIMETER_MM DECIMETER_MM METER_MM INCH_MM FOOT_MM YARD_MM STUD_MM",
        ),
        *_distance("DistanceMillimeters", "millimeters", "mm", 1),
        *_distance("DistanceCentimeters", "centimeters", "cm", 10),
        *_distance("DistanceDecimeters", "decimeters", "dm", 100),
        *_distance("DistanceMeters", "meters", "m", 1000),
        *_distance("DistanceInches", "inches", "in", 25.4),
        *_distance("DistanceFeet", "feet", "ft", 304.8),
        *_distance("DistanceYards", "yards", "yd", 914.4),
        *_distance("DistanceStuds", "studs", "stud", 8),
        Check(
            "DistanceInches(1) < DistanceCentimeters(3), DistanceInches(1) > DistanceCentimeters(3)",
            "(True, False)",
            "DistanceValue DistanceValue.__lt__",
        ),
        Check("DistanceInches(1) <= DistanceCentimeters(3)", "TypeError"),
        Check("DistanceInches(1) == DistanceInches(1)", "False"),
    ),
)

WHEEL = Table(
    "ev3dev2.wheel",
    "from ev3dev2.wheel import *",
    (
        Check("w = Wheel(40, 10)"),
        Check(
            "w.diameter_mm, w.width_mm, w.radius_mm, round(w.circumference_mm, 4)",
            "(40.0, 10.0, 20.0, 125.6637)",
            "Wheel Wheel.__init__ Wheel.diameter_mm Wheel.width_mm Wheel.radius_mm Wheel.circumference_mm",
        ),
        Check(
            "[(w().diameter_mm, w().width_mm) for w in (EV3Rim, EV3Tire, EV3EducationSetRim, EV3EducationSetTire)]",
            "[(30.0, 20.0), (43.2, 21.0), (43.0, 26.0), (56.0, 28.0)]",
            "EV3Rim EV3Rim.__init__ EV3Tire EV3Tire.__init__ EV3EducationSetRim EV3EducationSetRim.__init__ "
            "EV3EducationSetTire EV3EducationSetTire.__init__",
        ),
    ),
)

STOPWATCH = Table(
    "ev3dev2.stopwatch",
    "import time\nfrom ev3dev2.stopwatch import *\nw = StopWatch('lap')",
    (
        Check(
            "str(w), w.desc, str(StopWatch())",
            "('lap: 00:00:00.000', 'lap', 'StopWatch: 00:00:00.000')",
            "StopWatch StopWatch.__init__ StopWatch.__str__ StopWatch.desc",
        ),
        Check("w.is_started, w.value_ms, w.value_secs", "(False, 0, 0.0)", "StopWatch.is_started"),
        Check("w.start(); time.sleep(1.5); w.stop()", "None"),
        Check(
            "w.value_ms, w.value_secs, w.value_hms, w.hms_str",
            "(1500, 1.5, (0, 0, 1, 500), '00:00:01.500')",
            "StopWatch.start StopWatch.stop StopWatch.value_ms StopWatch.value_secs StopWatch.value_hms "
            "StopWatch.hms_str",
        ),
        Check("w.stop(), w.value_ms", "(None, 1500)"),
        Check("w.start(); time.sleep(61.25)"),
        Check("w.hms_str, w.is_started", "('00:01:01.250', True)", "StopWatch.start"),
        Check("w.start()", "StopWatchAlreadyStartedException", "StopWatchAlreadyStartedException"),
        Check(
            "w.is_elapsed_ms(61_000), w.is_elapsed_ms(61_300), w.is_elapsed_ms(None)",
            "(True, False, False)",
            "StopWatch.is_elapsed_ms",
        ),
        Check(
            "w.is_elapsed_secs(61), w.is_elapsed_secs(62), w.is_elapsed_secs(None)",
            "(True, False, False)",
            "StopWatch.is_elapsed_secs",
        ),
        Check("w.restart(), w.is_started, w.value_ms", "(None, True, 0)", "StopWatch.restart"),
        Check(
            "time.sleep(1), w.reset(), w.is_started, w.value_ms",
            "(None, None, False, 0)",
            "StopWatch.reset",
        ),
        Check("a = get_ticks_ms(); time.sleep(0.25); b = get_ticks_ms()"),
        Check("round(b - a)", "250", "get_ticks_ms"),
    ),
)

ROOT = Table(
    "ev3dev2",
    "import ev3dev2\nfrom ev3dev2 import *\nfrom ev3dev2 import auto, version",
    (
        Check(
            "ev3dev2.__version__, version.__version__",
            "('2.1.0.post1', '2.1.0.post1')",
            "__version__ ev3dev2.version:__version__",
        ),
        Check("is_micropython()", "False", "is_micropython"),
        Check(
            "ev3dev2.chain_exception(KeyError('a'), ValueError('b'))",
            "KeyError: 'a'",
            "chain_exception",
        ),
        Check(
            "'nonsense' in ev3dev2.library_load_warning_message('nonsense', 'Thing')",
            "True",
            "library_load_warning_message",
        ),
        Check(
            "Device('tacho-motor', address='outD')",
            "DeviceNotFound: Device(outD) is not connected.",
            "DeviceNotFound Device Device.__init__",
        ),
        Check("raise DeviceNotDefined('x')", "DeviceNotDefined: x", "DeviceNotDefined"),
        Check("raise ThreadNotRunning('x')", "ThreadNotRunning: x", "ThreadNotRunning"),
        Check(
            "get_current_platform(), auto.platform",
            "('ev3', 'ev3')",
            "get_current_platform ev3dev2.auto:platform",
        ),
        Check(
            "list(list_device_names('/sys/class/tacho-motor', '*'))",
            "['motor0', 'motor1']",
            "list_device_names",
        ),
        Check(
            "[d.device_index for d in list_devices('lego-sensor', '*')]",
            "[0, 1, 2, 3]",
            "list_devices Device.device_index",
        ),
    ),
)
