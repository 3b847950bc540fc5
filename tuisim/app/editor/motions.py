"""The keys of vim and of Emacs in the editor: movement and simple editing, as functions of the text and the cursor.

To add a key: add a line to a table below. A function gets a `Moment` and returns a `Step`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial

from tuisim.app.editor.text_lines import indent_after

Place = tuple[int, int]
"""Line and column, from 0."""
_WORD = re.compile(r"\w+|[^\w\s]+")
_FAR = 1_000_000
"""A column behind the end of every line."""
MAX_COUNT = 9999


class Mode(StrEnum):
    """What letters do."""

    NORMAL = "NORMAL"
    INSERT = "INSERT"


class Wanted(StrEnum):
    """What a key asks the editor for, besides a change of the text."""

    NOTHING = ""
    UNDO = "undo"
    REDO = "redo"
    FIND = "find"
    NEXT = "next"
    PREVIOUS = "previous"


@dataclass(frozen=True, slots=True)
class State:
    """What the keys before have left."""

    mode: Mode = Mode.INSERT
    typed: str = ""
    """A count and the first letter of a command, such as `2d`."""
    kept: str = ""
    """The text that was cut or copied last."""
    has_lines: bool = False
    """Whether that is whole lines."""
    column: int | None = None
    """The column that moves up and down lead back to."""
    mark: Place | None = None
    """Where the selection begins; None without a mark."""


@dataclass(frozen=True, slots=True)
class Moment:
    """The text when a key is pressed; there is always a line."""

    lines: Sequence[str]
    at: Place
    state: State
    count: int = 1
    has_count: bool = False

    @property
    def line(self) -> str:
        """The cursor's line."""
        return self.lines[self.at[0]]


@dataclass(frozen=True, slots=True)
class Step:
    """What a key does."""

    to: Place
    """Where the cursor is afterwards."""
    state: State
    change: tuple[Place, Place, str] | None = None
    """Two places, and the text that replaces what is between them."""
    wanted: Wanted = Wanted.NOTHING
    times: int = 1


Motion = Callable[[Moment], Place]
Command = Callable[[Moment], Step]


def _blanks(line: str) -> int:
    """Return the column of the first character that is no blank."""
    return len(line) - len(line.lstrip()) if line.strip() else 0


# Movement


def _left(now: Moment) -> Place:
    return now.at[0], max(0, now.at[1] - now.count)


def _right(now: Moment) -> Place:
    return now.at[0], min(len(now.line), now.at[1] + now.count)


def _vertical(now: Moment, way: int) -> Place:
    row = min(max(0, now.at[0] + way * now.count), len(now.lines) - 1)
    column = now.at[1] if now.state.column is None else now.state.column
    return row, min(column, len(now.lines[row]))


def _line_start(now: Moment) -> Place:
    return now.at[0], 0


def _line_code(now: Moment) -> Place:
    return now.at[0], _blanks(now.line)


def _line_end(now: Moment) -> Place:
    row = min(now.at[0] + now.count - 1, len(now.lines) - 1)
    return row, len(now.lines[row])


def _go(now: Moment, usual: int) -> Place:
    """Go to the line of the count, from 1; without one, to the usual index."""
    row = min(now.count - 1, len(now.lines) - 1) if now.has_count else usual % len(now.lines)
    return row, _blanks(now.lines[row])


def _places(lines: Sequence[str], *, ends: bool, empty: bool) -> list[Place]:
    """Return where words begin, or where they end; an empty line may count as a word."""
    found: list[Place] = []
    for row, line in enumerate(lines):
        words = [match.end() - 1 if ends else match.start() for match in _WORD.finditer(line)]
        found += [(row, column) for column in words or ([0] if empty and not line else [])]
    return found


def _word_on(now: Moment) -> Place:
    later = [place for place in _places(now.lines, ends=False, empty=True) if place > now.at]
    return later[now.count - 1] if len(later) >= now.count else (len(now.lines) - 1, len(now.lines[-1]))


def _word_back(now: Moment) -> Place:
    before = [place for place in _places(now.lines, ends=False, empty=True) if place < now.at]
    return before[-now.count] if len(before) >= now.count else (0, 0)


def _word_end(now: Moment) -> Place:
    later = [place for place in _places(now.lines, ends=True, empty=False) if place > now.at]
    return later[now.count - 1] if len(later) >= now.count else (len(now.lines) - 1, len(now.lines[-1]))


def _behind_word(now: Moment) -> Place:
    """As Emacs does: behind the last letter of the word."""
    later = [(row, column + 1) for row, column in _places(now.lines, ends=True, empty=False)]
    return next((place for place in later if place > now.at), (len(now.lines) - 1, len(now.lines[-1])))


# Editing


def _delete_characters(now: Moment) -> Step:
    row, column = now.at
    cut = now.line[column : column + now.count]
    to = (row, max(0, min(column, len(now.line) - len(cut) - 1)))
    return Step(to, replace(now.state, kept=cut, has_lines=False), (now.at, (row, column + len(cut)), ""))


