"""Cells of CSV: what a spreadsheet would compute is text there, numbers stay numbers, and reading gives back all."""

from __future__ import annotations

import csv
from pathlib import Path

import pandas as pd

from tests.cases import for_each
from tests.conftest import Command
from tuisim.logs.csv_cells import escape_formula
from tuisim.logs.export import export_frame
from tuisim.logs.frames import read_log

FORMULAS = (
    "=cmd|' /C calc'!A0",
    "+SUM(A1)",
    "-2+3+cmd|' /C calc'!A0",
    "@SUM(1)",
    "\t=1",
    "\r=1",
    "\n=1",
    " =1+1",
    "\uff1d1+1",
    "'=1",
    "-x",
    "-",
)
PLAIN = ("ada", "", "'quoted'", "a = 1", "-5", "+3.25", "-1e-9", "x-1", "print('=')")


@for_each(text=FORMULAS)
def test_a_csv_text_that_looks_like_a_formula_gets_an_apostrophe(text: str) -> None:
    assert escape_formula(text) == f"'{text}"


@for_each(text=PLAIN)
def test_other_texts_and_numbers_stay_as_they_are(text: str) -> None:
    assert escape_formula(text) == text


def test_an_exported_csv_has_no_formulas_and_reads_back_the_same_texts(tmp_path: Path) -> None:
    texts = [*FORMULAS, *PLAIN]
    frame = pd.DataFrame(
        {"=name": texts, "value": [-1.5] * len(texts), "count": range(-3, len(texts) - 3)}
    )
    export_frame(frame, tmp_path / "out.csv", {})
    with (tmp_path / "out.csv").open(newline="", encoding="utf-8") as handle:
        heading, *rows = csv.reader(handle)
    assert (heading[0], rows[0][1:], rows[-1][2]) == ("'=name", ["-1.5", "-3"], str(len(texts) - 4))
    assert [row[0] for row in rows if row[0][:1] in "=+-@\t\r\n"] == ["", "-5", "+3.25", "-1e-9"]
    pd.testing.assert_frame_equal(read_log(tmp_path / "out.csv"), frame, check_dtype=False)


def test_csv_printed_by_log_commands_contains_no_formula(tmp_path: Path, here: Command) -> None:
    (tmp_path / "log.csv").write_text("time,=x,note\n0,1,a\n1,2,b\n2,3,c\n")
    done = here("log", "derive", "log.csv")
    assert (done.returncode, done.stdout.splitlines()[1]) == (0, "0.0,'=x,1.0,1.0"), done.stderr
