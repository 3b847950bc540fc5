"""Only what differs is sent, and the terminal shows what was meant."""

from __future__ import annotations

import random
from collections.abc import Sequence
from io import StringIO

import pyte
import pytest
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual._compositor import ChopsUpdate, CompositorUpdate, InlineUpdate, LayoutUpdate
from textual.geometry import Region
from textual.strip import Strip

from tests.cases import cases, for_rows
from tuisim.terminal.cell_view import CellStrip
from tuisim.terminal.cells import MONO, PALETTE_8, PALETTE_16, PALETTE_256
from tuisim.terminal.frame_buffer import FrameBuffer, TextMode
from tuisim.terminal.glyphs import GLYPHS

FULL, MODE_256, MODE_16 = TextMode(), TextMode(PALETTE_256), TextMode(PALETTE_16)
MODE_8, PLAIN = TextMode(PALETTE_8), TextMode(MONO, is_ascii=True)
STYLES = (
    None,
    Style(color="#ff0000"),
    Style(color="#ff0000", bgcolor="#000080", bold=True),
    Style(bgcolor="#000080", underline=True),
    Style(color="#00ff00", reverse=True),
    Style(bold=True, italic=True),
)


def sent(frame_buffer: FrameBuffer, update: CompositorUpdate, mode: TextMode = FULL) -> str:
    codes = frame_buffer.encode_update(update, mode)
    assert codes is not None
    return codes


def test_italics_are_not_sent_to_terminals_that_draw_them_reversed() -> None:
    update = rows([Strip([Segment("a", Style(bold=True, italic=True))], 1)])

    assert "\x1b[1;3m" in sent(FrameBuffer(), update)
    assert "\x1b[1m" in sent(FrameBuffer(), update, TextMode(has_italics=False))


def rows(*lines: Sequence[Strip]) -> LayoutUpdate:
    """All of a screen."""
    width = sum(strip.cell_length for strip in lines[0])
    return LayoutUpdate(list(lines), Region(0, 0, width, len(lines)))


def text(words: str, style: Style | None = None) -> Strip:
    return Strip([Segment(words, style)])


def shown(screen: pyte.Screen) -> list[list[tuple[object, ...]]]:
    """What can be seen of each cell; of a blank no more than its ground, unless something is drawn there."""
    cells: list[list[tuple[object, ...]]] = []
    for y in range(screen.lines):
        line = [screen.buffer[y][x] for x in range(screen.columns)]
        cells.append(
            [
                (char.bg,) if char.data == " " and not (char.underscore or char.reverse) else char
                for char in line
            ]
        )
    return cells


@cases(
    "before, after, codes",
    {
        "nothing": ("aaaa", "aaaa", ""),
        "one": ("aaaa", "aaba", "\x1b[1;3Hb"),
        "a short way is written": ("aaaaaa", "baaaab", "\x1b[1;1Hbaaaab"),
        "a long way is jumped": ("aaaaaaaaaa", "baaaaaaaab", "\x1b[1;1Hb\x1b[8Cb"),
        "wide": ("中文", "中国", "\x1b[1;3H国"),
        "wide to narrow": ("中文", "ab文", "\x1b[1;1Hab"),
        "narrow to wide": ("ab文", "中文", "\x1b[1;1H中"),
    },
)
def test_the_frame_buffer_sends_only_changed_text(before: str, after: str, codes: str) -> None:
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([text(before)]))

    assert sent(frame_buffer, rows([text(after)])) == codes


@for_rows(
    "strip, mode, codes",
    {
        "even cells": (CellStrip([0xFF0000_FF0000] * 3), FULL, "\x1b[48;2;255;0;0m   \x1b[0m"),
        "half blocks": (
            CellStrip([0xFF0000_0000FF] * 2),
            FULL,
            "\x1b[38;2;255;0;0;48;2;0;0;255m▀▀\x1b[0m",
        ),
        "256 colours": (CellStrip([0xFF0000_0000FF]), MODE_256, "\x1b[38;5;196;48;5;21m▀\x1b[0m"),
        "16 colours": (CellStrip([0xFF0000_0000FF]), MODE_16, "\x1b[31;44m▀\x1b[0m"),
        "two reds of 16": (CellStrip([0xFF4646_C80000]), MODE_16, "\x1b[91;41m▀\x1b[0m"),
        "8 colours": (CellStrip([0xFF4646_0000FF]), MODE_8, "\x1b[31;44m▀\x1b[0m"),
        "no colours": (CellStrip([100 << 48 | 0xFFFFFF << 24]), PLAIN, f"{GLYPHS[100]}"),
        "dim of 8": (
            Strip([Segment("a", Style(color="#44505e", bgcolor="#10151c"))]),
            MODE_8,
            "\x1b[37;40ma\x1b[0m",
        ),
        "a highlight without colours": (
            Strip(
                [
                    Segment("a", Style(color="#ffffff", bgcolor="#2f4a63")),
                    Segment("b", Style(bgcolor="#10151c")),
                ]
            ),
            PLAIN,
            "\x1b[7ma\x1b[0mb",
        ),
        "ASCII": (Strip([Segment("╭─ 0° · ä 中 ▶")]), PLAIN, "+- 0  . a ?? >"),
        "blanks are alike": (
            Strip([Segment("a b", Style(bold=True)), Segment(" "), Segment("c", Style(bold=True))]),
            FULL,
            "\x1b[1ma b c\x1b[0m",
        ),
        "an attribute ends": (
            Strip([Segment("a", Style(bold=True)), Segment("b")]),
            MODE_256,
            "\x1b[1ma\x1b[0mb",
        ),
    },
)
def test_a_strip_is_written_in_the_bytes_of_each_text_and_colour_mode(
    strip: Strip, mode: TextMode, codes: str
) -> None:
    assert sent(FrameBuffer(), rows([strip]), mode) == f"\x1b[1;1H{codes}"


