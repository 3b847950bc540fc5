"""`tuisim batch`: programs over many seeds and settings, and a table of the results."""

from __future__ import annotations

import math
import shutil
import time
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tuisim import __version__
from tuisim.base.errors import counted
from tuisim.base.faults import UNJUDGED, report_file
from tuisim.batch.sweep import Sweep
from tuisim.batch.table import RUN_ID, ColumnSummary, Row
from tuisim.commands import exit_status
from tuisim.commands.batch_request import OPTIONS, Request, read_request
from tuisim.commands.echo import (
    FigureCell,
    Progress,
    draw_table,
    echo,
    echo_error,
    echo_json,
    echo_lines,
    echo_written,
    replace_infinite,
    tell,
)
from tuisim.commands.exit_status import Interrupted, raise_signals
from tuisim.commands.listings import list_names
from tuisim.engine.protocol import End
from tuisim.logs.signals import QUANTILES
from tuisim.settings.command_line import Arguments, command
from tuisim.settings.shared_options import build_shared_options
from tuisim.tasks.goals.judgement import GOAL

if TYPE_CHECKING:
    import pandas as pd

MAX_LINES = 100
"""A summary has at most this many lines."""
_MAX_REASONS = 5
"""The most reasons of failures in a summary; the most frequent ones are listed."""
_MAX_OVERLAID = 4
"""The most stored runs that the example of a command names."""
_ROUNDING = 1e-10
"""A smaller pose, time or reading differs from 0 only by rounding."""


@command(
    *OPTIONS,
    # There is no speed, as a batch runs as fast as possible.
    *build_shared_options(without_app=True, left_out=("speed",), names=list_names),
    passes_arguments=True,
    instead=dict.fromkeys(
        ("--picture", "--picture-of"),
        "seaborn draws the table of --out, see `tuisim guide experiments`",
    ),
    help="""Run programs with many seeds and settings; print or write one row per run.

    SPEC.toml is a file with a table [batch], whose keys are named like the options; options on the command line take
    precedence. The rows are in the order of the parameters, and are the same for any number of jobs.

    Exit code: the highest of all runs, as for `tuisim run`; 2 bad input, 130 interrupted.
    """,
    epilog="""\b
    Examples:
      tuisim batch drive.py --seeds 0..199 --set noise.motor=0,20,50
      tuisim batch drive.py --set robot.wheel_diameter_mm=54:58:0.5 --out d.csv
    """,
)
def batch(**given: Any) -> int:
    """Run the batch and return its exit code.

    Raises:
        ConfigError: a program, a parameter, a goal, an expression or an option is wrong; nothing was run.
        ExportError: the table cannot be written; checked before anything is run.
        KeyboardInterrupt: ctrl-C; the rows of finished runs have been written.
    """
    arguments = Arguments(**given)
    return _Batch(read_request(arguments), as_json=arguments.as_json).run()


