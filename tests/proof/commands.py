"""Commands in this process, and what each must hold to whatever it is given."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass

from tests.proof.kind import FaultError
from tuisim.cli import EXIT_OUR_MISTAKE, run_command

_CONTROL = {*map(chr, range(32)), *map(chr, range(0x7F, 0xA0)), "\u202e"} - {"\n", "\t"}
_COLORS = re.compile(r"\x1b\[\d{1,3}(;\d{1,3})*m")
"""The colours that charts have on a terminal."""


@dataclass(frozen=True, slots=True)
class Said:
    """What a command wrote, and how it ended."""

    code: int
    out: str
    err: str


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def said(words: Sequence[str], on_terminal: bool = False) -> Said:
    """Run a command in this process."""
    out = _Terminal() if on_terminal else io.StringIO()
    err = io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = run_command(words)
        except SystemExit as left:
            code = int(left.code or 0)
    return Said(code, out.getvalue(), err.getvalue())


def check_said(
    words: Sequence[str], codes: Sequence[int] = (0, 1, 2), on_terminal: bool = False
) -> Said:
    """Run a command; a fault is a mistake of ours, an error without a clear line, or an escape to the terminal."""
    found = said(words, on_terminal)
    call = f"tuisim {' '.join(words)}"
    if found.code == EXIT_OUR_MISTAKE or "Traceback" in found.err or "internal error" in found.err:
        raise FaultError(f"{call}: a mistake of ours: {found.err!r}")
    if found.code not in codes:
        raise FaultError(f"{call}: exit code {found.code}: {found.err!r}")
    lines = [line for line in found.err.splitlines() if not line.startswith("note: ")]
    if found.code == 2 and not lines:
        raise FaultError(f"{call}: exit code 2 without a word")
    if max(map(len, lines), default=0) > 2000 or len(lines) > 40:
        raise FaultError(
            f"{call}: an error of {len(lines)} lines, {len(found.err)} characters: {found.err[:500]!r}"
        )
    for name, text in (("stdout", found.out), ("stderr", found.err)):
        if on_terminal:
            text = _COLORS.sub("", text)
        if escapes := _CONTROL & set(text):
            at = min(text.index(one) for one in escapes)
            raise FaultError(f"{call}: {name} holds {escapes}: {text[max(0, at - 60) : at + 60]!r}")
    return found
