"""What a program prints, and how much of it is kept."""

from __future__ import annotations

import pytest

from tests.running import Run


@pytest.mark.slow
def test_a_million_printed_lines_are_all_stored(run: Run) -> None:
    done = run("for i in range(1_000_000): print('A:', i)", time_limit_s=60.0)
    assert done.ended.end == "finished"
    assert len(done.lines) == 1_000_000
    assert done.lines[-1] == "A: 999999"


@pytest.mark.slow
def test_more_than_256_mib_of_output_end_the_run(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    done = run("x = 'y' * 10_000_000\nwhile True: print(x)")
    assert (done.ended.end, done.ended.error_line) == ("output_limit", 2)
    assert "256 MiB" in done.ended.summary


@pytest.mark.slow
def test_more_than_a_million_printed_lines_end_the_run(run: Run) -> None:
    done = run("import os\nwhile True: os.write(1, b'\\n' * 10_000)")
    assert (done.ended.end, done.ended.error_line) == ("output_limit", 2)
    assert done.ended.summary == "the program printed more than 1,000,000 lines and 1,000 a second"
