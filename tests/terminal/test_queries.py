"""What the terminal answers is understood, and is no key press."""

from __future__ import annotations

import fcntl
import os
import struct
import termios

import pytest
from textual import events
from textual.message import Message

from tests.cases import cases, for_each, for_rows
from tuisim.terminal import queries
from tuisim.terminal.picture import Graphics
from tuisim.terminal.picture_mode import choose_graphics
from tuisim.terminal.picture_options import AUTO, NO_PIXELS, Protocol
from tuisim.terminal.queries import AnswerParser, TerminalAnswered, TerminalFacts, read_cell_size_px

XTERM = "\x1bP>|XTerm(379)\x1b\\\x1b[6;14;7t\x1b[?63;1;2;4;6;9;15;22c"
KITTY = "\x1bP>|kitty(0.36.4)\x1b\\\x1b[6;20;10t\x1b[?62;52;c"
KITTY_YES = "\x1b_Gi=31;OK\x1b\\"
OLD_KITTY = "\x1bP>|kitty(0.26.5)\x1b\\\x1b[6;20;10t\x1b[?62;c"
OLD_KITTY_AGAIN = "\x1b[?62;c"
"""It ignores a question with a key that it does not know, and answers only the one that follows."""
KITTY_ERROR = "\x1b_Gi=65537;ENOSPC:No space left\x1b\\"
GHOSTTY_NO = "\x1bP>|ghostty 1.0.0\x1b\\\x1b[6;40;20t\x1b[?62;22c\x1b_Gi=31;ENOTSUPPORTED\x1b\\"
ITERM = "\x1bP>|iTerm2 3.5.4\x1b\\\x1b[6;17;8t\x1b[?64;1;2;4;6;17;18;21;22c"
WEZTERM = "\x1bP>|WezTerm 20240203-110809-5046fc22\x1b\\\x1b[6;16;8t\x1b[?65;4;6;18;22c"
TMUX = "\x1bP>|tmux 3.5a\x1b\\\x1b[?1;2;4c"
PAGE = "\x1bP>|tuisim 1\x1b\\\x1b[6;42;19t\x1b[?1;2c"
PLAIN = "\x1b[?1;2c"


def _messages(*parts: str) -> list[Message]:
    parser = AnswerParser()
    return [message for part in parts for message in parser.feed(part)]


def _read(*reads: tuple[float, str]) -> list[Message]:
    """Return what a driver gets that reads at these times, in seconds: it lets the parser look at the time after each
    read, and each tenth of a second."""
    parser = AnswerParser()
    now = 0.0
    found: list[Message] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(queries, "monotonic", lambda: now)
        for until, text in reads:
            while now + 0.1 < until:
                now += 0.1
                found += parser.tick()
            now = until
            found += [*parser.feed(text), *parser.tick()]
    return found


def _keys(messages: list[Message]) -> list[str]:
    return [message.key for message in messages if isinstance(message, events.Key)]


def _facts(text: str) -> TerminalFacts:
    found = [message.facts for message in _messages(text) if isinstance(message, TerminalAnswered)]
    return found[-1] if found else TerminalFacts()


CHOICES = {
    "xterm with sixel": (XTERM, Graphics(Protocol.SIXEL, (7, 14))),
    "kitty": (KITTY + KITTY_YES, Graphics(Protocol.KITTY, (10, 20))),
    "kitty before the second answer": (KITTY, None),
    "kitty without placeholders": (OLD_KITTY + OLD_KITTY_AGAIN, None),
    "kitty that cannot show a picture": (KITTY + KITTY_YES + KITTY_ERROR, None),
    "kitty that could show the next picture": (KITTY + KITTY_YES + KITTY_ERROR + KITTY_YES, None),
    "kitty after it was resized": (KITTY + KITTY_YES + KITTY, Graphics(Protocol.KITTY, (10, 20))),
    "a page": (PAGE + KITTY_YES, Graphics(Protocol.KITTY, (19, 42), most_points=32)),
    "a page that is asked twice": (
        PAGE + PAGE + KITTY_YES,
        Graphics(Protocol.KITTY, (19, 42), most_points=32),
    ),
    "a page that changes": (
        PAGE + PLAIN + KITTY_YES,
        Graphics(Protocol.KITTY, (19, 42), most_points=32),
    ),
    "a page that was resized before it answered": (
        PAGE + PLAIN + KITTY_YES + PLAIN,
        Graphics(Protocol.KITTY, (19, 42), most_points=32),
    ),
    "no graphics": (GHOSTTY_NO, None),
    "iTerm2": (ITERM, Graphics(Protocol.ITERM, (8, 17))),
    "WezTerm": (WEZTERM, Graphics(Protocol.ITERM, (8, 16))),
    "tmux does not know its terminal": (TMUX, None),
    "no pictures": (PLAIN, None),
    "only the kernel knows the size": (
        "\x1bP>|XTerm(379)\x1b\\\x1b[?63;4c",
        Graphics(Protocol.SIXEL, (9, 18)),
    ),
    "no answer": ("", None),
    "size of a cell as small as a pixel": (
        "\x1b[6;1;1t\x1b[?63;4c",
        Graphics(Protocol.SIXEL, (9, 18)),
    ),
    "size that cannot be": ("\x1b[6;0;7t\x1b[?63;4c", Graphics(Protocol.SIXEL, (9, 18))),
}


