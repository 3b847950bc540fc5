"""What is written below Python's streams is output: in order, as often as it is run, and never without an end."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.runtime.debugging import Driver
from tests.running import Run, Start, over
from tuisim.engine.protocol import Resume
from tuisim.engine.runs.raw_files import RAW_BYTES

MIXED = """\
import ctypes, os, time
c = ctypes.CDLL(None)
print('a', end='')
os.write(1, b'b')
print('c')
c.puts(b'puts')
with open(1, 'w', closefd=False) as f: f.write('opened\\n')
time.sleep(0.5)
os.write(2, b'wrong\\n')
c.printf(b'no end')
"""


@pytest.mark.usefixtures("real_start")
def test_raw_output_is_stored_in_the_order_and_at_the_time_it_was_written(run: Run) -> None:
    done = run(MIXED, prelude="none")
    rows = [
        (row.text, row.stream, row.time_ns, row.line) for row in done.run.output.read_all_rows()
    ]
    assert rows == [
        ("abc", 1, 0, 5),
        ("puts", 1, 0, 8),
        ("opened", 1, 0, 8),
        ("wrong", 2, 500_000_000, 9),
        ("no end", 1, 500_000_000, 0),
    ]


def test_raw_output_larger_than_the_buffer_is_stored_whole(run: Run) -> None:
    size = 2 * RAW_BYTES + 5
    done = run(f"import os\nprint(os.write(1, b'x' * {size}), end='')", prelude="none")
    assert done.lines == ["x" * size + str(size)]


@pytest.mark.slow
def test_an_endless_c_command_ends_once_its_output_is_too_long(run: Run) -> None:
    text = "import ctypes\nctypes.CDLL(None).system(b'yes 0123456789012345678901234567890123456789 2>&1')\nprint('on')"
    done = run(text, prelude="none")
    assert (done.ended.end, done.lines[-1][-2:]) == ("finished", "on")
    assert RAW_BYTES < sum(len(line) + 1 for line in done.lines) < RAW_BYTES + 200


@pytest.mark.slow
def test_raw_output_counts_for_the_limit_of_output(run: Run) -> None:
    done = run(
        "import os\nx = b'y' * (1 << 24) + b'\\n'\nwhile True: os.write(1, x)", prelude="none"
    )
    assert (done.ended.end, done.ended.error_line) == ("output_limit", 3)


def test_a_programs_file_that_reuses_our_descriptor_is_not_taken_for_output(
    run: Run, tmp_path: Path
) -> None:
    text = (
        f"import os\nos.closerange(100, 1024)\nheld = [open({str(tmp_path / 'own.txt')!r}, 'w+') for _ in range(250)]\n"
        "for f in held:\n    f.write('secret')\n    f.flush()\n"
        "os.write(1, b'lost\\n')\nprint({os.lseek(f.fileno(), 0, 1) for f in held})"
    )
    assert run(text, prelude="none").lines == ["{6}"]


def test_output_written_while_inspecting_a_value_is_dropped(start: Start) -> None:
    text = "import os\nclass A:\n    def __repr__(self): return str(os.write(1, b'seen\\n')) + 'A!'\na = A()\npass"
    driver = Driver(start(text, prelude="none", live=True, breaks=("5",)))
    driver.paused()
    assert "A!" in str(driver.look("a"))
    driver.run.send(Resume())
    assert over(driver.run).lines == []
