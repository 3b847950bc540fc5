"""Frames of character cells as an asciinema recording, version 2 (https://docs.asciinema.org/manual/asciicast/v2/)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence

from tuisim.charts.cell_image import Cell, CellGrid, Look

_REWRITTEN = 4
"""Rewriting this many unchanged cells costs no more than a jump over them."""

_BEGIN, _END = "\x1b[?25l\x1b[2J", "\x1b[0m\x1b[?25h"
"""Hide the cursor and clear the screen; show it again."""


def cast_of(frames: Iterable[CellGrid], durations_ms: Sequence[int], size: tuple[int, int], title: str) -> bytes:
    """Return a recording.

    Args:
        frames: All of one size.
        durations_ms: How long each frame is shown.
        size: Columns and rows.
        title: Shown by players.
    """
    columns, rows = size
    head = {"version": 2, "width": columns, "height": rows, "title": title, "env": {"TERM": "xterm-256color"}}
    lines = [json.dumps(head)]
    time_ms, before = 0, None
    pen = _Pen()
    for frame, duration_ms in zip(frames, durations_ms, strict=True):
        codes = pen.codes(before, frame)
        if codes or before is None:
            lines.append(_event(time_ms, (_BEGIN if before is None else "") + codes))
        before = frame
        time_ms += duration_ms
    lines.append(_event(time_ms, f"{_END}\x1b[{rows};1H"))
    return "".join(f"{line}\n" for line in lines).encode()


def _event(time_ms: int, codes: str) -> str:
    return json.dumps([time_ms / 1000, "o", codes], ensure_ascii=False)


class _Pen:
    """Writes cells, and tracks the terminal's style."""

    def __init__(self) -> None:
        self._look: Look | None = None

    def codes(self, before: CellGrid | None, frame: CellGrid) -> str:
        """Return the codes that turn a frame into the next one; None for an unknown one."""
        parts: list[str] = []
        for y, row in enumerate(frame):
            for first, end in _runs(before[y] if before else None, row):
                parts.append(f"\x1b[{y + 1};{first + 1}H")
                parts += self._written(row[first:end])
        return "".join(parts)

    def _written(self, cells: Sequence[Cell]) -> Iterator[str]:
        for text, look in cells:
            if not text:
                # The left half of the character covers it.
                continue
            if text == " " and self._look and not (look.underline or look.strike):
                # A blank has only a background.
                look = Look(self._look.ink, look.ground, self._look.bold, self._look.italic)
            if look != self._look:
                yield _style(self._look, look)
                self._look = look
            yield text


def _runs(before: Sequence[Cell] | None, row: Sequence[Cell]) -> Iterator[tuple[int, int]]:
    """Yield first and end of the parts of a row that differ; few unchanged cells between two are included."""
    first = end = -1
    for x, cell in enumerate(row):
        if before is not None and before[x] == cell:
            continue
        if not cell[0]:
            # The right half of a wide character is written with the left one.
            x -= 1
        if first >= 0 and x - end > _REWRITTEN:
            yield first, end
            first = x
        elif first < 0:
            first = x
        end = x + 1 + (not cell[0])
    if first >= 0:
        yield first, end


def _style(before: Look | None, look: Look) -> str:
    flags = {"1": look.bold, "3": look.italic, "4": look.underline, "9": look.strike}
    parts: list[str] = []
    if before is None or (before.bold, before.italic, before.underline, before.strike) != tuple(flags.values()):
        parts = ["0", *(code for code, is_on in flags.items() if is_on)]
        before = None
    for code, now, was in (("38", look.ink, before and before.ink), ("48", look.ground, before and before.ground)):
        if now != was:
            parts.append(";".join((code, "2", *map(str, now))))
    return f"\x1b[{';'.join(parts)}m"
