"""Damaged, odd and hostile logs: a clear error, or all that can be read and a count of what was left out."""

from __future__ import annotations

import gzip
import io
import math
import os
import threading
from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.cases import cases
from tests.engine.runs.run_recorder import Recorder
from tests.logs.log_cases import Case, Read, check_input, times, values
from tuisim.base.errors import LogError
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.runs.records import HEADER_BYTES, TELEMETRY_FILE
from tuisim.engine.runs.run_folder import read_run
from tuisim.logs.choices import ReadChoices
from tuisim.logs.reader import build_log, build_telemetry_log, open_log

ROWS = "".join(f"{at / 10},{at * 2}\n" for at in range(40))
CSV = "time,red\n" + ROWS


def table(rows: int = 1000) -> pa.Table:
    return pa.table({"time": np.arange(rows) / 10, "red": np.arange(rows) * 2.0})


def twice(rows: int = 1000) -> pa.Table:
    return table(rows).append_column("red", pa.array(np.arange(rows) * 1.0))


def parquet(rows: int = 1000, group: int = 100, make: Callable[[int], pa.Table] = table) -> bytes:
    sink = io.BytesIO()
    pq.write_table(make(rows), sink, row_group_size=group, compression="none", use_dictionary=False)
    return sink.getvalue()


def arrow(rows: int = 1000, batch: int = 100, make: Callable[[int], pa.Table] = table) -> bytes:
    sink = io.BytesIO()
    with pa.ipc.new_file(sink, make(rows).schema) as writer:
        writer.write_table(make(rows), max_chunksize=batch)
    return sink.getvalue()


def holed(data: bytes, at: float, size: int) -> bytes:
    start = int(len(data) * at)
    return data[:start] + b"\xff" * size + data[start + size :]


