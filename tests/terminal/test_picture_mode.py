"""The app on terminals without Unicode or colours."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pyte
import pytest

import tuisim
from tests.app.app_help import LOGS, ready, settings
from tests.app.wires import on_wire, until_quiet, wire_of
from tests.cases import cases
from tuisim.app.app import LabApp
from tuisim.terminal import probe
from tuisim.terminal.cells import MONO
from tuisim.terminal.frame_buffer import convert_ascii
from tuisim.terminal.picture_mode import PictureMode, choose_picture_mode, find_color_depth
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.probe import read_colors

SOURCES = [
    path for path in Path(tuisim.__file__).parent.rglob("*") if path.suffix in (".py", ".tcss")
]


def test_every_special_character_of_the_app_has_an_ascii_substitute() -> None:
    used = set("".join(path.read_text("utf-8") for path in SOURCES))

    lost = {char for char in used if not char.isascii() and convert_ascii(char) in ("", "?", "??")}
    # Letters of other scripts appear in examples only.
    assert not {char for char in lost if not char.isalpha()} - set("\u200b\ufeff")


@cases(
    "text, plain",
    {
        "frames": ("╭──╮│╰╯┼", "+--+|+++"),
        "heavy frames": ("━┃═", "=#="),
        "braille": ("⠀⠁⣿", " .@"),
        "degrees and ellipses": ("90° 1 … 9 cut…", "90  1...9 c..."),
        "letters": ("é中✓", "e??v"),
    },
)
def test_each_ascii_substitute_has_the_characters_width(text: str, plain: str) -> None:
    assert convert_ascii(text) == plain


@pytest.mark.parametrize(
    "terminal, colors",
    [
        ("dumb", "none"),
        ("", "none"),
        ("vt100", "none"),
        ("vt220", "none"),
        ("linux", "8"),
        ("xterm-256color", "auto"),
    ],
)
def test_the_number_of_colours_follows_the_kind_of_terminal(terminal: str, colors: str) -> None:
    assert read_colors({"TERM": terminal, "COLORTERM": "truecolor"}) == colors


@pytest.mark.slow
@pytest.mark.parametrize("terminal", ["vt52", "xterm-256color"])
def test_terminfo_knows_which_terminals_have_no_colours(terminal: str) -> None:
    code = f"from tuisim.terminal.probe import has_terminfo_colors; print(has_terminfo_colors({terminal!r}))"
    # curses reads one entry a process.
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert done.stdout.strip() == str(terminal == "xterm-256color")


@cases(
    "environment, cells",
    {
        "utf-8": ({"TERM": "vt220", "LANG": "C.UTF-8"}, CellSet.BRAILLE),
        "ascii": ({"TERM": "vt220", "LANG": "C"}, CellSet.ASCII),
        "no braille in its font": ({"TERM": "linux", "LANG": "C.UTF-8"}, CellSet.ASCII),
    },
)
def test_in_a_terminal_without_colours_no_block_glyphs_are_chosen(
    environment: dict[str, str], cells: CellSet, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(probe, "read_first_environment", lambda: environment)
    monkeypatch.setenv("TERM", environment["TERM"])
    monkeypatch.setenv("NO_COLOR", "1")

    assert choose_picture_mode("auto", "auto").cells is cells


@pytest.mark.slow
@cases(
    "cells, most",
    {
        "ascii": (CellSet.ASCII, 0x7F),
        "dots": (CellSet.BRAILLE, 0x28FF),
    },
)
async def test_with_no_color_set_no_colour_codes_are_sent(
    cells: CellSet, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with on_wire(LabApp(settings(LOGS), PictureMode(cells))) as pilot:
        app = await ready(pilot)
        await until_quiet(pilot)
        await pilot.press("question_mark")
        await until_quiet(pilot)
        assert find_color_depth(app) == MONO
        sent = "".join(wire_of(pilot).sent)

    assert max(map(ord, sent)) <= most
    assert "World" in sent
    # The panel with the focus has another frame.
    assert {CellSet.ASCII: "====", CellSet.BRAILLE: "━━━━"}[cells] in sent
    styles = {code for codes in re.findall(r"\x1b\[([\d;]*)m", sent) for code in codes.split(";")}
    assert styles <= {"", "0", "1", "2", "3", "4", "7", "9"}


def _screen(sent: str) -> pyte.Screen:
    screen = pyte.Screen(120, 40)
    pyte.Stream(screen).feed(re.sub(r"\x1b\[[<>=?][0-9;]*[a-zA-Z]|\x1b\[[?>]?[0-9;]*\$p", "", sent))
    return screen


def _reversed_on(sent: str) -> list[str]:
    """Return the texts in reverse video, by row."""
    screen = _screen(sent)
    rows = (
        "".join(screen.buffer[y][x].data for x in range(120) if screen.buffer[y][x].reverse)
        for y in range(40)
    )
    return [row.strip() for row in rows]


@pytest.mark.slow
@cases(
    "keys, lit",
    {
        "an entry of the palette": (["ctrl+p", "down"], "Step over: next line"),
        "a theme": (["f10"], "textual-dark"),
        # The field is bright, and its cursor dark.
        "the cursor in a field": (["o", "x", "y", "z", "left", "left"], "xz"),
    },
)
async def test_with_no_color_set_selected_rows_are_still_marked(
    keys: list[str], lit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with on_wire(LabApp(settings(LOGS), PictureMode(CellSet.ASCII))) as pilot:
        await ready(pilot)
        for key in keys:
            await pilot.press(key)
            await until_quiet(pilot)
        shown = _reversed_on("".join(wire_of(pilot).sent))

    assert any(row.startswith(lit) for row in shown)


@pytest.mark.slow
async def test_in_ascii_without_colours_the_robot_is_drawn_pointing_to_its_heading(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with on_wire(LabApp(settings(LOGS), PictureMode(CellSet.ASCII))) as pilot:
        await ready(pilot)
        await until_quiet(pilot)
        shown = "\n".join(_screen("".join(wire_of(pilot).sent)).display)

    assert ("O-" in shown, "-O" in shown) == (True, False)
