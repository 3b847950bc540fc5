"""How long the list of thousands of runs takes, and how soon a long output begins to be shown."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.bench.figures import Figure
from tests.bench.processes import app_environment
from tests.bench.references import starts_elapsed
from tests.bench.running import begin
from tests.bench.sampling import Effort
from tuisim.engine.runs.catalogue import CATALOGUE_FILE
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.run_folder import RUN_FILE

RUNS = 2000
FEW = "import time\nfor n in range(50):\n    print('n:', n)\n    time.sleep(0.1)\n"
MANY = "import time\nfor n in range(400_000):\n    print('n:', n, 'and so on, to make it long')\n"
"""Prints 24 MB."""


def listing(effort: Effort) -> Iterator[Figure]:
    """Yield the time of `runs list` without a catalogue and with one, and of the first byte of `runs show`."""
    with tempfile.TemporaryDirectory() as home:
        _fill(Path(home))
        for which, most in (("the first time", 55), ("again", 22)):
            took_s = _first_byte_s(home, "list")
            yield Figure(
                f"list {RUNS:,} runs, {which}", took_s, "s", most=most, ratio=starts_elapsed(took_s)
            )
    long = begin(MANY, options=RunOptions())
    long.wait()
    took_s = _first_byte_s(os.environ["TUISIM_HOME"], "show", "last")
    yield Figure(
        "show 24 MB of output, first byte", took_s, "s", most=18, ratio=starts_elapsed(took_s)
    )


def _fill(home: Path) -> None:
    """Copy one run many times, without a catalogue."""
    run = begin(FEW, options=RunOptions())
    run.wait()
    for number in range(1, RUNS + 1):
        folder = home / "runs" / f"20260101T000000-{number:06x}"
        shutil.copytree(run.folder, folder)
        data = json.loads((folder / RUN_FILE).read_bytes())
        (folder / RUN_FILE).write_text(json.dumps({**data, "id": folder.name, "number": number}))
    (home / CATALOGUE_FILE).unlink(missing_ok=True)


def _first_byte_s(home: str, *words: str) -> float:
    """Return the time from the start of `tuisim runs …` to its first byte."""
    begun = time.monotonic()
    command = [sys.executable, "-m", "tuisim", "runs", *words]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, env=app_environment(TUISIM_HOME=home)
    ) as process:
        assert process.stdout is not None
        process.stdout.read(1)
        took_s = time.monotonic() - begun
        process.stdout.read()
    return took_s
