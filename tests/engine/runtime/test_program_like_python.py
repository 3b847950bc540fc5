"""Programs print and end as with Python itself: suggestions, hooks, interrupts, output below Python's streams."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cases import cases
from tests.engine.runtime import python_ends as ends
from tests.engine.runtime import python_errors as errors
from tests.engine.runtime import python_patches as patches
from tests.running import as_python, over
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

PROGRAMS = {
    **errors.SUGGESTIONS,
    **errors.CHAINS,
    **errors.SYNTAX,
    **ends.INTERRUPTS,
    **ends.THREADS,
    **ends.HOOKS,
    **patches.PATCHES,
    **patches.OUTPUT,
}

_ADDRESS = re.compile(r"0x[0-9a-f]{6,}")
_LIBRARY_FRAME = re.compile(
    # A report shows the program's own frames only. Of those of the library: place, source, and carets.
    r'^[ |]*  File "(?!program\.py|helper\.py|\w+\.py|<)[^\n]*\n(?:[ |]*    [^\n]*\n)*',
    re.MULTILINE,
)


def same_for_all(text: str, folder: Path) -> str:
    """Return a text without what may differ: addresses, the folder, frames of the library."""
    text = _LIBRARY_FRAME.sub("", text.replace(f"{folder}/", ""))
    seen: dict[str, str] = {}
    return _ADDRESS.sub(lambda match: seen.setdefault(match[0], f"0x#{len(seen)}"), text)


@pytest.mark.quick_cases(
    "name-*",
    "attr",
    "attr-s*",
    "self-missing",
    "group",
    "group-200",
    "note-name",
    "syntax-indent",
    "sigint*",
    "kbd",
    "thread-exit",
    "thread-raises",
    "thread-bare",
    "excepthook*",
    "gc-callbacks*",
    "settrace-left-raise",
    "patch-*",
    "os-write*",
    "fdopen",
    "ctypes-*",
    "redirect-fd",
    "stderr-to-stdout",
    "print-objects*",
    "print-hexes",
)
@cases("text", PROGRAMS)
def test_a_program_prints_and_ends_as_with_python_itself(text: str, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs"
    ours = tmp_path / "ours"
    for folder in (theirs, ours):
        folder.mkdir()
    python = as_python(text, theirs)
    spec = build_run_spec(Settings({"background": "Empty_Map"}))
    program = Program("program.py", text, "none", working_directory=str(ours))
    done = over(start_run(program, spec, RunOptions(time_limit_s=20.0)))
    found = same_for_all("\n".join(done.lines), ours), same_for_all("\n".join(done.errors), ours)
    assert found == (same_for_all(python.stdout, theirs), same_for_all(python.stderr, theirs))
    assert done.ended.exit_code & 0xFF == python.exit_code, done.ended
    assert "tuisim" not in done.ended.summary + done.ended.error
