"""Time that stands in two columns or goes back is put in order, and each place is told."""

from __future__ import annotations

from pathlib import Path

from tests.cases import cases
from tests.logs.log_cases import Case, Read, check_input, times, values


def red(*times_s: float, note: str = "") -> Read:
    return Read(len(times_s), note=note, check=lambda log: times(log) == list(times_s))


CASES: dict[str, Case] = {
    "two runs": (
        "a.csv",
        b"time,red\n0,5\n1,6\n0,7\n1,8\n",
        Read(
            4,
            ("red #1", "red #2"),
            note="time begins again in row 3 of the table: 2 runs",
            check=lambda log: values(log, "red #2") == [7, 8],
        ),
    ),
    "two runs of a program's lines": (
        "a.txt",
        b"[0.0] red: 5\n[1.0] red: 6\n[0.0] red: 7\n[1.0] red: 8\n",
        Read(4, ("red #1", "red #2"), check=lambda log: values(log, "red #2") == [7, 8]),
    ),
    "one variable after the other": (
        "a.csv",
        b"time,variable,value\n0,red,5\n1,red,6\n0,blue,7\n1,blue,8\n",
        Read(4, ("red", "blue")),
    ),
    "midnight": (
        "a.csv",
        b"time,red\n23:59:58,5\n23:59:59,6\n00:00:00,7\n",
        red(86398, 86399, 86400, note="in row 3 of the table: a day is added"),
    ),
    "a counter of microseconds": (
        "a.csv",
        b"time_us,red\n4294000000,5\n4294900000,6\n832704,7\n",
        Read(
            3,
            note="in row 3 of the table: 2³² is added",
            check=lambda log: round(times(log)[2] - times(log)[0], 6) == 1.8,
        ),
    ),
    "whole numbers in large steps": (
        "a.csv",
        b"time,red\n0,5\n20,6\n40,7\n",
        red(0, 0.02, 0.04, note="read as milliseconds (--unit selects another)"),
    ),
    "seconds and nanoseconds": (
        "a.csv",
        b"stamp.secs,stamp.nsecs,red\n1704424261,900000000,5\n1704424262,400000000,6\n",
        red(0, 0.5),
    ),
    "seconds and microseconds": (
        "a.csv",
        b"tv_sec,tv_usec,red\n1,900000,5\n2,400000,6\n",
        red(1.9, 2.4),
    ),
    "date and clock, the first of which are missing": (
        "a.csv",
        b"date,clock,red\n,,5\n2024-01-05,10:00:00,6\n2024-01-05,10:00:02,7\n",
        red(0, 2, note="1 row has no time and is left out: 'date clock' is empty there"),
    ),
    "a date under another name, missing at first": (
        "a.csv",
        b"when,red\n,5\n2024-01-05 10:00:00,6\n2024-01-05 10:00:02,7\n",
        red(0, 2, note="1 row has no time and is left out"),
    ),
    "an empty time in the middle": (
        "a.csv",
        b"time,red\n0,5\n,6\n2,7\n",
        Read(2, note="1 row has no time", check=lambda log: values(log) == [5, 7]),
    ),
    "times that are no numbers": (
        "a.csv",
        b"Time;red\n0,0;1,5\n1,0;2,0\nabc;7,0\nnan;8,0\n3,0;2,5\n4,0;x\n",
        Read(
            4,
            left_out=2,
            note="1 cell of 'Time' is not a number (line 4)",
            check=lambda log: values(log)[:3] == [1.5, 2, 2.5] and times(log) == [0, 1, 3, 4],
        ),
    ),
    "a clock that begins again after a row without a time": (
        "a.csv",
        b"time,red\n23:59:58,5\n,6\n00:00:00,7\n",
        red(86398, 86400, note="in row 2 of the table: a day is added"),
    ),
    "few dates are remarks": (
        "a.csv",
        b"red,seen\n5,\n6,\n7,2024-01-05 10:00:02\n",
        red(0, 1, 2),
    ),
    "date and clock": (
        "a.csv",
        b"Datum;Uhrzeit;red\n01.03.2025;23:59:59;5\n02.03.2025;00:00:01;6\n",
        red(0, 2),
    ),
    "dates in a column of any name": (
        "a.csv",
        b"created_at,red\n2025-03-01 12:00:00 UTC,5\n2025-03-01 12:00:03 UTC,6\n",
        red(0, 3),
    ),
    "keys and values": (
        "a.csv",
        b'Timestamp,Key,Value\n0.0,"/left",5\n0.1,"/right",6\n0.2,"/left",7\n',
        Read(3, ("/left", "/right"), check=lambda log: values(log, "/left") == [5, 7]),
    ),
}


@cases("name, content, expected", CASES)
def test_time_that_goes_back_is_put_in_order(
    tmp_path: Path, name: str, content: bytes, expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)
