"""What it costs until something happens: the help, a program's first line, the app's first paint."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from tests.bench.figures import Figure
from tests.bench.processes import app_environment, command_cpu_s, cpu_s, wait_until_stopped
from tests.bench.references import Ratio, paint_cpu_s, start_cpu_s
from tests.bench.running import begin, started_by_itself
from tests.bench.sampling import Effort, Samples, in_turns
from tests.bench.terminal import Terminal
from tuisim.engine.protocol import Started
from tuisim.engine.runs.handle import RunOptions

STOPS_ITSELF = "import os, signal; os.kill(os.getpid(), signal.SIGSTOP)\n"
"""A program that stands still in its first line, so that the CPU used until then can be read at leisure."""
FEW = "import time\nfor n in range(50):\n    print('n:', n // 10)\n    time.sleep(0.1)\n"
HALF_BLOCK = "▀".encode()


def first_line(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of a program's process until the program's own first line, prelude included."""
    for prelude, goal in (("preloaded", 10.0), ("none", None)):
        samples = in_turns(partial(_first_line_cpu_s, prelude), start_cpu_s, effort)
        yield _start(f"to the first line, prelude {prelude}", samples, goal)


def _start(name: str, samples: Samples, most: float | None) -> Figure:
    return Figure(
        name,
        samples.value * 1e3,
        "ms CPU",
        most=most,
        ratio=Ratio(samples.ratio, "x python -c pass"),
    )


def _first_line_cpu_s(prelude: str) -> float:
    with started_by_itself():
        handle = begin(STOPS_ITSELF, prelude=prelude, options=RunOptions())
    try:
        while True:
            handle.wait_for_event(1.0)
            for event in handle.pump():
                if isinstance(event, Started):
                    wait_until_stopped(event.pid)
                    return cpu_s(event.pid)
                raise AssertionError(f"the program did not stop itself: {event}")
    finally:
        handle.close()


def help_text(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of `tuisim --help`."""
    yield _start(
        "tuisim --help",
        in_turns(lambda: command_cpu_s("-m", "tuisim", "--help"), start_cpu_s, effort),
        6,
    )


def commands(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of commands that have little to do: nothing to run, one run to list, a short log."""
    with tempfile.TemporaryDirectory() as home:
        environment = app_environment(TUISIM_HOME=home)
        for name, text in (("few.py", FEW), ("none.py", "")):
            Path(home, name).write_text(text, encoding="utf-8")
        run = partial(command_cpu_s, "-m", "tuisim", environment=environment)
        run("run", f"{home}/few.py")
        for words, most in (
            ("runs list", 11),
            ("log bands 1", 28),
            ("log plot 1", 35),
            (f"run {home}/none.py", 24),
        ):
            samples = in_turns(partial(run, *words.split()), start_cpu_s, effort)
            yield _start(f"tuisim {words.replace(f'{home}/', '')}", samples, most)


def first_paint(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of the app until its panels, and until the mat in the world, are on the screen."""
    for name, text, most in (("panels", b"World", None), ("world", HALF_BLOCK, 3.6)):
        samples = in_turns(partial(_first_paint_cpu_s, text), paint_cpu_s, effort)
        ratio = Ratio(samples.ratio, "x minimal app")
        yield Figure(f"first paint, {name}", samples.value * 1e3, "ms CPU", most=most, ratio=ratio)


def _first_paint_cpu_s(text: bytes) -> float:
    with Terminal(["-b", "Grey_bands"]) as terminal:
        terminal.read_until(lambda: text in terminal.seen)
        return cpu_s(terminal.pid)


def imports(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of `import tuisim`, and of `%load_ext tuisim` beyond pandas and IPython."""
    shell = "from IPython.core.interactiveshell import InteractiveShell as S; import pandas; s = S.instance()"
    for name, before, added, goal in (
        ("import tuisim", "pass", "import tuisim", 1.0),
        ("%load_ext tuisim, beyond pandas", shell, "s.run_line_magic('load_ext', 'tuisim')", 1.0),
    ):
        samples = in_turns(partial(_added_cpu_s, before, added), start_cpu_s, effort)
        yield _start(name, samples, goal)


def _added_cpu_s(before: str, added: str) -> float:
    """Return the CPU seconds of some code after other code, as its process tells them."""
    script = f"import time; {before}; begun = time.process_time(); {added}; print(time.process_time() - begun)"
    command = [sys.executable, "-c", script]
    return float(
        subprocess.run(command, env=app_environment(), stdout=subprocess.PIPE, check=True).stdout
    )
