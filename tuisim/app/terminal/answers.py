"""Answers of the terminal among the keys: taken out, and told to the app."""

from __future__ import annotations

import re
from collections.abc import Iterable
from time import monotonic
from typing import ClassVar

from textual._xterm_parser import XTermParser
from textual.message import Message

from tuisim.app.terminal.queries import ANSWER, TerminalFacts

_BEGUN = re.compile(r"\x1b(?:P>[^\x1b]*|_G[^\x1b]*|\[6;[\d;]*|\[\?[\d;]*)\x1b?\Z")
"""The beginning of an answer whose rest has not arrived."""
_MAYBE_BEGUN = re.compile(r"\x1b(?:[P_\[]|\[6)?\Z")
"""What may be one, but also a key."""
_KEY_S = 0.1
"""What may be a key waits this long for the rest of an answer."""
_REST_S = 3.0
"""The beginning of an answer waits this long for its rest; after that it is dropped."""
_LONGEST = 500
"""An answer is at most this long; the beginning of a longer one is dropped."""


class TerminalAnswered(Message):
    """Posted to the app when the terminal has answered the last query."""

    def __init__(self, facts: TerminalFacts) -> None:
        super().__init__()
        self.facts = facts


class AnswerParser(XTermParser):
    """Textual's parser of what the terminal sends, which takes answers that it does not know for key presses."""

    is_asked: ClassVar[bool] = False
    """Whether a terminal that has answered before was asked again."""

    def __init__(self, debug: bool = False) -> None:
        super().__init__(debug)
        self._begun = ""
        self._begun_s = 0.0
        self._facts = TerminalFacts()

    def feed(self, data: str) -> Iterable[Message]:
        """Yield a message for each answer, and then those for the rest of the data."""
        was, self._begun = self._begun, ""
        text, is_end = was + data, not data
        if "\x1b" in text:
            for match in ANSWER.finditer(text):
                was = ""
                self._facts = self._facts.with_answer(match)
                if match["attributes"] is not None:
                    AnswerParser.is_asked = False
                if match["attributes"] is not None or match["kitty"] is not None:
                    yield TerminalAnswered(self._facts)
            text = ANSWER.sub("", text)
            if not is_end and (begun := self._begun_at_end(text)):
                self._begun = begun if len(begun) <= _LONGEST else ""
                self._begun_s = self._begun_s if was else monotonic()
                text = text[: -len(begun)]
        if text:
            yield from super().feed(text)
        if is_end:
            yield from super().feed("")

    def _begun_at_end(self, text: str) -> str:
        found = _BEGUN.search(text)
        if found is None and (self.is_asked or not self._facts.attributes or self._facts.asks_for_kitty):
            found = _MAYBE_BEGUN.search(text)
        return found[0] if found else ""

    def tick(self) -> Iterable[Message]:
        """Yield what has been held back for long enough; drop an answer whose rest does not come."""
        is_answer = _BEGUN.match(self._begun)
        if self._begun and monotonic() - self._begun_s >= (_REST_S if is_answer else _KEY_S):
            text, self._begun = "" if is_answer else self._begun, ""
            if text:
                yield from super().feed(text)
        yield from super().tick()
