"""Lines that programs print: every sample is read, the first one too, with its time."""

from __future__ import annotations

from pathlib import Path

from tests.cases import cases
from tests.logs.log_cases import Case, Read, check_input, times, values

VALUE = "column 2"


def two(first_s: float, second_s: float, names: tuple[str, ...] = (VALUE,), note: str = "") -> Read:
    return Read(
        2,
        names,
        note=note,
        check=lambda log: (
            (times(log, names[0]), values(log, names[0])) == ([first_s, second_s], [5, 6])
        ),
    )


CASES: dict[str, Case] = {
    "day first in brackets": (
        "a.log",
        b"[07-04-2023 / 16:02:52] : 5\n[07-04-2023 / 16:03:00] : 6\n",
        two(0, 8, note="no header"),
    ),
    "under another name": (
        "a.csv",
        b"[07-04-2023 / 16:02:52] : 5\n[07-04-2023 / 16:03:00] : 6\n",
        two(0, 8),
    ),
    "one line": (
        "a.txt",
        b"[07-04-2023 / 16:02:52] : 5\n",
        Read(1, (VALUE,), check=lambda log: values(log, VALUE) == [5]),
    ),
    "a title above": (
        "a.txt",
        b"EV3 log\n[07-04-2023 / 16:02:52] : 5\n[07-04-2023 / 16:03:00] : 6\n",
        Read(
            2,
            (VALUE,),
            0,
            "1 line above the table not read (line 1)",
            lambda log: values(log, VALUE) == [5, 6],
        ),
    ),
    "a heading above": (
        "a.txt",
        b"time: red\n[07-04-2023 / 16:02:52] : 5\n[08-04-2023 / 16:02:52] : 6\n",
        two(0, 86400, ("red",)),
    ),
    "names before the values": (
        "a.txt",
        b"[07-04-2023 / 16:02:52] Colour: 5\n[07-04-2023 / 16:02:54] Colour : 6\nbye\n",
        Read(2, ("Colour",), 1, check=lambda log: times(log, "Colour") == [0, 2]),
    ),
    "seconds in brackets before names": (
        "a.txt",
        b"[0.5] Colour: 5\n[1.0] Colour: 6\n",
        two(0.5, 1, ("Colour",)),
    ),
    "seconds and a colon": ("a.txt", b"0.5: 5\n1.0: 6\n", two(0.5, 1)),
    "year first and a colon": (
        "a.txt",
        b"2023-04-07 16:02:52: 5\n2023-04-07 16:02:53.5: 6\n",
        two(0, 1.5),
    ),
    "year first and blanks": (
        "a.txt",
        b"2023/04/07 16:02:52 5\n2023/04/08 16:02:52 6\n",
        two(0, 86400, ("column 3",)),
    ),
    "time of day": ("a.txt", b"16:02:52 5\n16:02:53 6\n", two(57772, 57773)),
    "time of day in brackets": ("a.txt", b"[16:02:52]5\n[16:02:53]6\n", two(57772, 57773)),
    "dots": ("a.txt", b"7.4.2023 9:02:52 - 5\n13.4.2023 9:02:52 - 6\n", two(0, 6 * 86400)),
    "month first, as the days show": (
        "a.txt",
        b"04/07/2023 16:02:52 = 5\n04/13/2023 16:02:52 = 6\n",
        two(0, 6 * 86400),
    ),
    "month or day first": (
        "a.txt",
        b"04/07/2023 16:02:52 -> 5\n05/07/2023 16:02:52 -> 6\n",
        two(0, 86400, note="the dates or times in 'time' are read as day, month, year"),
    ),
    "one day, so that its month is of no interest": (
        "a.txt",
        b"4/7/2023 9:59:52: 5\n4/7/2023 10:00:00: 6\n",
        Read(
            2,
            (VALUE,),
            check=lambda log: (
                times(log, VALUE) == [0, 8] and not any("month" in said for said in log.notes)
            ),
        ),
    ),
    "as ctime writes it": (
        "a.txt",
        b"Fri Apr  7 16:02:52 2023: 5\nSat Apr  8 16:02:52 2023: 6\n",
        two(0, 86400),
    ),
    "as logging writes it": (
        "a.log",
        b"2023-04-07 16:02:52,250 INFO root: Colour: 5\n2023-04-07 16:02:53,500  INFO: Colour: 6\n",
        two(0, 1.25, ("Colour",)),
    ),
    "several values": (
        "a.txt",
        b"[16:02:52] 5, -1.5\n[16:02:53] 6, oops\n[16:02:54] 7, 3e2\n",
        Read(2, (VALUE, "column 3"), 1, check=lambda log: values(log, "column 3") == [-1.5, 300]),
    ),
    "a table of blanks": (
        "a.txt",
        b"date time red\n2023-04-07 16:02:52 5\n2023-04-07 16:02:53 6\n",
        two(0, 1, ("red",)),
    ),
    "a table of commas": (
        "a.csv",
        b"16:02:52,5\n16:02:53,6\n",
        two(57772, 57773, note="no header"),
    ),
    "a table of dates without a heading": (
        "a.csv",
        b"07-04-2023 16:02:52,5\n07-04-2023 16:02:53,6\n",
        two(0, 1),
    ),
    "a table of dates and times": (
        "a.csv",
        b"2023-04-07,16:02:52,5\n2023-04-07,16:02:53,6\n",
        two(0, 1, ("column 3",)),
    ),
    "a table of two times": (
        "a.csv",
        b"16:02:52 , 5 , 16:02:50\n16:02:53 , 6 , 16:02:51\n",
        Read(
            2,
            (VALUE,),
            check=lambda log: (
                times(log, VALUE) == [57772, 57773] and log.table.column_names[2] == "column 3"
            ),
        ),
    ),
    "a column of dates, day first": (
        "a.csv",
        b"time,red\n7/4/2023 9:02,5\n7/4/2023 9:03,6\n",
        two(0, 60, ("red",)),
    ),
    "several names in a line": (
        "a.txt",
        b"left: 5 right: 7\nleft: 6 right: 8\n",
        Read(4, ("left", "right"), check=lambda log: values(log, "right") == [7, 8]),
    ),
    "as Arduino's plotter reads them": (
        "a.txt",
        b"left:5\tright:7\terror:-2\nleft:6\tright:8\terror:-2.5\n",
        Read(6, ("left", "right", "error"), check=lambda log: values(log, "error") == [-2, -2.5]),
    ),
    "as Teleplot reads them": (
        "a.txt",
        b">left:1735689600000:5|g\n>left:1735689600500:6|g\n",
        two(0, 0.5, ("left",)),
    ),
    "levels, loggers and several names": (
        "a.log",
        b"2025-03-01 12:00:00,250 INFO left=5 right=7\n2025-03-01 12:00:01,250 INFO left=6 right=8\n",
        Read(4, ("left", "right"), check=lambda log: times(log, "left") == [0, 1]),
    ),
    "a level and a logger without a time": (
        "a.log",
        b"INFO:robot:left=5, right=7\nWARNING:robot:left=6, right=8\n",
        Read(4, ("left", "right"), check=lambda log: values(log, "left") == [5, 6]),
    ),
    "a prompt, bars and units": (
        "a.txt",
        b"> [main] left = 5 mm | speed: 7 %\n> [main] left = 6 mm | speed: 8 %\n",
        Read(4, ("left", "speed"), check=lambda log: values(log, "speed") == [7, 8]),
    ),
    "words that are an error": ("a.txt", b"error: 5\nerror: 6\n", Read(2, ("error",))),
    "tuples": (
        "a.txt",
        b"(0.0, 5, 7)\n(0.5, 6, 8)\n",
        Read(
            2,
            (VALUE, "column 3"),
            check=lambda log: (times(log, VALUE), values(log, VALUE)) == ([0, 0.5], [5, 6]),
        ),
    ),
    "dictionaries": (
        "a.txt",
        b"{'time': 0, 'left': 5, 'on': None}\n{'time': 1, 'left': 6, 'on': None}\n",
        Read(2, ("left", "on"), check=lambda log: values(log, "left") == [5, 6]),
    ),
    "lists": (
        "a.txt",
        b"[5, 7]\n[6, 8]\n",
        Read(2, (VALUE,), check=lambda log: values(log, VALUE) == [7, 8]),
    ),
    "dates as names of columns": (
        "a.csv",
        b"name,2023-04-07,2023-04-08\na,5,1\nb,6,2\n",
        Read(2, ("2023-04-07", "2023-04-08")),
    ),
}


@cases("name, content, expected", CASES)
def test_every_printed_sample_is_read(
    tmp_path: Path, name: str, content: bytes, expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)
