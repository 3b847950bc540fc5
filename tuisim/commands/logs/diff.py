"""`tuisim log diff`: where two runs differ."""

from __future__ import annotations

from pathlib import Path

from tuisim.commands.echo import echo_json, echo_lines, table
from tuisim.config.command_line import Arguments
from tuisim.errors import ConfigError
from tuisim.runs.diff import RunDiff, diff_runs, recording_in_words, setup_in_words
from tuisim.runs.store import RunStore


def diff(arguments: Arguments) -> int:
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
    recording, setup = recording_in_words(found), setup_in_words(found)
    pairs = (*recording, *setup) if found.same else (*setup, *recording)
    lines = [f"{label}: {words}" if label else words for label, words in pairs]
    if found.divergence and not found.same:
        rows = [[f"{at:.2f}", f"{mm:.3f}", f"{deg:.3f}"] for at, mm, deg in found.divergence.table]
        lines.append(table(("SECONDS", "APART MM", "HEADING °"), rows))
    return "\n".join(lines)
