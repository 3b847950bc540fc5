"""Checks of what needs no device: stop watch, the library's own errors."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

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
