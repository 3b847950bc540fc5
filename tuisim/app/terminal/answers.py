"""Answers of the terminal among the keys: taken out, and told to the app."""

from __future__ import annotations

import re
from collections.abc import Iterable

from textual._xterm_parser import XTermParser
from textual.message import Message

from tuisim.app.terminal.queries import ANSWER, TerminalFacts

_BEGUN = re.compile(r"\x1b(?:P>[^\x1b]*|_G[^\x1b]*|\[6;[\d;]*|\[\?[\d;]*)\x1b?\Z")
"""The beginning of an answer whose rest has not arrived."""
_MAYBE_BEGUN = re.compile(r"\x1b(?:[P_\[]|\[6)?\Z")
"""What may be one, but also a key."""
_LONGEST = 500
"""An answer is at most this long; the beginning of a longer one is dropped."""


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
            for match in ANSWER.finditer(text):
                self._facts = self._facts.with_answer(match)
                if match["attributes"] is not None or match["kitty"] is not None:
                    yield TerminalAnswered(self._facts)
            text = ANSWER.sub("", text)
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
