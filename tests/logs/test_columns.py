"""Logs of other programs: which column is the time, what is a heading, and what is unpacked."""

from __future__ import annotations

import bz2
import io
import lzma
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.logs.log_cases import Case, Read, check_input, times, values

CSV = b"time,red\n0,1\n1,2\n"
TWO = Read(2, check=lambda log: (times(log), values(log)) == ([0, 1], [1, 2]))
NS = 1_700_000_000_000_000_000
ZEEK = (
    "#separator \\x09\n#set_separator\t,\n#empty_field\t(empty)\n#unset_field\t-\n#path\tconn\n#open\t2026-01-01\n"
    "#fields\tts\tuid\tred\n#types\ttime\tstring\tinterval\n1300475167.25\tCx\t1.5\n1300475168.25\tCy\t-\n#close\t2026-01-01\n"
)


def dates(name: str, per_s: int) -> bytes:
    return f"{name},red\n{NS // 10**9 * per_s},1\n{NS // 10**9 * per_s + per_s},2\n".encode()


def since_1970(unit: str) -> Read:
    return Read(2, note=f"are {unit} since 1970", check=TWO.check)


def savetxt() -> bytes:
    sink = io.BytesIO()
    np.savetxt(sink, np.array([[0.0, 1.0], [1.0, 2.0]]), header="time red")
    return sink.getvalue()


def arrow_stream() -> bytes:
    sink = io.BytesIO()
    table = pa.table({"time": [0.0, 1.0], "red": [1.0, 2.0]})
    with pa.ipc.new_stream(sink, table.schema) as writer:
        writer.write_table(table)
    return sink.getvalue()


def arrow_date64() -> bytes:
    # From noon to a minute after it.
    ms = np.array([43_200_000, 43_260_000], np.int64)
    moments = pa.Array.from_buffers(pa.date64(), 2, [None, pa.py_buffer(ms)])
    sink = io.BytesIO()
    table = pa.table({"date": moments, "red": [1.0, 2.0]})
    with pa.ipc.new_file(sink, table.schema) as writer:
        writer.write_table(table)
    return sink.getvalue()


def zipped() -> bytes:
    sink = io.BytesIO()
    with zipfile.ZipFile(sink, "w") as archive:
        archive.writestr("a.csv", CSV)
    return sink.getvalue()


