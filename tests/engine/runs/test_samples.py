"""Which printed lines are samples."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.engine.core.conditions import ValueCondition, ValueSource
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.samples import (
    Sample,
    describe_near_sample,
    list_samples,
    parse_sample,
    select_rows,
)

SAMPLES = {
    "whole number": ("Ultrasonic: 2550", ("Ultrasonic", 2550.0, None)),
    "decimals": ("Light_left: 86.27450980392157", ("Light_left", 86.27450980392157, None)),
    "negative": ("Gyro: -90", ("Gyro", -90.0, None)),
    "plus sign": ("Gyro: +90", ("Gyro", 90.0, None)),
    "exponent": ("x: 1.5e-07", ("x", 1.5e-07, None)),
    "capital exponent": ("x: 2E3", ("x", 2000.0, None)),
    "no digit before the point": ("x: .5", ("x", 0.5, None)),
    "no digit after the point": ("x: 5.", ("x", 5.0, None)),
    "with a time": ("Wheel_right: 12 3.25", ("Wheel_right", 12.0, 3.25)),
    "with a time and tabs": ("Colour:\t12\t3", ("Colour", 12.0, 3.0)),
    "several blanks": ("Colour:   12", ("Colour", 12.0, None)),
    "no blank": ("Colour:12", ("Colour", 12.0, None)),
    "blanks at the end": ("Colour: 12  ", ("Colour", 12.0, None)),
    "marked": ("^log Colour: 12 1", ("Colour", 12.0, 1.0)),
    "own name": ("_speed2: 1", ("_speed2", 1.0, None)),
    "letters of another language": ("Größe: 1", ("Größe", 1.0, None)),
}
TEXTS = {
    "empty": "",
    "no colon": "Colour 12",
    "no number": "Colour: black",
    "no name": ": 12",
    "name with a blank": "Light left: 12",
    "name that begins with a digit": "2x: 12",
    "blank before the name": " Colour: 12",
    "blank before the colon": "Colour : 12",
    "three numbers": "rgb: 1 2 3",
    "unit after the number": "Colour: 12 mm",
    "comma": "Colour: 1,5",
    "tuple": "rgb: (1, 2, 3)",
    "none": "Colour: None",
    "infinite": "Colour: inf",
    "not a number": "Colour: nan",
    "hexadecimal": "Colour: 0x10",
    "underscores": "Colour: 1_000",
    "digits of another script": "Colour: ١٢",
    "larger than any number": "Colour: 1e999",
    "time larger than any number": "Colour: 1 1e999",
    "lone sign": "Colour: -",
    "two lines": "Colour: 1\nColour: 2",
    "half a mark": "log Colour: 12",
}


@for_rows("text, expected", SAMPLES)
def test_a_printed_name_and_number_is_read_as_a_sample(
    text: str, expected: tuple[str, float, float | None]
) -> None:
    assert parse_sample(text) == expected


@for_rows("text", TEXTS)
def test_printed_text_without_name_and_number_is_no_sample(text: str) -> None:
    assert parse_sample(text) is None


def test_only_printed_rows_are_samples() -> None:
    rows = [
        OutputRow("a: 1", 5, 50_000_000, 3, stream)
        for stream in (Stream.STDOUT, Stream.STDERR, Stream.SPEECH, Stream.INPUT)
    ]
    assert list(list_samples(rows)) == [Sample("a", 1.0, 0.05, 50_000_000, 5, 3)]


def test_a_sample_has_the_time_that_it_prints() -> None:
    (sample,) = list_samples([OutputRow("a: 1 7.5", 5, 50_000_000, 3, Stream.STDOUT)])
    assert (sample.time_s, sample.time_ns) == (7.5, 50_000_000)


@cases(
    "name, sign, value, source, texts",
    {
        "of any name": ("", ">", "2", ValueSource.SAMPLE, ["a: 3", "b: 4"]),
        "of one name": ("a", ">", "2", ValueSource.SAMPLE, ["a: 3"]),
        "a line": ("", "matches", "x$", ValueSource.PRINT, ["max"]),
    },
)
def test_select_rows_gives_the_printed_lines_that_meet_a_condition(
    name: str, sign: str, value: str, source: ValueSource, texts: list[str]
) -> None:
    printed = ("a: 1", "max", "a: 3", "b: 4")
    rows = [OutputRow(text, tick, tick, 1, Stream.STDOUT) for tick, text in enumerate(printed)]
    condition = ValueCondition(name, sign, value, source)
    assert [row.text for row in select_rows(condition, rows)] == texts


@cases(
    "text, sample",
    {
        "two words": ("Angle L: 5", "Angle_L: 5"),
        "two blanks between them": ("Angle  L: 5", "Angle_L: 5"),
        "a unit": ("T: 5 mm", "T: 5"),
        "a rate": ("Speed: -5.5 deg/s", "Speed: -5.5"),
        "a comma": ("Licht: 3,5", "Licht: 3.5"),
        "a blank before the colon": ("Colour : 12", "Colour: 12"),
    },
)
def test_a_line_that_is_nearly_a_sample_is_told_with_the_sample_that_it_may_become(
    text: str, sample: str
) -> None:
    assert parse_sample(sample) is not None
    words = describe_near_sample([OutputRow("Good: 5", 0, 0, 6, Stream.STDOUT), row_of(text)])
    assert words.startswith(f"{text!r} in line 7 is no sample")
    assert words.endswith(f"print {sample!r}")


@cases(
    "text",
    {
        "a sample": "Colour: 5",
        "a sample with a time": "Colour: 5 0.3",
        "a sentence": "The robot has turned: 5 times so far",
        "a number with its largest": "Result: 5 of 7",
        "a time of day": "Time: 12:30",
        "a tuple": "rgb: (1, 2, 3)",
    },
)
def test_ordinary_text_is_not_called_nearly_a_sample(text: str) -> None:
    assert describe_near_sample([row_of(text)]) == ""


def test_every_name_whose_lines_are_nearly_samples_is_told_once() -> None:
    texts = ("Left: 3,5", "Colour  value: 4", "Left: 3,6", "Way: 5 mm", "Good: 5")
    assert describe_near_sample(map(row_of, texts)) == (
        "'Left: 3,5' in line 7, 'Colour  value: 4' in line 7, 'Way: 5 mm' in line 7 are no samples; one is one word, "
        "a colon and a number: print 'Left: 3.5', 'Colour_value: 4', 'Way: 5'"
    )


def row_of(text: str) -> OutputRow:
    return OutputRow(text, 0, 0, 7, Stream.STDOUT)
