"""What a report says of runs and logs before it comes to their numbers."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from tuisim.core.geometry import shown_heading_deg
from tuisim.core.simulation import NS_PER_S

if TYPE_CHECKING:
    from tuisim.datalog.opening import Log
    from tuisim.datalog.runfile import StoredRun

Fact = tuple[str, ...]
"""What it is, and what it is for each run."""


def run_facts(runs: Sequence[StoredRun]) -> list[Fact]:
    """Return the facts of stored runs; what is nowhere the case is left out."""
    rows = [(name, *(tell(run) for run in runs)) for name, tell in _FACTS.items()]
    return [row for row in rows if any(row[1:])]


def log_facts(log: Log) -> list[Fact]:
    """Return the facts of a log file, and what it says of its runs if it is an export."""
    rows: list[Fact] = [
        ("file", log.title),
        ("rows", f"{log.rows:,}" + (f", and {log.left_out:,} that could not be read" if log.left_out else "")),
        ("columns", ", ".join(log.table.column_names)),
        ("variables", ", ".join(log.names)),
    ]
    entries = log.metadata.get("runs")
    runs = [entry for entry in entries if isinstance(entry, Mapping)] if isinstance(entries, list) else []
    for name, path in _TRAVELLED.items():
        found = [_at(run, path) for run in runs]
        if any(found):
            rows.append((name, ", ".join(dict.fromkeys(found))))
    return rows


_TRAVELLED: Mapping[str, tuple[str, ...]] = {
    "program": ("program", "name"),
    "SHA-256": ("program", "sha256"),
    "mat": ("world", "background"),
    "robot": ("robot", "name"),
    "profile": ("profile", "name"),
    "seed": ("seed",),
    "light noise": ("world", "noise", "light"),
    "motor noise": ("world", "noise", "motor"),
}
"""Where an export says it of a run."""


def _at(entry: Mapping[str, Any], path: Sequence[str]) -> str:
    """What stands at a place, as text; empty if there is no such place."""
    found: Any = entry
    for key in path:
        found = found.get(key, "") if isinstance(found, Mapping) else ""
    return str(found)


def _end(run: StoredRun) -> str:
    state = run.state.replace("_", " ")
    return f"{state}: {run.end.summary}" if run.end and run.end.summary else state


def _time_s(run: StoredRun) -> str:
    last = run.telemetry.last()
    if run.end:
        return f"{run.end.time_ns / NS_PER_S:.3f} s, tick {run.end.tick}"
    return f"{last.tick / run.spec.profile.tick_hz:.3f} s, tick {last.tick}" if last else ""


def _pose(x_mm: float, y_mm: float, heading_deg: float) -> str:
    return f"x {x_mm:.2f} mm, y {y_mm:.2f} mm, heading {shown_heading_deg(heading_deg):.2f}°"


def _start_pose(run: StoredRun) -> str:
    start = run.spec.world.start
    return _pose(start.x_mm, start.y_mm, start.heading_deg)


def _end_pose(run: StoredRun) -> str:
    last = run.telemetry.last()
    return _pose(last.x_mm, last.y_mm, last.heading_deg) if last else ""


def _noise(run: StoredRun) -> str:
    noise = run.spec.world.noise
    changed = any(action.kind == "set_noise" for action in run.actions)
    return f"light {noise.light}, motor {noise.motor}" + (", changed during the run" if changed else "")


_FACTS: Mapping[str, Callable[[StoredRun], str]] = {
    "run": lambda run: f"{run.number or ''} {run.id}".strip(),
    "made": lambda run: run.created[:19].replace("T", " ") + " UTC",
    "program": lambda run: run.program.name,
    "arguments": lambda run: shlex.join(run.program.arguments),
    "SHA-256": lambda run: run.program.sha256,
    "prelude": lambda run: run.program.prelude,
    "mat": lambda run: run.spec.world.background,
    "obstacles": lambda run: f"{len(run.spec.world.obstacles)}" if run.spec.world.obstacles else "",
    "profile": lambda run: run.spec.profile.name,
    "robot": lambda run: run.spec.robot.name,
    "seed": lambda run: str(run.spec.seed),
    "noise": _noise,
    "start": _start_pose,
    "end": _end,
    "end pose": _end_pose,
    "simulated time": _time_s,
    "user actions": lambda run: str(len(run.actions)) if run.actions else "",
    "tags": lambda run: ", ".join(run.tags),
}
"""To add a fact: a line here."""
