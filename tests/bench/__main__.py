"""`python -m tests.bench [NAME…] [--quick] [--json]`: measure, and print one table."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence

from tests.bench.back import back
from tests.bench.bands import bands
from tests.bench.batches import batches
from tests.bench.command_modules import command_modules
from tests.bench.debugging import debugging
from tests.bench.figures import Figure, as_json, as_line, as_table
from tests.bench.frame_modules import frame_modules
from tests.bench.frames import chart, frames
from tests.bench.listing import listing
from tests.bench.logs import logs
from tests.bench.processes import keep_bytecode
from tests.bench.references import usual
from tests.bench.run_key import run_key
from tests.bench.running import EMPTY, begin
from tests.bench.sampling import QUICK, THOROUGH, Effort, MeasuringError
from tests.bench.speed import LOADS, libraries, noise, speeds
from tests.bench.starts import commands, first_line, first_paint, help_text, imports
from tests.bench.stops import stop_latency
from tests.bench.variables import variables
from tests.bench.wire import wire
from tuisim.engine.runs.handle import RunOptions
from tuisim.settings.preferences import keep

BENCHES: Mapping[str, Callable[[Effort], Iterator[Figure]]] = {
    "speed": speeds,
    "noise": noise,
    "libraries": libraries,
    "first-line": first_line,
    "help": help_text,
    "commands": commands,
    "imports": imports,
    "first-paint": first_paint,
    "stop": stop_latency,
    "debugger": debugging,
    "frames": frames,
    "frame-modules": frame_modules,
    "command-modules": command_modules,
    "chart": chart,
    "back": back,
    "variables": variables,
    "logs": logs,
    "bands": bands,
    "listing": listing,
    "wire": wire,
    "batch": batches,
    "run-key": run_key,
}
"""Every bench by name."""


def warm_up() -> None:
    """Prepare the mats and compile the modules once: what is measured is any start but the very first."""
    for mat in {load.mat for load in LOADS.values()}:
        begin(EMPTY, mat, options=RunOptions()).wait()


def main(words: Sequence[str]) -> int:
    """Measure what was asked for and print it; return 1 if something could not be measured.

    A missed goal is a figure, not an error.
    """
    parser = argparse.ArgumentParser(
        prog="python -m tests.bench", description="What running and showing costs."
    )
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"some of {', '.join(BENCHES)}; otherwise all"
    )
    parser.add_argument("--quick", action="store_true", help="measure less often")
    parser.add_argument(
        "--json", action="store_true", help="print a JSON list instead of the table"
    )
    arguments = parser.parse_args(words)
    if unknown := [name for name in arguments.names if name not in BENCHES]:
        parser.error(f"no such bench: {', '.join(unknown)}; one of {', '.join(BENCHES)}")
    found: list[Figure] = []
    failed = False
    keep_bytecode()
    with tempfile.TemporaryDirectory() as home:
        # A home of its own: the runs are thrown away, and the user's catalogue stays as it is.
        os.environ["TUISIM_HOME"] = home
        keep("welcomed", True)
        warm_up()
        for name in arguments.names or BENCHES:
            # Close to the figures that are compared with them.
            usual.cache_clear()
            try:
                for figure in BENCHES[name](QUICK if arguments.quick else THOROUGH):
                    _tell(f"{name}: {as_line(figure)}")
                    found.append(figure)
            except MeasuringError as error:
                _tell(f"{name}: error: {error}")
                failed = True
    print(as_json(found) if arguments.json else as_table(found))
    return int(failed)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
