"""Commands in words: each value has its unit."""

from __future__ import annotations

from math import nan

from tests.cases import for_rows
from tuisim.engine.core.commands.calls import MAX_VALUES, Call
from tuisim.engine.core.commands.robot import encode_parts
from tuisim.engine.core.commands.table import CALLS
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.runs.command_words import CALL_WORDS, describe_command

PARTS = encode_parts(
    [PluggedPart("outA", "MediumMotor", 5, 1), PluggedPart("in3", "GyroSensor", 5, 1)]
)
WORDS = {
    "a speed": (Call.RUN, (500.0,), "run 500 °/s"),
    "until a tick": (Call.RUN_UNTIL, (-90.5, 250.0), "run -90.5 °/s until 2.5 s"),
    "a goal": (Call.RUN_TO, (360.0, 300.0, 0.0), "run to 360° at 300 °/s"),
    "set points": (
        Call.RUN_TO_REL_POS,
        (300.0, 90.0, 0.0, 0.0, 0.0, 0.0, 2.0),
        "run-to-rel-pos 90° at 300 °/s, then hold",
    ),
    "a time": (
        Call.RUN_TIMED,
        (300.0, 0.0, 0.0, 1500.0, 0.0, 0.0, 0.0),
        "run-timed 1500 ms at 300 °/s, then coast",
    ),
    "a constant": (Call.SET_CONSTANT, (1.0, 0.0, 80.0), "set hold kp 80"),
    "counts of the firmware": (Call.MOVE, (720.0, 1000.0, 3200.0, 1.0), "run by 360° at 500 °/s"),
    "without an end": (Call.RUN_AT, (400.0, 3200.0, nan, 2.0), "run 200 °/s"),
    "for a time": (Call.RUN_AT, (400.0, 3200.0, 2e6, nan), "run 200 °/s for 2 s"),
    "thousandths of a count": (Call.SET_MILLI, (180_000.0,), "set angle 90°"),
    "a power": (Call.RUN_FREELY, (-5000.0,), "power -50 %"),
    "no power": (Call.RUN_FREELY, (nan,), "coast"),
    "a way": (Call.MOVE_BASE, (300.0, 90.0, 3.0), "drive 300 mm, turn 90°, then go on"),
    "a setting": (Call.SET_CONTROL, (4.0, 500.0), "set kp 500"),
    "parts": (Call.PLUG, PARTS, "plug in MediumMotor outA, GyroSensor in3"),
    "the pen": (Call.MOVE_PEN, (1.0,), "down"),
}


@for_rows("call, values, text", WORDS)
def test_each_recorded_command_is_described_in_words(
    call: Call, values: tuple[float, ...], text: str
) -> None:
    filler = nan if call is Call.PLUG else 0.0
    record = (*values, *(filler,) * (MAX_VALUES - len(values)))
    main = record[CALL_WORDS[call].main]
    assert describe_command(call, record, main, main, 100) == text


def test_a_repeated_command_is_described_with_its_least_and_greatest_value() -> None:
    assert describe_command(Call.RUN, (300.0,), -90.0, 480.0, 100) == "run -90 … 480 °/s"


def test_each_call_has_words_that_fit_its_values() -> None:
    assert CALL_WORDS.keys() == CALLS.keys()
    for call, spec in CALLS.items():
        if call is not Call.PLUG:
            values = tuple(0.0 for _ in spec.ranges)
            text = describe_command(call, values, 0.0, 0.0, 100)
            assert text and "{" not in text
            assert len(CALL_WORDS[call].quantities) <= len(values)
