"""What the terminal says about itself: its name, its features, the size of its cells.

Reference: https://invisible-island.net/xterm/ctlseqs/ctlseqs.html (XTVERSION, primary device attributes, window
operations); for the query of kitty see `graphics.kitty`.
"""

from __future__ import annotations

import fcntl
import re
import struct
import termios
from collections.abc import Iterable
from dataclasses import dataclass, replace

from textual._xterm_parser import XTermParser
from textual.message import Message

from tuisim.app.graphics import kitty

NAME_QUERY = "\x1b[>0q"
CELL_SIZE_QUERY = "\x1b[16t"
ATTRIBUTES_QUERY = "\x1b[c"
"""Every terminal answers it, so it comes last: what has not been answered by then will not be."""
QUESTIONS = f"{NAME_QUERY}{CELL_SIZE_QUERY}{ATTRIBUTES_QUERY}"

_ANSWER = re.compile(
    r"\x1bP>\|(?P<name>[^\x1b]*)\x1b\\"
    rf"|\x1b_Gi={kitty.QUERY_IMAGE};(?P<kitty>[^\x1b]*)\x1b\\"
    r"|\x1b\[6;(?P<height>\d+);(?P<width>\d+)t"
    r"|\x1b\[\?(?P<attributes>[\d;]*)c"
)
_BEGUN = re.compile(r"\x1b(?:P>[^\x1b]*|_G[^\x1b]*|\[6;[\d;]*|\[\?[\d;]*)\x1b?\Z")
"""The beginning of an answer whose rest has not arrived."""
_MAYBE_BEGUN = re.compile(r"\x1b(?:[P_\[]|\[6)?\Z")
"""What may be one, but also a key."""
_LONGEST = 500
"""An answer is at most this long; the beginning of a longer one is dropped."""
_SIXEL = "4"
"""Number of sixel graphics among the attributes of a terminal."""
_PROGRAM = re.compile(r"[A-Za-z0-9]+")
_MOST_CELL_PX = 300


@dataclass(frozen=True, slots=True)
class TerminalFacts:
    """What a terminal has answered so far."""

    name: str = ""
    """Its name and version, such as `kitty(0.36.4)`; empty if it does not tell."""
    attributes: frozenset[str] = frozenset()
    """The numbers of its features; empty if it has not answered at all."""
    has_kitty_graphics: bool | None = None
    """None if it has not been asked, or has not answered."""
    cell_px: tuple[int, int] | None = None
    """Width and height of a cell in pixels."""

    @property
    def program(self) -> str:
        """Its name without its version; empty if it does not tell."""
        found = _PROGRAM.match(self.name)
        return found[0] if found else ""

    @property
    def asks_for_kitty(self) -> bool:
        """Whether it may draw kitty's graphics, and has not answered yet."""
        return self.has_kitty_graphics is None and self.program in kitty.TERMINALS

    @property
    def has_sixel(self) -> bool:
        """Whether it draws sixel graphics."""
        return _SIXEL in self.attributes

    def with_answer(self, match: re.Match[str]) -> TerminalFacts:
        """Return the facts with an answer of the terminal."""
        found = match.groupdict()
        if found["name"] is not None:
            return replace(self, name=found["name"])
        if found["kitty"] is not None:
            return replace(self, has_kitty_graphics=found["kitty"] == "OK")
        if found["attributes"] is not None:
            return replace(self, attributes=frozenset(found["attributes"].split(";")))
        width, height = int(found["width"]), int(found["height"])
        is_possible = 0 < width <= _MOST_CELL_PX and 0 < height <= _MOST_CELL_PX
        return replace(self, cell_px=(width, height)) if is_possible else self


class TerminalAnswered(Message):
    """Posted to the app when the terminal has answered the last query."""

    def __init__(self, facts: TerminalFacts) -> None:
        super().__init__()
        self.facts = facts


class AnswerParser(XTermParser):
    """Textual's parser of what the terminal sends, which takes answers that it does not know for key presses."""

    def __init__(self, debug: bool = False) -> None:
        super().__init__(debug)
        self._begun = ""
        self._facts = TerminalFacts()

    def feed(self, data: str) -> Iterable[Message]:
        """Yield a message for each answer, and then those for the rest of the data."""
        text, self._begun = self._begun + data, ""
        is_end = not data
        if "\x1b" in text:
            for match in _ANSWER.finditer(text):
                self._facts = self._facts.with_answer(match)
                if match["attributes"] is not None or match["kitty"] is not None:
                    yield TerminalAnswered(self._facts)
            text = _ANSWER.sub("", text)
            if not is_end and (begun := self._begun_at_end(text)):
                self._begun = begun if len(begun) <= _LONGEST else ""
                text = text[: -len(begun)]
        if text or is_end:
            yield from super().feed(text)

    def _begun_at_end(self, text: str) -> str:
        found = _BEGUN.search(text)
        if found is None and (not self._facts.attributes or self._facts.asks_for_kitty):
            found = _MAYBE_BEGUN.search(text)
        return found[0] if found else ""

    def tick(self) -> Iterable[Message]:
        """Yield what has been held back, unless it is an answer whose rest is still to come."""
        if self._begun and not _BEGUN.match(self._begun):
            text, self._begun = self._begun, ""
            yield from super().feed(text)
        yield from super().tick()


def cell_size_px(fd: int) -> tuple[int, int] | None:
    """Return width and height of a cell as the kernel knows them, also over SSH; None if it does not."""
    try:
        rows, cols, width, height = struct.unpack("HHHH", fcntl.ioctl(fd, termios.TIOCGWINSZ, bytes(8)))
    except OSError:
        return None
    return (width // cols, height // rows) if rows and cols and width >= cols and height >= rows else None
