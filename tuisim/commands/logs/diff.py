"""`tuisim log diff`: where two runs differ."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from tuisim.commands.echo import echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.errors import ConfigError
from tuisim.runs.diff import RowDifference, RunDiff, TickDifference, diff_runs
from tuisim.runs.store import RunStore


def diff(arguments: Namespace) -> int:
    """Print where two stored runs differ; return 0 if they are the same, else 1.

    Raises:
        ConfigError: not two runs.
        LogError: no such run, or a damaged one.
    """
    words = arguments.words
    if len(words) != 2:
        raise ConfigError("takes two runs", f"got {len(words)}", key="diff")
    store = RunStore()
    first, second = (store.load_run(Path(word) if "/" in word else word) for word in words)
    found = diff_runs(first, second)
    if arguments.json:
        echo_json(found.to_plain())
    else:
        echo_lines(diff_text(found))
    return 0 if found.same else 1


def diff_text(found: RunDiff) -> str:
    """Return a comparison as readable text."""
    if found.same and not found.setup and not found.program:
        return "bit-identical: recording, output, settings"
    lines = ["bit-identical: recording, output"] if found.same else []
    lines += [f"settings, {name}: {left} | {right}" for name, left, right in found.setup]
    lines += found.program
    if found.by_time:
        lines.append("tick rates differ: compared by time, no record is the same")
    lines += [_tick("tick", found.tick)] if found.tick else []
    lines += [_tick("line", found.line)] if found.line else []
    lines += [_row("output row", found.output)] if found.output else []
    lines += [_row("sample", found.sample)] if found.sample else []
    if found.divergence and not found.same:
        apart = found.divergence
        lines.append(
            f"poses: at most {apart.max_mm:.3f} mm apart, at {apart.max_at_s:.2f} s; "
            f"{apart.end_mm:.3f} mm at the common end, {apart.end_s:.2f} s"
        )
        lines += [f"over {limit:g} mm: {'never' if at is None else f'from {at:.2f} s'}" for limit, at in apart.exceeded]
        rows = [[f"{at:.2f}", f"{mm:.3f}", f"{deg:.3f}"] for at, mm, deg in apart.table]
        lines.append(table(("SECONDS", "APART MM", "HEADING °"), rows))
    return "\n".join(lines)


def _tick(what: str, found: TickDifference) -> str:
    how = ", ".join(found.fields) if found.fields else "one recording ends"
    return f"first differing {what}: tick {found.tick}, {found.time_s:.2f} s: {how}"


def _row(what: str, found: RowDifference) -> str:
    sides = zip((found.first, found.second), found.times_s, strict=True)
    left, right = ("no more" if text is None else f"{text!r} at {at:.3f} s" for text, at in sides)
    return f"first differing {what}: {found.row}: {left} | {right}"
