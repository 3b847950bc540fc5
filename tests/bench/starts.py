"""What it costs until something happens: the help, a program's first line, the app's first paint."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

from tests.bench.figures import Effort, Figure
from tests.bench.processes import command_cpu_s, cpu_s, wait_until_stopped
from tests.bench.references import bare_start, paints, starts
from tests.bench.running import begin, started_by_itself
from tests.bench.terminal import Terminal
from tuisim.protocol import Started
from tuisim.runs.handle import RunOptions

STOPS_ITSELF = "import os, signal; os.kill(os.getpid(), signal.SIGSTOP)\n"
"""A program that stands still in its first line, so that the CPU used until then can be read at leisure."""
HALF_BLOCK = "▀".encode()


def first_line(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of a program's process until the program's own first line, prelude included."""
    for prelude, goal in (("preloaded", 7.0), ("none", None)):
        value = median(_first_line_cpu_s(prelude) for _ in range(effort.repeats))
        yield Figure(f"to the first line, prelude {prelude}", value * 1e3, "ms CPU", most=goal, ratio=starts(value))
    yield Figure("bare Python, for comparison", bare_start().cpu_s * 1e3, "ms CPU")


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
    value = median(command_cpu_s("-m", "tuisim", "--help") for _ in range(effort.repeats))
    yield Figure("tuisim --help", value * 1e3, "ms CPU", most=12, ratio=starts(value))


def first_paint(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of the app until its panels, and until the mat in the world, are on the screen."""
    both = [_first_paint_cpu_s() for _ in range(effort.repeats)]
    panels, world = (median(values) for values in zip(*both, strict=True))
    yield Figure("first paint, panels", panels * 1e3, "ms CPU", ratio=paints(panels))
    yield Figure("first paint, world", world * 1e3, "ms CPU", most=3.3, ratio=paints(world))


def _first_paint_cpu_s() -> tuple[float, float]:
    with Terminal(["-b", "Grey_bands"]) as terminal:
        terminal.read_until(lambda: b"World" in terminal.seen)
        panels = cpu_s(terminal.pid)
        terminal.read_until(lambda: HALF_BLOCK in terminal.seen)
        return panels, cpu_s(terminal.pid)


def imports(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU of `import tuisim`, and of `%load_ext tuisim` beyond pandas and IPython."""
    shell = "from IPython.core.interactiveshell import InteractiveShell as S; import pandas; s = S.instance()"
    for name, before, added, goal in (
        ("import tuisim", "pass", "import tuisim", 2.5),
        ("%load_ext tuisim, beyond pandas", shell, "s.run_line_magic('load_ext', 'tuisim')", 7),
    ):
        bare = median(command_cpu_s("-c", before) for _ in range(effort.repeats))
        whole = median(command_cpu_s("-c", f"{before}; {added}") for _ in range(effort.repeats))
        yield Figure(name, (whole - bare) * 1e3, "ms CPU", most=goal, ratio=starts(whole - bare))
