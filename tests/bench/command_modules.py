"""How many modules commands and a key walk through: `python -m tests.bench.command_modules FILE WORD…`.

The command runs the words as one of tuisim, and writes to the file what its main thread has done, as JSON: of the
whole command or, of one that opens the app, from drawing a frame to drawing the next, anew with each frame.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median

from tests.bench.back import press, settle
from tests.bench.figures import Figure
from tests.bench.frame_modules import run_app
from tests.bench.module_moves import MoveCounter, Walk
from tests.bench.processes import ROOT, app_environment
from tests.bench.running import begin
from tests.bench.sampling import Effort
from tests.bench.terminal import Terminal
from tuisim.base.atomic import replacing
from tuisim.cli import run_command
from tuisim.engine.runs.handle import RunOptions

SAMPLES = """\
import time
tank_drive.on(SpeedPercent(10), SpeedPercent(20))
for _ in range(51):
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
"""
MARKED = ("log_greys.py", "read_once.py")
KEYS_A_REPEAT = 3
OPEN = "open"
COMMAND = (sys.executable, "-m", "tests.bench.command_modules")


def command_modules(effort: Effort) -> Iterator[Figure]:
    """Yield calls and changes of module of an export, a marking and a tick back in the app."""
    run_id = begin(SAMPLES, "Grey_bands", options=RunOptions()).run_id
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        yield from _count(
            "an export of 51 samples",
            160,
            walk_command(place, "log", "export", run_id, "--out", str(place / "samples.csv")),
        )
        classroom = place / "class"
        classroom.mkdir()
        for name in MARKED:
            shutil.copy(ROOT / "programs" / name, classroom)
        goals = str(ROOT / "programs" / "log_greys_goals.toml")
        words = ("--seeds", "0,1", "--jobs", "1", "--keep", "all")
        marks = str(place / "marks.html")
        yield from _count(
            "a marking of two programs with two seeds",
            9_300,
            walk_command(place, "mark", goals, str(classroom), *words, "--export", marks),
        )
    after_keys = walk_ticks_back(run_id, KEYS_A_REPEAT * effort.repeats)
    calls, moves = (
        median(sum(getattr(walk, name) for walk in after_key) for after_key in after_keys)
        for name in ("calls", "moves")
    )
    yield Figure("calls of a tick back", calls, "")
    yield Figure("changes of module in a tick back", moves, "", most=1700)


def _count(name: str, most_moves: int, walk: Walk) -> Iterator[Figure]:
    yield Figure(f"calls of {name}", walk.calls, "")
    yield Figure(f"changes of module in {name}", walk.moves, "", most=most_moves)


def walk_command(place: Path, *words: str) -> Walk:
    """Return what a command of tuisim does in its main thread."""
    file = place / "walk.json"
    subprocess.run(
        [*COMMAND, str(file), *words],
        env=app_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        check=True,
    )
    return read_walks(file)[0]


def walk_ticks_back(run_id: str, count: int) -> list[list[Walk]]:
    """Return what the app does for each frame after a key with which a stored run goes back by a tick."""
    after_keys = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "walks.json"
        with Terminal([str(file), OPEN, "--run", run_id, "-c"], COMMAND) as terminal:
            terminal.read_until(lambda: terminal.queries > 1)
            settle(terminal)
            for _ in range(count):
                begin = len(read_walks(file))
                press(terminal, b",")
                settle(terminal)
                after_keys.append(read_walks(file)[begin:])
    return after_keys


class KeyWalks:
    """Counts what is done for each frame, from the one before.

    Args:
        file: Where all of it is written after each frame.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._walks: list[Walk] = []
        self._counter = MoveCounter()

    def drawn(self) -> None:
        """A frame is drawn: the walk for it has ended, and another begins."""
        self._walks.append(self._counter.stop())
        write_walks(self._file, self._walks)
        self._counter = MoveCounter()
        self._counter.start()


def write_walks(file: Path, walks: Sequence[Walk]) -> None:
    """Write walks as JSON."""
    with replacing(file) as handle:
        handle.write(json.dumps(list(map(asdict, walks))).encode())


def read_walks(file: Path) -> list[Walk]:
    """Return what `write_walks` has written."""
    return [Walk(**walk) for walk in json.loads(file.read_text())]


def main(file: str, *words: str) -> int:
    """Run the command, and count."""
    if words[0] == OPEN:
        return run_app(words, KeyWalks(Path(file)).drawn)
    counter = MoveCounter()
    counter.start()
    code = run_command(words)
    write_walks(Path(file), [counter.stop()])
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