@for_rows("answers, expected", CHOICES)
def test_the_terminals_answers_decide_which_graphics_protocol_is_used(
    answers: str, expected: Graphics | None
) -> None:
    assert choose_graphics(_facts(answers), AUTO, (9, 18)) == expected


def test_a_graphics_protocol_that_the_user_chooses_is_used() -> None:
    assert choose_graphics(TerminalFacts(), Protocol.SIXEL, None) == Graphics(
        Protocol.SIXEL, (8, 16)
    )
    assert choose_graphics(_facts(TMUX), Protocol.SIXEL, (9, 18)) == Graphics(
        Protocol.SIXEL, (9, 18), in_tmux=True
    )
    assert choose_graphics(_facts(XTERM), NO_PIXELS, None) is None
    assert choose_graphics(_facts(KITTY), Protocol.KITTY, None) == Graphics(
        Protocol.KITTY, (10, 20)
    )


@pytest.mark.parametrize(
    "answers", [OLD_KITTY + OLD_KITTY_AGAIN, KITTY + KITTY_YES + KITTY_ERROR], ids=["no", "error"]
)
def test_a_chosen_protocol_is_not_used_if_the_terminal_answers_that_it_cannot(answers: str) -> None:
    assert choose_graphics(_facts(answers), Protocol.KITTY, None) is None


def test_kitty_graphics_are_asked_for_once() -> None:
    assert _facts(OLD_KITTY).asks_for_kitty
    assert not _facts(OLD_KITTY + OLD_KITTY_AGAIN).asks_for_kitty
    assert not _facts(KITTY + KITTY_YES).asks_for_kitty


def test_a_reloaded_page_is_asked_for_kitty_graphics_again() -> None:
    assert _facts(PAGE + PAGE).asks_for_kitty
    assert _facts(PAGE + PLAIN + PAGE).asks_for_kitty
    assert not _facts(PAGE + KITTY_YES + PAGE).asks_for_kitty


@pytest.mark.parametrize(
    "size_px, expected",
    [((960, 640), (8, 16)), ((120, 40), None), ((0, 0), None), ((65535, 65535), None)],
    ids=["pixels", "cells", "nothing", "too large"],
)
def test_a_nonsensical_cell_size_from_the_kernel_is_ignored(
    size_px: tuple[int, int], expected: tuple[int, int] | None
) -> None:
    main, other = os.openpty()
    try:
        fcntl.ioctl(other, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, *size_px))
        assert read_cell_size_px(other) == expected
    finally:
        os.close(main)
        os.close(other)


def test_sixel_is_not_used_if_the_cells_size_is_unknown() -> None:
    assert choose_graphics(_facts("\x1b[?63;4c"), AUTO, None) is None


@for_each(answers=[XTERM, KITTY + KITTY_YES, KITTY + KITTY_ERROR, TMUX], size=[1, 2, 7, 1000])
def test_answers_of_the_terminal_are_never_taken_for_keys(answers: str, size: int) -> None:
    text = f"a{answers}b"
    found = _messages(*(text[at : at + size] for at in range(0, len(text), size)))
    assert [message.key for message in found if isinstance(message, events.Key)] == ["a", "b"]
    assert any(isinstance(message, TerminalAnswered) for message in found)


@for_each(at=range(1, len(XTERM)))
def test_an_answer_of_the_terminal_split_into_two_reads_is_not_taken_for_keys(at: int) -> None:
    assert not _keys(_read((0.0, XTERM[:at]), (0.05, XTERM[at:]), (1.0, "")))


def test_a_second_answer_split_into_two_reads_is_not_taken_for_keys(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(AnswerParser, "is_asked", True)
    size = "\x1b[6;14;7t"
    assert not _keys(_messages("\x1b[6;16;8t", size[:1], size[1:], "\x1b[?63;4c"))
    assert not AnswerParser.is_asked


def test_keys_after_an_unfinished_answer_of_the_terminal_are_not_lost() -> None:
    typed = [(10.0 + second, "a") for second in range(3)]
    assert _keys(_read((0.0, "\x1bP>|XTerm(3"), *typed)) == ["a", "a", "a"]


KEYS = {
    "escape": ("\x1b", "escape"),
    "page down": ("\x1b[6~", "pagedown"),
    "ctrl+page down": ("\x1b[6;5~", "ctrl+pagedown"),
}


@cases("text, key", KEYS)
def test_keys_that_begin_like_an_answer_of_the_terminal_are_read_as_keys(
    text: str, key: str
) -> None:
    parser = AnswerParser()
    found = [*parser.feed(text), *parser.tick(), *parser.feed("")]
    assert [message.key for message in found if isinstance(message, events.Key)] == [key]