def test_a_terminal_hyperlink_ends_where_its_text_ends() -> None:
    linked = Strip([Segment("a", Style(link="http://b")), Segment("c")])

    assert sent(FrameBuffer(), rows([linked])).endswith(";http://b\x1b\\a\x1b]8;;\x1b\\c")


@pytest.mark.parametrize("mode", [FULL, MODE_256])
def test_a_picture_below_a_dialog_is_not_sent_again_as_text(mode: TextMode) -> None:
    """Textual makes plain segments of what lies under a dialog; that must not be sent again."""
    cells = CellStrip(
        [
            grey << 40 | grey << 32 | grey << 24 | grey << 16 | grey << 8 | grey
            for grey in range(8, 248)
        ]
    )
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([cells]), mode)

    assert sent(frame_buffer, rows([Strip(list(cells))]), mode) == ""


def test_after_forget_the_frame_buffer_sends_everything_again() -> None:
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([text("word")]))
    frame_buffer.forget()

    assert sent(frame_buffer, rows([text("word")])) == "\x1b[1;1Hword"


def test_after_a_resize_the_frame_buffer_sends_everything_again() -> None:
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([text("words")]))
    frame_buffer.forget()
    sent(frame_buffer, ChopsUpdate([{0: text("words")}], [(0, 0, 5)], [[5]]))

    assert sent(frame_buffer, rows([text("word")])) == "\x1b[1;1Hword"


def test_the_frame_buffer_leaves_an_unknown_kind_of_update_to_textual() -> None:
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([text("word")]))

    assert frame_buffer.encode_update(InlineUpdate([text("else")]), FULL) is None
    assert sent(frame_buffer, rows([text("word")])) == "\x1b[1;1Hword"


def random_row(rng: random.Random) -> list[Strip]:
    """A row of two strips, the right one from column 20 on."""
    strips = []
    for width in (20, 10):
        words = "".join(rng.choice(["a", "b", " ", "─", "中"]) for _ in range(width))
        cuts = sorted(rng.sample(range(width), 3))
        parts = [words[first:last] for first, last in zip([0, *cuts], [*cuts, width], strict=True)]
        whole = Strip([Segment(part, rng.choice(STYLES)) for part in parts])
        strips.append(Strip(list(whole.adjust_cell_length(width))))
    return strips


@pytest.mark.parametrize("seed", range(5))
def test_the_terminal_shows_what_textual_itself_would_have_sent(seed: int) -> None:
    rng = random.Random(seed)
    mine = pyte.Screen(30, 4)
    own = pyte.Screen(30, 4)
    my_stream, own_stream = pyte.Stream(mine), pyte.Stream(own)
    own_console = Console(
        file=StringIO(), force_terminal=True, color_system="truecolor", _environ={}
    )
    frame_buffer = FrameBuffer()
    lines = [random_row(rng) for _ in range(4)]
    for _ in range(8):
        for y in rng.sample(range(4), 2):
            lines[y] = random_row(rng)
        update = rows(*lines)
        my_stream.feed(sent(frame_buffer, update))
        own_stream.feed(update.render_segments(own_console).replace("\n", "\r\n"))

    assert shown(mine) == shown(own)


def test_the_frame_buffer_sends_a_changed_part_of_a_row_at_its_place() -> None:
    frame_buffer = FrameBuffer()
    sent(frame_buffer, rows([text("left"), text("right")], [text("left"), text("right")]))
    part = ChopsUpdate(
        [{0: None, 4: None}, {0: None, 4: text("night")}], [(1, 4, 6)], [[4, 9], [4, 9]]
    )

    assert sent(frame_buffer, part) == "\x1b[2;5Hn"
