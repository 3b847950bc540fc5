"""Text files as loggers, instruments, spreadsheets and programs of other people write them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.logs.log_cases import Case, Read, check_input, times, values

_CLOCKS = ["11:59:59 PM", "12:00:00 AM", "12:00:01 AM"]
_OSCILLOSCOPE = "Model,S1\nSource,CH1,CH2\nSecond,Volt,Volt\n0.5,1,2\n1.5,3,4\n2.5,5,6\n"
_LOGGER = """"TOA5","CR1000","CPU:prog"
"TIMESTAMP","RECORD","Air","Hum"
"TS","RN","Deg C","%"
"","","Avg","Smp"
"2024-01-05 00:00:00",0,20.5,40
"2024-01-05 00:01:00",1,20.75,41
"""


def _number_lines(lines: list[str], value: int = 5) -> str:
    """Return a table with a time and a variable in each line."""
    rows = [f"{line},{value + number}\n" for number, line in enumerate(lines)]
    return "when,red\n" + "".join(rows)


TIMES: dict[str, tuple[str, list[float]]] = {
    "a clock of 12 hours": (_number_lines(_CLOCKS), [86399, 86400, 86401]),
    "a date and a clock of 12 hours": (
        _number_lines(["1/15/2024 11:30 AM", "1/15/2024 12:00 PM", "1/15/2024 1:00 PM"]),
        [0, 1800, 5400],
    ),
    "a year of two digits at the end": (
        _number_lines(["05/22/13 11:59:00 PM", "05/23/13 12:01:00 AM", "05/24/13 12:01:00 AM"]),
        [0, 120, 86520],
    ),
    "a year of two digits at the beginning": (
        _number_lines(["24/01/05 23:59:00", "24/01/06 00:01:00", "24/01/07 00:01:00"]),
        [0, 120, 86520],
    ),
    "a month in words": (
        _number_lines(["31-Jan-2024 23:59:59", "01-Feb-2024 00:00:00", "01-Feb-2024 00:00:09"]),
        [0, 1, 10],
    ),
    "a Chinese date": (
        _number_lines(["2024年1月5日 9:59:59", "2024年1月5日 10:00:00", "2024年1月5日10:00:09"]),
        [0, 1, 10],
    ),
    "minutes and seconds": (
        _number_lines(["59:59.5", "60:00.0", "60:07.5"]),
        [3599.5, 3600, 3607.5],
    ),
    "hours and minutes": (_number_lines(["23:58", "23:59", "00:01"]), [86280, 86340, 86460]),
    "a time span of Python": (
        _number_lines(['"0:59:59"', '"1 day, 0:00:00"', '"2 days, 0:00:00.5"']),
        [3599, 86400, 172800.5],
    ),
    "a zone of two digits": (
        _number_lines(
            ["2024-01-05 10:00:00+01", "2024-01-05 10:00:10+01", "2024-01-05 11:00:20+02"]
        ),
        [0, 10, 20],
    ),
    "coloured lines of ESP-IDF": (
        "".join(f"\x1b[0;32mI ({1000 + 50 * n}) main: red={5 + n}\x1b[0m\n" for n in range(3)),
        [1, 1.05, 1.1],
    ),
    "milliseconds after a colon": (
        _number_lines(["10:00:00:000", "10:00:00:250", "10:00:00:500"]),
        [36000, 36000.25, 36000.5],
    ),
    "a time in brackets with its unit": (
        "".join(f"[{250 * n} ms] red={5 + n}\n" for n in range(3)),
        [0, 0.25, 0.5],
    ),
    "objects as Python prints them": (
        "".join(f"Reading(t={n / 2}, red={5 + n})\n" for n in range(3)),
        [0, 0.5, 1],
    ),
    "a rule of underscores": ("  t   red\n ___  ___\n  0  5\n  1  6\n  2  7\n", [0, 1, 2]),
    "a node of ROS": (
        "".join(f"[INFO] [1700000000.{5 + n}] [left_node]: red: {5 + n}\n" for n in range(3)),
        [0, 0.1, 0.2],
    ),
    "X_Value of LabVIEW": ("X_Value\tred\n0.5\t5\n1.0\t6\n1.5\t7\n", [0.5, 1.0, 1.5]),
    "the newest row first": ("time,red\n9,7\n5,6\n2,5\n", [2, 5, 9]),
    "syslog": (
        "".join(f"Jan  5 10:00:0{n} pi robot[81]: red={5 + n}\n" for n in range(3)),
        [36000, 36001, 36002],
    ),
    "a web server": (
        "".join(f"[05/Jan/2024:10:0{n}:00 +0100] red={5 + n}\n" for n in range(3)),
        [0, 60, 120],
    ),
    "a time among the samples": (
        "".join(f"t_ms={100 * n},red={5 + n}\n" for n in range(3)),
        [0, 0.1, 0.2],
    ),
}


@pytest.mark.parametrize("kind", TIMES)
def test_the_time_is_found_in(kind: str, tmp_path: Path) -> None:
    text, expected = TIMES[kind]
    read = Read(
        3, check=lambda log: times(log) == pytest.approx(expected) and values(log) == [5, 6, 7]
    )
    check_input(tmp_path / "a.txt", text.encode(), read)


TABLES: dict[str, Case] = {
    "a rule below the heading": (
        "a.txt",
        b"| time | red |\n| --- | ---: |\n| 0 | 5 |\n| 1 | 6 |\n",
        Read(2, check=lambda log: values(log) == [5, 6]),
    ),
    "a frame": (
        "a.txt",
        b"+---+---+\n| t | red |\n+---+---+\n| 0 | 5 |\n| 1 | 6 |\n| 2 | 7 |\n+---+---+\n",
        Read(3, left_out=1, check=lambda log: values(log) == [5, 6, 7]),
    ),
    "units in words": (
        "a.csv",
        _OSCILLOSCOPE.encode(),
        Read(3, ("CH1 [Volt]", "CH2 [Volt]"), check=lambda log: times(log, "CH1 [Volt]")[0] == 0.5),
    ),
    "settings beside the names": (
        "a.csv",
        b"X,CH1,Start,Increment,\nSequence,Volt,-6e-03,1e-06\n0,5,,\n1,6,,\n2,7,,\n",
        Read(3, ("X [Sequence]", "CH1 [Volt]", "Start", "Increment")),
    ),
    "settings beside the first rows": (
        "a.csv",
        b"Length,3,,-1,5\n,,,0,6\n,,,1,7\n,,,2,8\n",
        Read(
            4,
            ("column 2", "column 3", "column 5"),
            check=lambda log: times(log, "column 5") == [-1, 0, 1, 2],
        ),
    ),
    "names and units in comments": (
        "a.csv",
        b"#time,red\n#(s),(V)\n0,5\n1,6\n",
        Read(2, ("red [V]",), check=lambda log: times(log, "red [V]") == [0, 1]),
    ),
    "a time that is missing among the samples": (
        "a.txt",
        b"t=None,red=4\nt=1,red=5\nt=2,red=6\n",
        Read(2, note="1 row has no time", check=lambda log: times(log) == [1, 2]),
    ),
    "three lines of names, units and kinds": (
        "a.dat",
        _LOGGER.encode(),
        Read(2, ("RECORD [RN]", "Air [Deg C]", "Hum [%]")),
    ),
    "words around each number": (
        "a.txt",
        b"P1: 20.5 V DC\nP1: 21.5 V DC\nP1: 22.5 V DC\n",
        Read(3, ("column 2",), check=lambda log: values(log, "column 2") == [20.5, 21.5, 22.5]),
    ),
    "hexadecimal numbers without 0x": (
        "a.csv",
        b"time,id,red\n0,000001A0,09\n1,000001A1,10\n2,000001A0,0A\n",
        Read(
            3,
            ("id", "red"),
            note="'id', 'red' are hexadecimal",
            check=lambda log: values(log) == [9, 16, 10],
        ),
    ),
    "labels that look hexadecimal": (
        "a.csv",
        b"time,label,red\n0,A1,5\n1,B2,6\n2,C3,7\n",
        Read(3, note="text, not numbers: 'label'"),
    ),
    "the minus sign of print": (
        "a.csv",
        "time,red\n0,\N{MINUS SIGN}5\n1,6\n".encode(),
        Read(2, check=lambda log: values(log) == [-5, 6]),
    ),
    "prices": (
        "a.csv",
        "t;red\n0;5,50 €\n1;6,50 €\n".encode(),
        Read(2, note="have the unit €", check=lambda log: values(log) == [5.5, 6.5]),
    ),
    "Indian thousands": (
        "a.csv",
        b'time,red\n0,"1,23,456"\n1,"99,999"\n',
        Read(2, check=lambda log: values(log) == [123456, 99999]),
    ),
    "a long table of a database": (
        "a.csv",
        b",result,_time,_value,_field\n,,2024-01-05T10:00:00Z,5,red\n,,2024-01-05T10:00:01Z,6,red\n",
        Read(2),
    ),
    "objects in objects": (
        "a.jsonl",
        b'{"t": 0, "imu": {"x": 1, "red": 5}}\n{"t": 1, "imu": {"x": 2, "red": 6}}\n',
        Read(2, ("imu.x", "imu.red"), check=lambda log: values(log, "imu.red") == [5, 6]),
    ),
    "Japanese": (
        "a.csv",
        "時間,電圧\n0,5\n1,6\n".encode("shift_jis"),
        Read(2, ("電圧",), note="Shift-JIS"),
    ),
    "Chinese": ("a.csv", "time,电压\n0,5\n1,6\n".encode("gbk"), Read(2, ("电压",), note="GBK")),
    "a German word with two umlauts in a row": (
        "a.csv",
        "time,Größe\n0,5\n1,6\n".encode("cp1252"),
        Read(2, ("Größe",), note="Windows-1252"),
    ),
}


@pytest.mark.parametrize("kind", TABLES)
def test_the_names_and_numbers_are_right_of(kind: str, tmp_path: Path) -> None:
    name, content, expected = TABLES[kind]
    check_input(tmp_path / name, content, expected)