def _delete_lines(now: Moment) -> Step:
    first, behind = now.at[0], min(now.at[0] + now.count, len(now.lines))
    state = replace(now.state, kept="\n".join(now.lines[first:behind]), has_lines=True)
    if behind < len(now.lines):
        return Step((first, _blanks(now.lines[behind])), state, ((first, 0), (behind, 0), ""))
    end = (len(now.lines) - 1, len(now.lines[-1]))
    if first == 0:
        return Step((0, 0), state, ((0, 0), end, ""))
    before = (first - 1, len(now.lines[first - 1]))
    return Step((first - 1, _blanks(now.lines[first - 1])), state, (before, end, ""))


def _copy_lines(now: Moment) -> Step:
    lines = now.lines[now.at[0] : now.at[0] + now.count]
    return Step(now.at, replace(now.state, kept="\n".join(lines), has_lines=True))


def _put(now: Moment, before: bool) -> Step:
    (row, column), state = now.at, now.state
    if not state.kept:
        return Step(now.at, state)
    if state.has_lines:
        text = "\n".join([state.kept] * now.count)
        to_row = row if before else row + 1
        place = (row, 0) if before else (row, len(now.line))
        change = (place, place, f"{text}\n" if before else f"\n{text}")
        return Step((to_row, _blanks(state.kept.split("\n", 1)[0])), state, change)
    text = state.kept * now.count
    place = (row, column if before else min(column + 1, len(now.line)))
    return Step((row, place[1] + len(text) - 1), state, (place, place, text))


def _insert(now: Moment, motion: Motion) -> Step:
    return Step(motion(replace(now, count=1)), replace(now.state, mode=Mode.INSERT))


def _here(now: Moment) -> Place:
    return now.at


def _open_line(now: Moment, before: bool) -> Step:
    row, line = now.at[0], now.line
    state = replace(now.state, mode=Mode.INSERT)
    if before:
        indent = line[: _blanks(line)]
        return Step((row, len(indent)), state, ((row, 0), (row, 0), f"{indent}\n"))
    indent = indent_after(line)
    return Step((row + 1, len(indent)), state, ((row, len(line)), (row, len(line)), f"\n{indent}"))


def _ask(now: Moment, wanted: Wanted) -> Step:
    return Step(now.at, now.state, wanted=wanted, times=now.count)


VIM_MOTIONS: Mapping[str, Motion] = {
    "h": _left, "backspace": _left, "l": _right, "space": _right,
    "j": partial(_vertical, way=1), "k": partial(_vertical, way=-1),
    "w": _word_on, "b": _word_back, "e": _word_end,
    "0": _line_start, "^": _line_code, "$": _line_end,
    "gg": partial(_go, usual=0), "G": partial(_go, usual=-1),
}  # fmt: skip
"""Keys that move the cursor, in the normal mode."""
VIM_COMMANDS: Mapping[str, Command] = {
    "x": _delete_characters, "dd": _delete_lines, "yy": _copy_lines,
    "p": partial(_put, before=False), "P": partial(_put, before=True),
    "i": partial(_insert, motion=_here), "a": partial(_insert, motion=_right),
    "I": partial(_insert, motion=_line_code), "A": partial(_insert, motion=_line_end),
    "o": partial(_open_line, before=False), "O": partial(_open_line, before=True),
    "u": partial(_ask, wanted=Wanted.UNDO), "U": partial(_ask, wanted=Wanted.REDO),
    "/": partial(_ask, wanted=Wanted.FIND), "n": partial(_ask, wanted=Wanted.NEXT),
    "N": partial(_ask, wanted=Wanted.PREVIOUS),
}  # fmt: skip
"""Keys that edit, in the normal mode."""
_VERTICAL = ("j", "k")
_FIRST_LETTERS = frozenset(name[0] for name in (*VIM_MOTIONS, *VIM_COMMANDS) if len(name) == 2)
_VIM_NAMES = {"enter": "j"}


def press_vim(now: Moment, key: str, character: str | None) -> Step | None:
    """Return what a key does with the keys of vim; None leaves it to the editor.

    Args:
        now: Text, cursor and state.
        key: In Textual's notation.
        character: What the key types, if anything.
    """
    state = now.state
    if state.mode is Mode.INSERT:
        if key != "escape":
            return None
        return Step(_left(replace(now, count=1)), replace(state, mode=Mode.NORMAL, typed="", column=None))
    if key == "escape":
        # A second one ends typing.
        return Step(now.at, replace(state, typed="")) if state.typed else None
    pressed = _VIM_NAMES.get(key, key if key in VIM_MOTIONS or character is None else character)
    if len(pressed) > 1 and pressed not in VIM_MOTIONS:
        # Arrows, keys with ctrl: those of the editor. Tab would indent.
        return Step(now.at, state) if key in ("tab", "shift+tab", "delete") else None
    return _typed(now, pressed)


