"""Tables of one row."""

from __future__ import annotations

import os
import threading
from pathlib import Path

from tests.cases import cases
from tests.logs.log_cases import Case, Read, check_input, times, values
from tuisim.logs.reader import open_log

BOTH = ("column 1", "column 2")


def row(*cells: float) -> Read:
    return Read(
        1,
        BOTH,
        note="no header",
        check=lambda log: tuple(values(log, name)[0] for name in BOTH) == cells,
    )


CASES: dict[str, Case] = {
    "one row with a heading": (
        "a.csv",
        b"time,red\n0.5,5\n",
        Read(1, check=lambda log: times(log) == [0.5]),
    ),
    "one row of blanks with a heading": ("a.txt", b"time red\n0.5 5\n", Read(1)),
    "one row without a heading": ("a.csv", b"0,5\n", row(0, 5)),
    "one row of blanks": ("a.txt", b"0 5", row(0, 5)),
    "one row of semicolons": ("a.txt", b"0;5,5\n", row(0, 5.5)),
    "one row with a word": (
        "a.csv",
        b"a,5\n",
        Read(1, BOTH[1:], check=lambda log: values(log, BOTH[1]) == [5]),
    ),
    "one number": ("a.txt", b"5\n", Read(1, BOTH[:1])),
    "one sample": ("a.txt", b"Colour: 5\n", Read(1, ("Colour",))),
    "only a heading": ("a.txt", b"time red\n", "no rows"),
}


@cases("name, content, expected", CASES)
def test_a_table_of_one_row_is_read(
    tmp_path: Path, name: str, content: bytes, expected: Read | str
) -> None:
    check_input(tmp_path / name, content, expected)


def test_a_second_line_arriving_later_in_a_pipe_is_read(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)

    def write() -> None:
        with pipe.open("wb") as handle:
            for line in (b"0,5,6\n", b"1,7,8\n"):
                handle.write(line)
                handle.flush()

    writer = threading.Thread(target=write)
    writer.start()
    log = open_log(pipe)
    writer.join()
    assert (log.rows, values(log, "column 3")) == (2, [6, 8])
