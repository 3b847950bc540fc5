"""Tables in a terminal that is too narrow for them."""

from __future__ import annotations

import pytest

from tuisim.commands.echo import draw_table

Table = tuple[tuple[str, ...], list[tuple[object, ...]]]
"""Heads and rows."""

BANDS: Table = (
    (
        "VARIABLE",
        "NUMBER",
        "START S",
        "STOP S",
        "SAMPLES",
        "LEVEL",
        "TRUE LEVEL",
        "SPREAD",
        "GREY",
        "WIDTH MM",
    ),
    [("Colour", 1, "0.02", "0.54", 27, "100.00", "100.00", "0.00", "light grey", 185)],
)
WORDS: Table = (
    ("NAME", "DOES"),
    [("square.py", "Drive a square with the pen down, and come back to where it has begun.")],
)
ROBOTS: Table = (
    ("NAME", "WHEELS", "WEIGHT", "COLOUR SENSORS x, y, diameter", "PORTS"),
    [
        (
            "Sensor_Diameter_Config",
            "56 mm, 180 mm apart",
            6,
            "left -20, 30, 30; right 20, 30, 10",
            "in1 ultrasonic, in2 left, in3 right, in4 gyro, outB left wheel, outC right wheel",
        ),
    ],
)
FILES: Table = (
    ("MAT", "START", "SHOWS"),
    [
        (
            "Junior",
            "1181, 150, 90°",
            "Olympiad 2018, Regular Junior: supply WRO-2018-Regular-Junior.png",
        )
    ],
)
LONG_NAME: Table = (("NAME", "AT"), [("x" * 100, "2026-11-23 16:35:43")])
TABLES: dict[str, Table] = {
    "bands": BANDS,
    "words": WORDS,
    "robots": ROBOTS,
    "files": FILES,
    "long name": LONG_NAME,
}


@pytest.fixture(autouse=True)
def _terminal_of_80(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)


@pytest.mark.parametrize("heads, rows", TABLES.values(), ids=list(TABLES))
def test_a_table_is_at_most_80_columns_wide(
    heads: tuple[str, ...], rows: list[tuple[object, ...]]
) -> None:
    assert max(map(len, draw_table(heads, rows).split("\n"))) <= 80


@pytest.mark.parametrize("name", [name for name in TABLES if name != "long name"])
def test_no_word_of_a_narrow_table_is_broken(name: str) -> None:
    heads, rows = TABLES[name]
    shown = draw_table(heads, rows).split()
    words = [word for row in [heads, *rows] for cell in row for word in str(cell).split()]
    assert sorted(shown) == sorted(words)


def test_a_table_cuts_a_long_name_and_keeps_dates_whole() -> None:
    assert draw_table(*LONG_NAME).splitlines()[1].endswith("x… 2026-11-23 16:35:43")


def test_a_table_written_to_a_pipe_is_not_narrowed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: False)
    assert draw_table(*BANDS).splitlines()[0].split("  ")[0] == "VARIABLE"
    assert len(draw_table(*WORDS).splitlines()) == 2


def test_a_table_too_wide_for_the_terminal_drops_columns_of_equal_values(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    heads, rows = BANDS
    other = ("Colour", 2, "1.67", "1.93", 7, "86.27", "85.50", "1.20", "pale grey", "200")
    table = draw_table(heads, [*rows, other])
    assert "Colour" in table
    monkeypatch.setenv("COLUMNS", "65")
    table = draw_table(heads, [*rows, other])
    assert "Colour" not in table and "86.27" in table
    assert max(map(len, table.split("\n"))) <= 65