def _typed(now: Moment, pressed: str) -> Step:
    digits = re.match(r"\d*", now.state.typed)
    count = digits[0] if digits else ""
    letters = now.state.typed[len(count) :]
    if not letters and pressed.isdigit() and (count or pressed != "0"):
        return Step(now.at, replace(now.state, typed=(count + pressed)[:4]))
    name = letters + pressed
    if not letters and pressed in _FIRST_LETTERS:
        return Step(now.at, replace(now.state, typed=count + pressed))
    state = replace(now.state, typed="")
    now = replace(now, state=state, count=int(count or 1) or 1, has_count=bool(count))
    if motion := VIM_MOTIONS.get(name):
        row, column = motion(now)
        goal = now.at[1] if state.column is None else state.column
        state = replace(state, column=goal if name in _VERTICAL else _FAR if name == "$" else None)
        # The cursor stands on a character, not behind the last one.
        return Step((row, max(0, min(column, len(now.lines[row]) - 1))), state)
    if command := VIM_COMMANDS.get(name):
        return command(replace(now, state=replace(state, column=None)))
    return Step(now.at, state)


# Emacs


def _cut(now: Moment, motion: Motion) -> Step:
    start, end = sorted((now.at, motion(now)))
    if start == end and end[0] + 1 < len(now.lines):
        # At the end of a line, its end is what is cut.
        end = (end[0] + 1, 0)
    return Step(start, replace(now.state, kept=_between(now.lines, start, end), mark=None), (start, end, ""))


def _between(lines: Sequence[str], start: Place, end: Place) -> str:
    if start[0] == end[0]:
        return lines[start[0]][start[1] : end[1]]
    return "\n".join([lines[start[0]][start[1] :], *lines[start[0] + 1 : end[0]], lines[end[0]][: end[1]]])


def _set_mark(now: Moment) -> Step:
    return Step(now.at, replace(now.state, mark=None if now.state.mark == now.at else now.at))


def _region(now: Moment, cuts: bool) -> Step:
    start, end = sorted((now.at, now.state.mark or now.at))
    state = replace(now.state, kept=_between(now.lines, start, end), mark=None) if start != end else now.state
    return Step(start if cuts else now.at, state, (start, end, "") if cuts and start != end else None)


def _yank(now: Moment) -> Step:
    lines = now.state.kept.split("\n")
    column = len(lines[-1]) + (now.at[1] if len(lines) == 1 else 0)
    state = replace(now.state, mark=None)
    return Step((now.at[0] + len(lines) - 1, column), state, (now.at, now.at, now.state.kept))


def _next_character(now: Moment) -> Place:
    at_end = now.at[1] == len(now.line) and now.at[0] + 1 < len(now.lines)
    return (now.at[0] + 1, 0) if at_end else _right(now)


def _last_character(now: Moment) -> Place:
    at_start = now.at[1] == 0 and now.at[0] > 0
    return (now.at[0] - 1, len(now.lines[now.at[0] - 1])) if at_start else _left(now)


EMACS_MOTIONS: Mapping[str, Motion] = {
    "ctrl+a": _line_start, "ctrl+e": _line_end, "alt+m": _line_code,
    "ctrl+f": _next_character, "ctrl+b": _last_character,
    "ctrl+n": partial(_vertical, way=1), "ctrl+p": partial(_vertical, way=-1),
    "alt+f": _behind_word, "alt+b": _word_back,
    "alt+<": partial(_go, usual=0), "alt+>": partial(_go, usual=-1),
}  # fmt: skip
"""Keys that move the cursor."""
EMACS_COMMANDS: Mapping[str, Command] = {
    "ctrl+k": partial(_cut, motion=_line_end), "alt+d": partial(_cut, motion=_behind_word),
    "ctrl+@": _set_mark, "ctrl+w": partial(_region, cuts=True), "alt+w": partial(_region, cuts=False),
    "ctrl+y": _yank, "alt+s": partial(_ask, wanted=Wanted.FIND), "alt+z": partial(_ask, wanted=Wanted.REDO),
}  # fmt: skip
"""Keys that edit."""
_EMACS_VERTICAL = ("ctrl+n", "ctrl+p")
_EMACS_NAMES = {
    "ctrl+space": "ctrl+@",
    "ctrl+at": "ctrl+@",
    "alt+less_than_sign": "alt+<",
    "alt+greater_than_sign": "alt+>",
}


def press_emacs(now: Moment, key: str, character: str | None) -> Step | None:
    """Return what a key does with the keys of Emacs; None leaves it to the editor. As for `press_vim`."""
    name = _EMACS_NAMES.get(key, key)
    if motion := EMACS_MOTIONS.get(name):
        goal = now.at[1] if now.state.column is None else now.state.column
        column = goal if name in _EMACS_VERTICAL else None
        return Step(motion(now), replace(now.state, column=column))
    if command := EMACS_COMMANDS.get(name):
        return command(replace(now, state=replace(now.state, column=None)))
    return None
