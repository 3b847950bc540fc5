"""Tables in a terminal that is too narrow for them."""

from __future__ import annotations

import pytest

from tuisim.commands.echo import table

BANDS = (
    ("VARIABLE", "NUMBER", "START S", "STOP S", "SAMPLES", "LEVEL", "TRUE LEVEL", "SPREAD", "GREY", "WIDTH MM"),
    [("Colour", 1, "0.02", "0.54", 27, "100.00", "100.00", "0.00", "light grey", 185)],
)
WORDS = (
    ("NAME", "DOES"),
    [("square.py", "Drive a square with the pen down, and come back to where it has begun.")],
)
LONG_NAME = (("NAME", "AT"), [("x" * 100, "2026-11-23 16:35:43")])


@pytest.fixture(autouse=True)
def _terminal_of_80(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)


@pytest.mark.parametrize(("heads", "rows"), [BANDS, WORDS, LONG_NAME], ids=["bands", "words", "long name"])
def test_a_table_fits(heads: tuple[str, ...], rows: list[tuple[object, ...]]) -> None:
    assert max(map(len, table(heads, rows).split("\n"))) <= 80


def test_words_stay_whole() -> None:
    shown = table(*WORDS).split()
    assert shown[shown.index("Drive") :] == WORDS[1][0][1].split()


def test_dates_stay_whole_where_a_name_is_too_long() -> None:
    assert table(*LONG_NAME).splitlines()[1].endswith("x… 2026-11-23 16:35:43".replace("… ", "…  "))


def test_a_pipe_gets_every_table_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: False)
    assert table(*BANDS).splitlines()[0].split("  ")[0] == "VARIABLE"
    assert len(table(*WORDS).splitlines()) == 2