CASES: dict[str, Case] = {
    "nanoseconds since 1970": ("a.csv", dates("time", 10**9), since_1970("nanoseconds")),
    "microseconds since 1970": ("a.csv", dates("time", 10**6), since_1970("microseconds")),
    "milliseconds since 1970": ("a.csv", dates("timestamp", 10**3), since_1970("milliseconds")),
    "seconds since 1970": ("a.csv", dates("t", 1), since_1970("seconds")),
    "unit in brackets": ("a.csv", b"Time [ms],red\n0,1\n1000,2\n", TWO),
    "unit after a slash": ("a.csv", b"t/ms,red\n0,1\n1000,2\n", TWO),
    "brick clock": ("a.csv", b"red,brick clock (ms)\n1,0\n2,1000\n", TWO),
    "only a unit of time": ("a.csv", b"red,since start [ms]\n1,0\n2,1000\n", TWO),
    "unit at the end": ("a.csv", b"timestamp_ms,red\n0,1\n1000,2\n", TWO),
    "unit as the name": ("a.csv", b"millis,red\n0,1\n1000,2\n", TWO),
    "a word of the name": ("a.csv", b"Time Stamp,red\n0,1\n1,2\n", TWO),
    "a number of frames": (
        "a.csv",
        b"Framenumber,red\n5,1\n9,2\n",
        Read(2, ("Framenumber", "red")),
    ),
    "a position": ("a.csv", b"position,red\n5,1\n9,2\n", Read(2, ("position", "red"))),
    "x beside others": ("a.csv", b"x,red\n5,1\n9,2\n", Read(2, ("x", "red"))),
    "a line of a program": ("a.csv", b"time,x_mm,line\n0,5,3\n1,6,4\n", Read(2, ("x_mm",))),
    "a time that is a value": ("a.csv", b"lap_time,red\n5,1\n4,2\n", Read(2, ("lap_time", "red"))),
    "comments above the heading": ("a.csv", b"# made by hand\n# twice\n" + CSV, TWO),
    "the heading is a comment": ("a.csv", b"# a log\n# time,red\n0,1\n1,2\n", TWO),
    "the heading begins with the sign": ("a.csv", b"#" + CSV, TWO),
    "as numpy saves it": ("a.txt", savetxt, TWO),
    "as Zeek writes it": ("conn.log", ZEEK.encode(), "is a Zeek log, which"),
    "a heading that is called fields": (
        "a.csv",
        b"# log\n#fields,red\n0,1\n1,2\n",
        Read(2, ("fields", "red")),
    ),
    "colours are no comments": (
        "a.csv",
        b"time,colour,red\n0,#ff0000,1\n1,#00ff00,2\n",
        Read(2, check=TWO.check),
    ),
    "rows of names and numbers": ("a.csv", b"a,9,2\nb,1,3\n", Read(2, ("column 2", "column 3"))),
    "quoted carriage returns": (
        "a.csv",
        b'time,said,red\r0,"a\rb",1\r1,c,2\r',
        Read(2, check=lambda log: log.table.column("said").to_pylist() == ["a\nb", "c"]),
    ),
    "bars around text with commas": (
        "a.log",
        b"time|tag|id|text\n0|x|1|a, b, c, d, e\n1|x|2|a, b, c, d|e, f\n"
        b"2|x|1|a, b, c, d, e\n3|x|2|a, b, c, d|e, f\n",
        Read(4, ("id",), 2, check=lambda log: values(log, "id") == [1, 2, 1, 2]),
    ),
    "an Arrow stream": ("a.arrows", arrow_stream, TWO),
    "an Arrow stream that was cut off": ("a.arrows", lambda: arrow_stream()[:-60], "no rows"),
    "dates of 64 bits": ("a.arrow", arrow_date64, "has a column of Arrow's type date64"),
    "bzip2": ("a.csv.bz2", bz2.compress(CSV), TWO),
    "two bzip2 files in one": ("a.csv.bz2", bz2.compress(CSV[:15]) + bz2.compress(CSV[15:]), TWO),
    "bzip2 cut off": (
        "a.csv.bz2",
        bz2.compress(CSV)[:-20],
        "no rows: the compressed file is truncated",
    ),
    "xz": ("a.csv.xz", lzma.compress(CSV), "is an xz file, which cannot be read"),
    "zstd": ("a.csv.zst", pa.compress(CSV, "zstd", asbytes=True), TWO),
    "zstd cut off": (
        "a.csv.zst",
        pa.compress(CSV, "zstd", asbytes=True)[:-4],
        "no rows: the compressed file is truncated",
    ),
    "lz4": ("a.csv.lz4", pa.compress(CSV, "lz4", asbytes=True), "is an lz4 file"),
    "a ZIP archive": ("a.zip", zipped, "is a ZIP archive"),
    "an HDF5 file": ("a.h5", b"\x89HDF\r\n\x1a\n" + bytes(100), "is an HDF5 file"),
}


@cases("name, content, expected", CASES)
def test_the_time_column_of_another_programs_log_is_found(
    tmp_path: Path, name: str, content: bytes | Callable[[], bytes], expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)


@pytest.mark.parametrize(
    "text, said",
    [
        (
            "t_ms,red\n0,1\n9,2\n",
            "time is the column 't_ms', in milliseconds (--time COLUMN selects another",
        ),
        ("boot,red\n0,1\n9,2\n", "no time column: row numbers from 0 are used (--time COLUMN"),
        ("row,red\n1,1\n2,2\n", "no time column: row numbers from 0 are used (--time COLUMN"),
    ],
    ids=["a name", "none", "numbers of rows"],
)
def test_the_shell_says_which_column_is_the_time(
    here: Command, tmp_path: Path, text: str, said: str
) -> None:
    (tmp_path / "a.csv").write_text(text)
    assert said in here("log", "summary", "a.csv").stderr
