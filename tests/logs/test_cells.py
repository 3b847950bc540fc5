"""Numbers are read as people and instruments write them; a guess is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.logs.log_cases import Case, Read, check_input, values
from tuisim.logs.choices import ReadChoices
from tuisim.logs.reader import open_log


def red(*numbers: float, note: str = "", left_out: int = 0) -> Read:
    return Read(
        len(numbers),
        left_out=left_out,
        note=note,
        check=lambda log: values(log) == list(numbers),
    )


CASES: dict[str, Case] = {
    "quoted decimal commas": (
        "a.csv",
        b'red\n"1,01"\n"2,02"\n"30"\n',
        red(1.01, 2.02, 30, note="'red' have a comma as decimal sign"),
    ),
    "commas between thousands": (
        "a.csv",
        b'red\n"1,000"\n"12,345,678"\n5\n',
        red(1000, 12345678, 5, note="'red' have commas between thousands"),
    ),
    "three decimals behind a semicolon": ("a.csv", b"red;x\n1,000;a\n1,5;b\n", red(1, 1.5)),
    "points between thousands": (
        "a.csv",
        b"red;blue\n1.000;0,5\n2.500;1,5\n",
        Read(2, ("red", "blue"), check=lambda log: values(log) == [1000, 2500]),
    ),
    "blanks between thousands": ("a.csv", b"x,red\na,1 000\nb,25 000\n", red(1000, 25000)),
    "a unit": ("a.csv", b"x,red\na,12%\nb,7 %\n", red(12, 7, note="'red' have the unit %")),
    "another unit in a cell": (
        "a.csv",
        b"x,red\na,1 V\nb,2 V\nc,3 V\nd,4 mV\n",
        Read(4, left_out=1, note="1 cell of 'red' is not a number (line 5"),
    ),
    "a unit and decimal commas": ("a.csv", b"x;red\na;1,5 mm\nb;2 mm\n", red(1.5, 2)),
    "hexadecimal": ("a.csv", b"x,red\na,0x1F\nb,0x00\n", red(31, 0, note="are hexadecimal")),
    "too large a number": (
        "a.csv",
        b"x,red\na,1\nb,1e400\nc,inf\n",
        Read(3, left_out=1, note="1 value of 'red' is infinite"),
    ),
}


@cases("name, content, expected", CASES)
def test_numbers_in_cells_are_read_as_they_are_written(
    tmp_path: Path, name: str, content: bytes, expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)


@cases("sign, number", {"a point": (".", 1000.0), "a comma": (",", 1.0)})
def test_a_chosen_decimal_sign_decides(tmp_path: Path, sign: str, number: float) -> None:
    path = tmp_path / "a.csv"
    path.write_text('x,red\na,"1,000"\nb,"2,000"\n')
    assert values(open_log(path, ReadChoices(decimal=sign)))[0] == number


@pytest.mark.parametrize("encoding", ["cp1252", "gbk", "shift_jis"])
def test_numbers_of_a_log_are_right_whatever_encoding_is_guessed(
    tmp_path: Path, encoding: str
) -> None:
    words = {"cp1252": "Größe", "gbk": "亮度", "shift_jis": "光ー"}
    path = tmp_path / "a.csv"
    path.write_bytes(f"time;{words[encoding]}\n0;5,5\n1;6,5\n2;7,5\n".encode(encoding))
    log = open_log(path)
    assert values(log, log.names[0]) == [5.5, 6.5, 7.5]
    assert "(--encoding selects another)" in log.notes[0]


@cases(
    "encoding, sign, note",
    {
        "Windows": ("cp1252", "ü", "read as Windows-1252"),
        "Chinese": ("gbk", "亮", ""),
        "Japanese": ("shift_jis", "光", ""),
    },
)
def test_a_guessed_encoding_of_a_log_is_noted_and_a_chosen_one_is_not(
    tmp_path: Path, encoding: str, sign: str, note: str
) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(f"time,{sign}\n0,5\n1,6\n".encode(encoding))
    log = open_log(path, ReadChoices(encoding="" if note else encoding))
    assert values(log, sign) == [5, 6]
    assert note in "; ".join(log.notes)
