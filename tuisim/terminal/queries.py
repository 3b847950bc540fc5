"""The questions of an app to its terminal; the answers, which come among the keys, are removed and passed to the app.

Reference: https://invisible-island.net/xterm/ctlseqs/ctlseqs.html (XTVERSION, primary device attributes, window
operations); for the query of kitty see `kitty.py`.
"""

from __future__ import annotations

import fcntl
import re
import struct
import termios
from collections.abc import Iterable
from dataclasses import dataclass, replace
from time import monotonic
from typing import ClassVar

from textual.message import Message

from tuisim.terminal import kitty
from tuisim.terminal.textual_internals import XTermParser

NAME_QUERY = "\x1b[>0q"
CELL_SIZE_QUERY = "\x1b[16t"
ATTRIBUTES_QUERY = "\x1b[c"
"""Asks for the attributes, which every terminal answers, so it comes last: other questions are not answered after
that."""
QUESTIONS = f"{NAME_QUERY}{CELL_SIZE_QUERY}{ATTRIBUTES_QUERY}"
KITTY_QUESTIONS = f"{kitty.QUERY}{ATTRIBUTES_QUERY}"
"""Questions for a terminal that has answered the others, if `asks_for_kitty` is true then."""

ANSWER = re.compile(
    r"\x1bP>\|(?P<name>[^\x1b\x07]*)(?:\x1b\\|\x07)"
    r"|\x1b_G[^;\x1b]*;(?P<kitty>[^\x1b]*)\x1b\\"
    r"|\x1b\[6;(?P<height>\d+);(?P<width>\d+)t"
    r"|\x1b\[\?(?P<attributes>[\d;]*)c"
)
_SIXEL = "4"
"""Number of sixel graphics among the attributes of a terminal."""
_PROGRAM = re.compile(r"[A-Za-z0-9]+")
_MIN_CELL_PX, _MAX_CELL_PX = (2, 4), (300, 300)
"""Smallest and largest width and height of a cell; terminals have reported sizes of 1 pixel, and none at all."""


@dataclass(frozen=True, slots=True)
class TerminalFacts:
    """The facts that are known of a terminal from its answers so far."""

    name: str = ""
    """Name and version of the terminal, such as `kitty(0.36.4)`; empty if it does not say."""
    attributes: frozenset[str] = frozenset()
    """The numbers of the terminal's features; empty if it has not answered at all."""
    has_kitty_graphics: bool | None = None
    """Whether the terminal draws pictures at placeholders; None if it has not been asked, False once it has
    reported an error."""
    kitty_error: str = ""
    """The error that the terminal has last reported, such as `ENOSPC:No space left`."""
    cell_px: tuple[int, int] | None = None
    """Width and height of a cell in pixels."""

    @property
    def program(self) -> str:
        """The name of the terminal without its version; empty if the terminal has not answered it."""
        match = _PROGRAM.match(self.name)
        return match[0] if match else ""

    @property
    def asks_for_kitty(self) -> bool:
        """Whether to ask the terminal for kitty's protocol: it may know the protocol, and has not answered yet."""
        return self.has_kitty_graphics is None and self.program in kitty.TERMINALS

    @property
    def without_refusal(self) -> TerminalFacts:
        """The same facts, but without a mere guess that the terminal lacks kitty's protocol.

        If `has_kitty_graphics` is False without an error from the terminal, the terminal has not answered about the
        protocol: the value then becomes None.
        """
        return (
            self
            if self.has_kitty_graphics or self.kitty_error
            else replace(self, has_kitty_graphics=None)
        )

    @property
    def has_sixel(self) -> bool:
        """Whether the terminal draws sixel graphics."""
        return _SIXEL in self.attributes

    def add_answer(self, match: re.Match[str]) -> TerminalFacts:
        """Return the facts with a further answer of the terminal, given as a match of the pattern of all answers."""
        groups = match.groupdict()
        if groups["name"] is not None:
            # A name means that all questions are asked again, perhaps by another page: if the question for kitty's
            # protocol is not answered yet, it counts as not asked.
            return replace(self.without_refusal, name=groups["name"], attributes=frozenset())
        if groups["kitty"] is not None:
            # The answer may come late, as attributes are asked for when the size changes; an error counts for good.
            error = self.kitty_error if groups["kitty"] == "OK" else groups["kitty"]
            return replace(self, has_kitty_graphics=not error, kitty_error=error)
        if groups["attributes"] is not None:
            # Attributes that come a second time follow the question for kitty's protocol, which was not answered then.
            answered = False if self.attributes and self.asks_for_kitty else self.has_kitty_graphics
            attributes = frozenset(groups["attributes"].split(";"))
            return replace(self, attributes=attributes, has_kitty_graphics=answered)
        width, height = int(groups["width"]), int(groups["height"])
        return replace(self, cell_px=(width, height)) if _is_possible((width, height)) else self