class _Batch:
    """Runs a batch in this process and its workers, and prints the progress and the results."""

    def __init__(self, request: Request, *, as_json: bool) -> None:
        self.request = request
        self.as_json = as_json
        self.sweep = Sweep(
            request.plan, request.expressions, request.out, __version__, resumes=request.resume
        )
        self.rows = self.sweep.rows

    def run(self) -> int:
        """Run the tasks without results, write the table, print the results and return the exit code."""
        plan = self.request.plan
        code = 0
        with Progress(counted(len(plan), "run"), len(plan), in_lines=True):
            try:
                with raise_signals():
                    self.sweep.run(self.request.workers, self._rate())
            except Interrupted as interrupted:
                code = interrupted.exit_code
            frame = self.sweep.build_frame()
            if self.request.out is not None and self.rows:
                tell(f"writing {self.request.out}")
                self.sweep.export(frame)
                echo_written(self.request.out)
        if not code:
            self.sweep.finish()
        self._print(frame)
        if any(str(row["summary"]).startswith(UNJUDGED) for row in self.rows.values()):
            echo_error(f"tuisim: the report of what went wrong is in {report_file()}")
        if code:
            self._tell_interrupted()
        return max([code, *map(_exit_code, self.rows.values())])

    def _rate(self) -> Any:
        """Return a function to call after each run, which shows how many are finished, their rate and the time left."""
        total, before, begun = len(self.request.plan), len(self.rows), time.monotonic()

        def tell_row(_: Row) -> None:
            done = len(self.rows)
            per_s = (done - before) / max(time.monotonic() - begun, 1e-9)
            left = f"{per_s:.3g} per second, {_format_duration((total - done) / per_s)} left"
            tell(f"{done:,} of {counted(total, 'run')}, {left}", done, total)

        return tell_row

    def _print(self, frame: pd.DataFrame) -> None:
        if self.as_json:
            for row in frame.to_dict("records"):
                echo_json(replace_infinite(row))
        elif self.rows:
            self._print_summary(frame)

    def _print_summary(self, frame: pd.DataFrame) -> None:
        ends = Counter(
            str(row["end"]).replace("_", " ") or "not started" for row in self.rows.values()
        )
        echo(
            f"{counted(len(frame), 'run')}: {', '.join(f'{count:,} {end}' for end, count in ends.most_common())}"
        )
        reasons = Counter(
            str(row["summary"]) for row in self.rows.values() if _exit_code(row) and row["summary"]
        )
        for reason, count in reasons.most_common(_MAX_REASONS):
            echo(f"  {count:,} × {reason}")
        for goal in self.request.plan.goals:
            if (name := f"{GOAL}{goal.name}") in frame:
                met = int(frame[name].fillna(0).sum())
                echo(
                    f"{goal.name}: met in {met:,} of {len(frame):,} ({100 * met / len(frame):.0f} %)"
                )
        lines = self.sweep.summarize(frame)
        echo_lines(_format_summary(lines[:MAX_LINES], shutil.get_terminal_size().columns))
        if len(lines) > MAX_LINES:
            echo(f"and {len(lines) - MAX_LINES:,} more lines; --out FILE writes everything")
        is_constant = all(line.statistics.std < _ROUNDING for line in lines)
        if is_constant and len(frame) > 1 and self.request.plan.count_seeds() > 1:
            echo_error(
                "note: every seed gave the same results; they differ with noise: -N for light, -M for motors"
            )
        run_ids = [str(row[RUN_ID]) for row in self.rows.values() if RUN_ID in row]
        if run_ids:
            command = f"tuisim analyse {' '.join(run_ids[:_MAX_OVERLAID])}{' …' * (len(run_ids) > _MAX_OVERLAID)}"
            echo(
                f"{counted(len(run_ids), 'run')} stored, in column {RUN_ID} of the table: {command}"
            )

    def _tell_interrupted(self) -> None:
        out = self.request.out
        remark = f"; {out} has these rows, and --resume continues" if out and self.rows else ""
        echo_error(
            f"tuisim: interrupted after {len(self.rows):,} of {counted(len(self.request.plan), 'run')}{remark}"
        )


def _format_summary(lines: Sequence[ColumnSummary], width: int) -> str:
    """Return a summary as text; if it is wider than `width` characters, with fewer quantiles or none."""
    text = ""
    for quantiles in (QUANTILES, QUANTILES[1:-1], ()):
        heads = [
            "COLUMN",
            *(lines[0].group if lines else ()),
            "MEAN",
            "STD",
            "MIN",
            *(f"Q{100 * part:g}" for part in quantiles),
            "MAX",
        ]
        cells = []
        for line in lines:
            of = line.statistics
            chosen = [of.quantiles[QUANTILES.index(part)] for part in quantiles]
            figures = map(_round_figure, (of.mean, of.std, of.min, *chosen, of.max))
            cells.append([line.column, *line.group.values(), *figures])
        text = draw_table(heads, cells)
        if max(map(len, text.split("\n"))) <= width:
            break
    return text


def _exit_code(row: Row) -> int:
    if not row["end"]:
        return exit_status.EXIT_BAD_OUTPUT
    return exit_status.choose_exit_code(End(row["end"]), row["exit_code"])


def _round_figure(value: float) -> FigureCell:
    """Return a number as a table cell with four digits; a tiny number from rounding errors becomes 0."""
    return FigureCell(0.0 if abs(value) < _ROUNDING else value, ".4g")


def _format_duration(seconds: float) -> str:
    """Return a duration in words: `12 s`, `3 min 5 s`, `2 h 10 min`."""
    whole = math.ceil(seconds)
    minutes, rest = divmod(whole, 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