SOUND = Read(40, check=lambda log: values(log)[:3] == [0, 2, 4] and times(log)[1] == 0.1)
CASES: dict[str, Case] = {
    "sound": ("a.csv", CSV.encode(), SOUND),
    "no newline at the end": ("a.csv", CSV.rstrip().encode(), SOUND),
    "blank lines": ("a.csv", CSV.replace("\n", "\n\n").encode(), SOUND),
    "byte order mark": ("a.csv", b"\xef\xbb\xbf" + CSV.encode(), SOUND),
    "utf-16 with a mark": ("a.csv", CSV.encode("utf-16"), SOUND),
    "utf-16 without a mark": ("a.csv", CSV.encode("utf-16-le"), Read(40, note="UTF-16")),
    "utf-16 the other way round": ("a.csv", CSV.encode("utf-16-be"), Read(40, note="UTF-16")),
    "semicolons and decimal commas": (
        "a.csv",
        CSV.replace(",", ";").replace(".", ",").encode(),
        SOUND,
    ),
    "blanks around cells": ("a.csv", CSV.replace(",", " , ").encode(), SOUND),
    "quoted cells": (
        "a.csv",
        ('"time","red"\n' + ROWS.replace(",", '","').replace("\n", '"\n"')[:-1])
        .replace('\n0.0"', '\n"0.0"')
        .encode(),
        SOUND,
    ),
    "mixed separators": (
        "a.csv",
        (CSV + "9.9;5\n4.0,80\n").encode(),
        Read(41, left_out=1, note="1 line is not a row (line 42)"),
    ),
    "short rows": ("a.csv", (CSV + "4.0\n4.1,82\n").encode(), Read(42, left_out=1, note="line 42")),
    "long rows": (
        "a.csv",
        (CSV + "4.0,80,1,2\n4.1,82\n").encode(),
        Read(42, left_out=1, note="1 row has too"),
    ),
    "words among numbers": (
        "a.csv",
        CSV.replace(",20\n", ",oops\n").encode(),
        Read(40, left_out=1, note="1 cell of 'red' is not a number (line 12"),
    ),
    "many words among numbers": (
        "a.csv",
        CSV.replace(",2", ",x2").encode(),
        Read(40, left_out=6, note="lines 3, 12, 13"),
    ),
    "a line of blanks and words in one column": (
        "a.csv",
        b"red\n5\n  \n6\noops\n7\n",
        Read(5, left_out=1, note="1 cell of 'red' is not a number (line 5"),
    ),
    "empty cells": (
        "a.csv",
        CSV.replace(",20\n", ",\n").encode(),
        Read(40, check=lambda log: math.isnan(values(log)[10])),
    ),
    "words for nothing": (
        "a.csv",
        CSV.replace(",20\n", ",NA\n").encode(),
        Read(40, check=lambda log: math.isnan(values(log)[10])),
    ),
    "not a number and infinity": (
        "a.csv",
        (CSV + "4.0,nan\n4.1,-inf\n4.2,Infinity\n").encode(),
        Read(
            43,
            note="2 values of 'red' are infinite",
            check=lambda log: values(log)[41:] == [-math.inf, math.inf],
        ),
    ),
    "null bytes": (
        "a.csv",
        CSV.replace(",20", ",\x0020").encode(),
        Read(40, note="null bytes", check=lambda log: values(log)[10] == 20),
    ),
    "a quote that is never closed": (
        "a.csv",
        (CSV + '4.0,"80\n4.1,82\n').encode(),
        Read(42, left_out=1, check=lambda log: values(log)[41] == 82),
    ),
    "a quoted line break": (
        "a.csv",
        (CSV + '4.0,"80\n"\n4.1,82\n').encode(),
        Read(42, check=lambda log: values(log)[-2:] == [80, 82]),
    ),
    "two columns of one name": (
        "a.csv",
        ("time,red,red\n" + ROWS.replace("\n", ",7\n")).encode(),
        Read(40, ("red", "red (2)"), note="two columns"),
    ),
    "a column without a name": (
        "a.csv",
        ("time,red,\n" + ROWS.replace("\n", ",7\n")).encode(),
        Read(40, ("red", "column 3")),
    ),
    "no heading": ("a.csv", ROWS.encode(), Read(40, ("column 2",), note="no header")),
    "latin-1": (
        "a.csv",
        CSV.replace("red", "gr\u00fcn").encode("latin-1"),
        Read(40, ("gr\u00fcn",), note="Windows-1252"),
    ),
    "rubbish in the middle": (
        "a.csv",
        CSV.encode() + b"\x80\x81\xfe\n5.0,99\n",
        Read(41, left_out=1, check=lambda log: values(log)[-1] == 99),
    ),
    "formulas for a spreadsheet": (
        "a.csv",
        (CSV + "4.0,=cmd|'/c calc'!A1\n4.1,@SUM(1)\n").encode(),
        Read(42, left_out=2),
    ),
    "huge whole numbers": (
        "a.csv",
        (CSV + "4.0,123456789012345678901234567890\n").encode(),
        Read(41, check=lambda log: values(log)[-1] > 1e29),
    ),
    "times that go back": (
        "a.csv",
        (CSV + "1.0,5\n").encode(),
        Read(
            41,
            note="time goes back in row 41 of the table",
            check=lambda log: times(log)[-1] == 1.0,
        ),
    ),
    "dates": (
        "a.csv",
        b"time,red\n2026-01-01T10:00:00.25,1\n2026-01-01T10:00:01.75,2\n",
        Read(2, check=lambda log: times(log) == [0, 1.5]),
    ),
    "spans of time": (
        "a.csv",
        b"time,red\n0 days 00:00:01.5,1\n1 days 00:00:00,2\n",
        Read(2, check=lambda log: times(log) == [1.5, 86400]),
    ),
    "one column": ("a.csv", b"red\n5\n6\n7\n", Read(3, check=lambda log: times(log) == [0, 1, 2])),
    "only words": (
        "a.csv",
        b"name,colour\nana,red\nbo,blue\n",
        Read(2, (), note="text, not numbers: 'name', 'colour'"),
    ),
    "nothing": ("a.csv", b"", "no rows"),
    "only blank lines": ("a.csv", b"\n\n  \n", "no rows"),
    "only a heading": ("a.csv", b"time,red\n", "no rows"),
    "a line of 100 MB": (
        "a.csv",
        lambda: CSV.encode() + b"7" * (100 << 20) + b"\n4.0,80\n",
        "line 42 is longer than 1 MiB",
    ),
    "nothing but a line of 100 MB": (
        "a.csv",
        lambda: b"x" * (100 << 20),
        "line 1 is longer than 1 MiB",
    ),
    "a picture": ("a.csv", b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40, "is a PNG picture"),
    "random bytes": ("a.csv", Random(1).randbytes(5000), "is not a text"),
    "a picture in a compressed file": ("a.csv.gz", gzip.compress(b"\x89PNG\r\n"), "only text"),
    "compressed": ("a.csv.gz", gzip.compress(CSV.encode()), SOUND),
    "compressed and cut off": (
        "a.csv.gz",
        lambda: gzip.compress(CSV.encode() + ROWS.encode() * 400, 1)[:-40],
        Read(-1, note="truncated"),
    ),
    "compressed rubbish": ("a.csv.gz", b"\x1f\x8b" + b"rubbish" * 9, "no rows"),
    "parquet": ("a.parquet", parquet, Read(1000, check=lambda log: values(log)[999] == 1998)),
    "parquet under another name": ("a.csv", parquet, Read(1000)),
    "parquet cut off": ("a.parquet", lambda: parquet()[:-300], "truncated"),
    "parquet, only its magic": ("a.parquet", b"PAR1", "Parquet"),
    "parquet with a hole": (
        "a.parquet",
        lambda: holed(parquet(), 0.0022, 30),
        Read(900, left_out=100, note="rows are damaged"),
    ),
    "parquet without rows": ("a.parquet", lambda: parquet(0), "no rows"),
    "parquet with two columns of one name": (
        "a.parquet",
        lambda: parquet(make=twice),
        Read(
            1000,
            ("red", "red (2)"),
            note="two columns",
            check=lambda log: values(log, "red (2)")[2] == 2,
        ),
    ),
    "arrow": ("a.arrow", arrow, Read(1000, check=lambda log: values(log)[999] == 1998)),
    "arrow cut off": ("a.arrow", lambda: arrow()[: len(arrow()) // 2], Read(-1, note="truncated")),
    "arrow, only its magic": ("a.arrow", b"ARROW1\0\0", "Arrow"),
    "arrow without rows": ("a.arrow", lambda: arrow(0), "no rows"),
    "json lines": (
        "a.jsonl",
        b'{"time": 0.0, "red": 1}\n{"time": 0.5, "red": 2.5}\n',
        Read(2, check=lambda log: values(log) == [1, 2.5]),
    ),
    "json lines, some broken": (
        "a.jsonl",
        b'{"time": 0.0, "red": 1}\n{"time": 0.5, "re\n[1, 2]\nnull\n{"time": 1.0, "red": 3}\n',
        Read(2, left_out=3, note="not JSON objects"),
    ),
    "json lines with words among numbers": (
        "a.jsonl",
        b'{"time": 0, "red": 1}\n{"time": 1, "red": "x"}\n{"time": 2, "red": 5}\n',
        Read(3, left_out=1, note="1 cell of 'red' is not a number (line 2"),
    ),
    "json lines with other columns each": (
        "a.jsonl",
        b'{"time": 0, "red": 1}\n{"time": 1, "blue": 4}\n',
        Read(2, ("red", "blue")),
    ),
    "json with halves of characters": (
        "a.jsonl",
        b'{"time": 0, "\\ud800": 1, "": 2, "said": "\\udfff"}\n{"time": 1, "\\ud800": 3, "": 4}\n',
        Read(2, ("\\ud800", "(no name)"), check=lambda log: values(log, "(no name)") == [2, 4]),
    ),
    "cells of several lines": (
        "a.csv",
        b'time,said,red\n0,"two\n\nlines, ""so""",3\n1,x,4\n2,"y\n",5\n',
        Read(
            3,
            check=lambda log: (
                values(log) == [3, 4, 5]
                and log.table.column("said")[0].as_py() == 'two\n\nlines, "so"'
            ),
        ),
    ),
    "quotes that are inches": (
        "a.csv",
        b'time,red,size\n0,1,"5\n1,2,x\n2,3,6"\n3,4,"7\n4,5,8"\n',
        Read(5, check=lambda log: values(log) == [1, 2, 3, 4, 5]),
    ),
    "quotes without end": (
        "a.csv",
        b"time,red,said\n" + b"".join(b'%d,%d,"x\n' % (at, at) for at in range(3000)),
        Read(3000, check=lambda log: values(log)[-1] == 2999),
    ),
    "a json array": ("a.json", b'[{"time": 0, "red": 1}, {"time": 1, "red": 2}]', Read(2)),
    "a json array with an object a line": (
        "a.json",
        b'[\n {"time": 0, "red": 1},\n {"time": 1, "red": 2}\n]\n',
        Read(2),
    ),
    "truths in json": (
        "a.jsonl",
        b'{"on": true}\n{"on": false}\n',
        Read(2, ("on",), check=lambda log: values(log, "on") == [1, 0]),
    ),
    "truths": (
        "a.csv",
        b"time,on\n0,True\n1,false\n2,\n" + b"4,TRUE\n" * 50_000 + b"5,maybe\n",
        Read(
            50_004,
            ("on",),
            1,
            "1 cell of 'on' is not a number",
            lambda log: values(log, "on")[:2] == [1, 0],
        ),
    ),
    "times that cannot be read": (
        "a.csv",
        b"time,red\nnoon,1\none,2\n",
        Read(2, note="'time' cannot be read"),
    ),
    "json nested without end": (
        "a.jsonl",
        b"[" * 100_000 + b'\n{"time": 0, "red": 1}\n',
        Read(1, left_out=1),
    ),
    "printed lines": (
        "a.txt",
        b"Colour: 98.8\nhello\nColour: 45\nUltrasonic: 3\n",
        Read(3, ("Colour", "Ultrasonic"), left_out=1, note="1 line is not a sample (line 2"),
    ),
    "few printed lines among other words": (
        "a.txt",
        b"says: hi\nColour: 98.8\nleft, then right\nhello\nColour: 45\nDist = 4\nbye\n",
        Read(3, ("Colour", "Dist"), left_out=4, note="4 lines are not samples (lines 1, 3, 4"),
    ),
    "a table below lines that look printed": (
        "a.txt",
        b"Samples: 3\nRate: 10\n0 5\n1 6\n2 7\n",
        Read(-1, check=lambda log: "Rate" not in log.names),
    ),
    "printed lines with times": (
        "a.log",
        b"Colour: 98.8 0.5\nColour: 45 1.5\n",
        Read(2, ("Colour",), check=lambda log: times(log, "Colour") == [0.5, 1.5]),
    ),
    "long frame of two runs": (
        "a.csv",
        b"time,variable,value,run\n0,A,1,1\n1,A,2,1\n0,A,3,2\n",
        Read(3, ("A #1", "A #2"), check=lambda log: values(log, "A #2") == [3]),
    ),
}


@pytest.mark.slow_cases("a line of 100 MB", "nothing but a line of 100 MB")
@cases("name, content, expected", CASES)
def test_each_damaged_or_odd_log_is_read_or_refused_as_expected(
    tmp_path: Path, name: str, content: bytes | Callable[[], bytes], expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)


@pytest.mark.parametrize(
    "make, expected",
    [(lambda path: None, "no such file"), (lambda path: path.mkdir(), "folder")],
    ids=["no file", "a folder"],
)
def test_a_file_that_is_no_log_is_refused(
    tmp_path: Path, make: Callable[[Path], None], expected: str
) -> None:
    make(tmp_path / "a.csv")
    with pytest.raises(LogError, match=expected):
        open_log(tmp_path / "a.csv")


def test_a_log_from_a_pipe_is_read_until_the_pipe_closes(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)

    def write() -> None:
        with pipe.open("wb") as handle:
            for line in CSV.encode().splitlines(keepends=True):
                handle.write(line)
                handle.flush()

    writer = threading.Thread(target=write)
    writer.start()
    log = open_log(pipe)
    writer.join()
    assert log.rows == 40


@pytest.mark.parametrize(
    "time, columns, expected",
    [
        ("tme", (), "did you mean 'time'"),
        (None, ("blue",), "no column 'blue'"),
        (None, ("word",), "not numeric"),
    ],
    ids=["time", "value", "words"],
)
def test_choosing_a_missing_or_text_column_is_refused_with_a_hint(
    tmp_path: Path, time: str | None, columns: tuple[str, ...], expected: str
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("time,red,word\n0,1,a\n1,2,b\n")
    with pytest.raises(LogError, match=expected):
        open_log(path, ReadChoices(time=time, value=columns))


def test_chosen_columns_of_a_log_are_used_as_time_and_values(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("n,clock_ms,red,blue\n0,100,1,5\n1,200,2,6\n")
    log = open_log(path, ReadChoices(time="clock_ms", value=("blue",)))
    assert log.names == ("blue",)
    assert times(log, "blue") == [0.1, 0.2]


@pytest.mark.parametrize(
    "content", [parquet(), arrow(), gzip.compress(CSV.encode())], ids=["parquet", "arrow", "gzip"]
)
def test_a_pipe_that_brings_anything_but_text_is_refused(
    content: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))
    with pytest.raises(LogError, match="only text can be read from a pipe"):
        open_log("-")


def test_reading_a_log_from_closed_standard_input_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("sys.stdin", None)
    with pytest.raises(LogError, match="is closed"):
        open_log("-")


def test_damaged_telemetry_records_are_not_noted_for_a_log_of_samples(
    record: Callable[..., Recorder], noisy_spec: RunSpec
) -> None:
    recorder = record(noisy_spec)
    recorder.drive(300, 300, 20)
    recorder.print("Colour: 5")
    folder = recorder.end().folder
    path = folder / TELEMETRY_FILE
    content = bytearray(path.read_bytes())
    np.frombuffer(content, list(TICK_FIELDS), offset=HEADER_BYTES)["x_mm"][3] = math.nan
    path.write_bytes(content)
    run = read_run(folder)
    note = f"{TELEMETRY_FILE}: 1 of 21 records is damaged and left out"
    assert (build_telemetry_log(run).notes, build_log([run]).notes) == ((note,), ())