def _is_possible(cell_px: tuple[int, int]) -> bool:
    return all(
        smallest <= px <= largest
        for smallest, px, largest in zip(_MIN_CELL_PX, cell_px, _MAX_CELL_PX, strict=True)
    )


def parse_facts(text: str) -> TerminalFacts:
    """Return the facts from all answers in a text; anything else in it is ignored."""
    facts = TerminalFacts()
    for match in ANSWER.finditer(text):
        facts = facts.add_answer(match)
    return facts


def read_cell_size_px(fd: int) -> tuple[int, int] | None:
    """Return the kernel's width and height of a cell in pixels, also over SSH; None if it does not know them."""
    try:
        rows, cols, width, height = struct.unpack(
            "HHHH", fcntl.ioctl(fd, termios.TIOCGWINSZ, bytes(8))
        )
    except OSError:
        return None
    cell_px = (width // cols, height // rows) if rows and cols else (0, 0)
    return cell_px if _is_possible(cell_px) else None


_BEGUN = re.compile(r"\x1b(?:P>[^\x1b]*|_G[^\x1b]*|\[6;[\d;]*|\[\?[\d;]*)\x1b?\Z")
"""The beginning of an answer whose rest has not arrived."""
_MAYBE_BEGUN = re.compile(r"\x1b(?:[P_\[]|\[6)?\Z")
"""Input that may be the beginning of an answer, or a key."""
_KEY_S = 0.1
"""Input that may be a key waits this many seconds for the rest of an answer."""
_REST_S = 3.0
"""The beginning of an answer waits this many seconds for its rest; after that it is dropped."""
_LONGEST = 500
"""An answer is at most this long; the beginning of a longer one is dropped."""


class TerminalAnswered(Message):
    """Posted when the terminal has answered the last of the queries that were sent together.

    The message has all facts that are known of the terminal so far.
    """

    def __init__(self, facts: TerminalFacts) -> None:
        super().__init__()
        self.facts = facts


class AnswerParser(XTermParser):
    """Textual's parser of the terminal's input, which also reads answers that Textual would take for key presses."""

    is_asked: ClassVar[bool] = False
    """Whether a terminal that has answered before was asked again, and has not answered since."""

    def __init__(self, debug: bool = False) -> None:
        super().__init__(debug)
        self._begun = ""
        self._begun_s = 0.0
        self._facts = TerminalFacts()

    def feed(self, data: str) -> Iterable[Message]:
        """Yield a message for each answer in the data, and then the messages for the rest of the data."""
        was = self._begun
        self._begun = ""
        text = was + data
        is_end = not data
        if "\x1b" in text:
            for match in ANSWER.finditer(text):
                was = ""
                self._facts = self._facts.add_answer(match)
                if match["attributes"] is not None:
                    AnswerParser.is_asked = False
                if match["attributes"] is not None or match["kitty"] is not None:
                    yield TerminalAnswered(self._facts)
            text = ANSWER.sub("", text)
            if not is_end and (begun := self._find_unfinished(text)):
                self._begun = begun if len(begun) <= _LONGEST else ""
                self._begun_s = self._begun_s if was else monotonic()
                text = text[: -len(begun)]
        if text:
            yield from super().feed(text)
        if is_end:
            yield from super().feed("")

    def _find_unfinished(self, text: str) -> str:
        match = _BEGUN.search(text)
        if match is None and (
            self.is_asked or not self._facts.attributes or self._facts.asks_for_kitty
        ):
            match = _MAYBE_BEGUN.search(text)
        return match[0] if match else ""

    def tick(self) -> Iterable[Message]:
        """Yield messages for input that was held back as the possible beginning of an answer, if nothing followed.

        If the input surely was the beginning of an answer, drop it.
        """
        is_answer = _BEGUN.match(self._begun)
        if self._begun and monotonic() - self._begun_s >= (_REST_S if is_answer else _KEY_S):
            text = "" if is_answer else self._begun
            self._begun = ""
            if text:
                yield from super().feed(text)
        yield from super().tick()
