"""The state of a paused program as lines of text."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import assert_never

from rich.style import Style

from tuisim.app import design
from tuisim.app.snapshot import RunPhase, shorten_value
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.engine.protocol import FrameState, Inspected, Paused, PauseReason, Variable
from tuisim.terminal.text_runs import Line, cut

_PLAIN = Style(color=palette.INK)
_NAME = Style(color=design.NAME)
_VALUE = Style(color=palette.WHITE)
_CHANGED = Style(color=palette.YELLOW, bold=True)
_HEAD = Style(color=palette.GREEN, bold=True)
_PALE = Style(color=design.PALE)
_WAITS = Style(color=palette.BLACK, bgcolor=design.WAITING)
_ERROR = Style(color=design.RED)
_CHOSEN = Style(color=palette.WHITE, bgcolor=design.CHOSEN)

_NAME_COLUMN = 16
_FUNCTIONS = ("function", "builtin_function_or_method", "type")

_OVER = (
    "The program has ended.",
    "",
    "N  its last line    ,  a tick back",
    "g  go to …          <  a second back",
    "n  step through it again",
)
_KEYS = (
    "",
    "n  next line      t  breakpoint",
    "s  into a call    u  out of it",
    "N  line back      w  watch",
)


@dataclass(frozen=True, slots=True)
class DebugView:
    """The content of the debug panel: where the program is paused, and its frames and variables there."""

    state: RunPhase = RunPhase.IDLE
    paused: Paused | None = None
    inspected: Inspected | None = None
    past: bool = False
    busy: bool = False
    """Whether a past instant is still being computed."""
    source: str = ""
    """The source line at which the program is paused in another module, which the code panel does not show."""
    now: tuple[int, float] | None = None
    """Tick and simulated time of the instant in the other panels."""

    @property
    def is_elsewhere(self) -> bool:
        """Whether the variables belong to another instant than the one that the other panels show."""
        return self.now is not None and self.paused is not None and self.now[0] != self.paused.tick


def label_reason(reason: PauseReason) -> str:
    """Return in words why a run has paused."""
    match reason:
        case PauseReason.ASKED:
            return "paused"
        case PauseReason.TICKS:
            return "ticks done"
        case PauseReason.LINE:
            return "line reached"
        case PauseReason.INSTANT:
            return "recorded"
        case PauseReason.END:
            return "end of the program"
        case PauseReason.STEP:
            return "paused after a step"
        case PauseReason.BREAK:
            return reason.value
        case _:
            assert_never(reason)


def debug_lines(view: DebugView, width: int) -> list[Line]:
    """Return the content of the debug panel as lines of at most `width` cells."""
    if view.paused is None or view.inspected is None:
        if view.busy:
            return _build_text("", ("computing this instant …",), width)
        return _build_hint(view.state, width)
    lines = _known(view, view.paused, view.inspected, width)
    if view.is_elsewhere and view.now:
        # The known data belongs to another instant: it is dimmed until the data of the present instant has arrived.
        tick, time_s = view.now
        head: Line = [(cut(f"{time_s:.2f} s · tick {tick} …", width), _HEAD)]
        return [head, *([(text, _PALE) for text, _ in line] for line in lines[1:])]
    return lines


def _build_hint(state: RunPhase, width: int) -> list[Line]:
    match state:
        case RunPhase.RUNNING:
            return _build_text("running", ("space  pauses    n  pauses at the next line",), width)
        case RunPhase.WAITING:
            return _build_text("waiting", ("Answer in the Output panel.",), width)
        case RunPhase.ENDED:
            return _build_text("", _OVER, width)
        case RunPhase.IDLE:
            return _build_text("", ("The program has not started.", *_KEYS), width)
        case RunPhase.STARTING:
            return _build_text("", ("The program is starting.", *_KEYS), width)
        case RunPhase.PAUSED:
            return _build_text("paused", ("reading the variables …", *_KEYS), width)
        case _:
            assert_never(state)


def _known(view: DebugView, paused: Paused, inspected: Inspected, width: int) -> list[Line]:
    lines = [_describe_place(view, paused, width)]
    if view.source:
        lines.append([(cut(f"  {view.source.strip()}", width), _VALUE)])
    why = label_reason(paused.reason) + (f" {paused.detail}" if paused.detail else "")
    if paused.value:
        why += f": {paused.value}"
    if not view.past and paused.reason not in (PauseReason.ASKED, PauseReason.INSTANT):
        lines += [[(text, _CHANGED)] for text in textwrap.wrap(why, width)]
    if inspected.waiting:
        lines += [
            [(f" {text} ", _WAITS)] for text in textwrap.wrap(inspected.waiting, max(width - 2, 1))
        ]
    if inspected.watches:
        lines.append([("Watches", _HEAD)])
        for watch in inspected.watches:
            if watch.error:
                lines += [
                    [(f"  {text}", _ERROR)]
                    for text in textwrap.wrap(f"{watch.text}: {watch.error}", width - 2)
                ]
            else:
                lines.append(_build_pair(watch.text, watch.value, _NAME, _VALUE, width))
    frame = inspected.stack[inspected.frame] if inspected.frame < len(inspected.stack) else None
    lines += _list_variables(_describe_frame(frame), inspected.variables, width)
    if inspected.globals:
        lines += _list_variables("Globals", inspected.globals, width)
    lines += _list_frames(inspected, width)
    if len(inspected.threads) > 1:
        lines.append([("Threads", _HEAD)])
        for thread in inspected.threads:
            chosen = thread.name == inspected.thread
            text = (
                f"{'▸' if chosen else ' '} {thread.name} line {thread.line}"
                if thread.line
                else f"  {thread.name}"
            )
            lines.append([(cut(f"{text} {thread.waiting}", width), _CHOSEN if chosen else _PLAIN)])
    if inspected.note:
        lines += [[(text, _PALE)] for text in textwrap.wrap(inspected.note, width)]
    return lines


def _build_text(head: str, texts: Sequence[str], width: int) -> list[Line]:
    """Return a heading and texts as lines for an otherwise empty panel; in a narrow panel, the texts are wrapped."""
    if max(map(len, texts)) > width:
        parts = [part for text in texts for part in re.split(" {3,}", text)]
        texts = [row for part in parts for row in textwrap.wrap(part, width) or [""]]
    return [*([[(head, _HEAD)]] if head else []), *([(text, _PALE)] for text in texts)]


def _describe_place(view: DebugView, paused: Paused, width: int) -> Line:
    words = f"line {paused.line}" if paused.line else "no line"
    if paused.file:
        words += f" of {Path(paused.file).name}"
    text = f"{words} · {paused.time_ns / 1e9:.2f} s"
    if view.busy:
        tail = " …"
    elif view.past:
        tail = " past"
    else:
        tail = ""
    # The time says as much as the tick, which is left out rather than cut in two.
    if len(whole := f"{text} · tick {paused.tick}") <= width - len(tail):
        text = whole
    return [(cut(text, width - len(tail)), _HEAD), (tail, _CHANGED)]


def _describe_frame(frame: FrameState | None) -> str:
    if frame is None:
        return "Variables"
    return "Variables" if frame.function == "<module>" else f"Variables of {frame.function}"


def _list_variables(title: str, variables: Sequence[Variable], width: int) -> list[Line]:
    lines: list[Line] = [[(cut(title, width), _HEAD)]]
    if not variables:
        lines.append([("  none", _PALE)])
    # Changed variables are highlighted, each in its place; constants and functions, which do not change, are the last.
    for variable in sorted(variables, key=lambda one: (one.kind in _FUNCTIONS, one.name.isupper())):
        style = _CHANGED if variable.changed else _VALUE
        lines.append(
            _build_pair(
                variable.name, variable.value, _NAME, style, width, "•" if variable.changed else " "
            )
        )
    return lines


def _list_frames(inspected: Inspected, width: int) -> list[Line]:
    if len(inspected.stack) < 2:
        return []
    lines: list[Line] = [[("Calls", _HEAD)]]
    for depth, frame in enumerate(inspected.stack):
        where = f"{frame.line} of {Path(frame.file).name}" if frame.file else f"{frame.line}"
        module = "module" if frame.file else "program"
        name = module if frame.function == "<module>" else f"{frame.function}()"
        style = _CHOSEN if depth == inspected.frame else _PLAIN
        lines.append(
            [(cut(f"{'▸' if depth == inspected.frame else ' '} {name} line {where}", width), style)]
        )
    return lines


def _build_pair(
    name: str, value: str, name_style: Style, style: Style, width: int, mark: str = " "
) -> Line:
    column = min(_NAME_COLUMN, max(6, width // 2 - 2), max(6, len(name)))
    name_text = cut(name, column).ljust(column)
    room = width - column - 3
    text = shorten_value(" ".join(value.split("\n")))
    return [
        (f"{mark} ", _CHANGED),
        (name_text, name_style),
        (" ", _PLAIN),
        (cut(text, room), style),
    ]
