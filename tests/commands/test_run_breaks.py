"""`tuisim run --break`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.cli import run_command

PROGRAM = """\
# %%sim_magic_preloaded -b Grey_bands -x 150 -y 500
import time
total = 0
for i in range(3):
    total += i
    print('Total:', total)
    time.sleep(0.1)
"""


@pytest.fixture
def program(tmp_path: Path) -> str:
    """The path of a program."""
    path = tmp_path / "sum.py"
    path.write_text(PROGRAM, encoding="utf-8")
    return str(path)


def test_run_prints_each_breakpoint_that_is_met_and_goes_on(
    program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        run_command(
            ["run", program, "--break", "6 if i == 2", "--watch", "total * 2", "--watch", "nothing"]
        )
        == 0
    )
    out, err = capsys.readouterr()
    assert out.splitlines() == ["Total: 0", "Total: 1", "Total: 3"]
    assert err.splitlines()[:6] == [
        f"break 6 if i == 2 (is true): {program}:6, 0.200 s, tick 20, x 150.00 mm, y 500.00 mm, heading 0.00°",
        "    6 | print('Total:', total)",
        "    total = 3",
        "    i = 2",
        "    total * 2 → 6",
        "    nothing → NameError: name 'nothing' is not defined",
    ]


def test_a_break_may_end_the_run(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["run", program, "--break", "time 0.15", "--break-then", "stop"]) == 3
    out, err = capsys.readouterr()
    assert out.splitlines() == ["Total: 0", "Total: 1"]
    assert "0.150 s, tick 15" in err
    assert "    sleeps until 0.20 s" in err.splitlines()
    assert ": stopped · 0.150 s" in err


@pytest.mark.parametrize(
    "line, said",
    [
        ("99", "'99': line 99 does not exist (the program has 9 lines)"),
        ("8 if total > 1", "'8 if total > 1': no code follows line 8 (the program has 9 lines)"),
    ],
)
def test_a_break_on_no_line_of_code_is_refused(
    line: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "sum.py"
    path.write_text(PROGRAM + "\n# the end\n", encoding="utf-8")
    assert run_command(["run", str(path), "--break", line]) == 2
    out, err = capsys.readouterr()
    assert (out, said in err) == ("", True)


def test_a_break_for_another_robot_is_refused(
    program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["run", program, "--break", "middle.red < 3"]) == 2
    assert "this robot has no 'middle.red' (did you mean left_red?)" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words, said",
    [
        (["--watch", "total"], "watch: needs a breakpoint (add one with --break"),
        (
            ["--break", "6", "--watch", "total["],
            "watch: 'total[' is not an expression: '[' was never closed",
        ),
    ],
    ids=["no break", "no expression"],
)
def test_a_watch_that_would_tell_nothing_is_refused(
    words: list[str], said: str, program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["run", program, *words]) == 2
    out, err = capsys.readouterr()
    assert said in err
    assert out == ""
