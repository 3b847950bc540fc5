"""Write the golden files with the code that is installed.

They are written by the code that others are compared with, not by what is compared. To write them again, copy this
folder into a folder `tests/config` elsewhere, and call `python -m tests.config.golden.make` there with the Python of a
checkout of that code; then copy the files back. `settings` or `programs` writes one of the two.
"""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

from tests.config.golden import outside
from tests.config.golden.borders import border_cases
from tests.config.golden.broken import broken_cases
from tests.config.golden.cases import PROGRAM, Case, built_in_cases, random_cases
from tests.config.golden.fixture import GOLDEN, Golden, checksum_of, flat, in_folder, recorded
from tests.config.golden.programs import PROGRAMS, RUNS, run_golden, write_runs


def every_case() -> Iterator[Case]:
    """Yield all cases."""
    return chain(built_in_cases(), border_cases(), random_cases(), broken_cases())


def write_settings(folder: Path) -> None:
    """Do all cases, and write what comes of them."""
    cases = list(every_case())
    os.environ["TUISIM_HOME"] = str(folder / "home")
    with outside.nothing_starts():
        places = (Path(tempfile.mkdtemp(dir=folder)) for _ in range(len(cases) + 1))
        case = Case("plain", ("run", "p.py"), {"p.py": PROGRAM})
        with in_folder(next(places), case):
            plain = flat(outside.of_command(case.words).runs[0]["spec"])
        outcomes = {case.name: recorded(case, next(places), plain) for case in cases}
    assert len(outcomes) == len(cases), "two cases have one name"
    Golden(plain, checksum_of(cases), outcomes).write()
    print(f"{len(cases)} cases, {GOLDEN.stat().st_size} bytes")


def write_programs(folder: Path) -> None:
    """Run all programs, and write what they give."""
    runs: dict[str, Any] = {}
    (folder / "cache").mkdir()
    for name, program in PROGRAMS.items():
        home, place = Path(tempfile.mkdtemp(dir=folder)), Path(tempfile.mkdtemp(dir=folder))
        (home / "cache").symlink_to(folder / "cache")
        os.environ["TUISIM_HOME"] = str(home)
        with contextlib.chdir(place):
            runs[name] = run_golden(program, place)
    write_runs(runs)
    print(f"{len(runs)} programs, {RUNS.stat().st_size} bytes")


if __name__ == "__main__":
    os.environ["COLUMNS"] = "80"
    os.environ.pop("TUISIM_ASSETS", None)
    writers = {"settings": write_settings, "programs": write_programs}
    for word in sys.argv[1:] or writers:
        with tempfile.TemporaryDirectory() as place:
            writers[word](Path(place))
