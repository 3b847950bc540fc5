"""The terminal while no app draws on it: what it can show, by its environment and its answers, and how to restore it.

No terminal tells whether its font has a glyph. One that does not know a character drops it, as tmux 3.3a does, or draws
a box. So fine glyphs are taken only from terminals that are known to draw them themselves, without a font.
"""

from __future__ import annotations

import curses
import os
import re
import select
import subprocess
import sys
import termios
import time
import tty
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from tuisim.terminal import kitty
from tuisim.terminal.picture_options import AUTO, CellSet
from tuisim.terminal.queries import (
    ANSWER,
    ATTRIBUTES_QUERY,
    KITTY_QUESTIONS,
    NAME_QUERY,
    QUESTIONS,
    TerminalFacts,
    parse_facts,
    read_cell_size_px,
)

ANSWER_S = 0.4
"""The longest time to wait for a terminal's answer."""
_OCTANT = "\U0001cd02"
WIDTH_QUERY = f"\r{_OCTANT}\x1b[6n"
"""Prints an octant at the left edge and asks for the position of the cursor."""
_CLEAR = "\r\x1b[K"
_POSITION = re.compile(rb"\x1b\[\d+;(\d+)R")
_NAME_AND_VERSION = re.compile(r"([A-Za-z0-9]+)[ (/-]*v?([\d.-]*)")

_PLAIN = ("", "dumb", "unknown")
"""Values of TERM that tell nothing about the terminal."""

Version = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Drawn:
    """From which versions on a terminal program draws sextants and octants itself, without a font."""

    sextants: Version
    octants: Version | None
    source: str


TERMINALS: Mapping[str, Drawn] = {
    "kitty": Drawn((0, 20), (0, 40), "https://sw.kovidgoyal.net/kitty/changelog/"),
    "foot": Drawn((1, 9), (1, 21), "https://codeberg.org/dnkl/foot/src/branch/master/CHANGELOG.md"),
    "ghostty": Drawn((1, 0), (1, 2), "https://ghostty.org/docs/install/release-notes/1-2-0"),
    "WezTerm": Drawn((20220319,), None, "https://wezterm.org/changelog.html"),
    "VTE": Drawn((6600,), None, "https://gitlab.gnome.org/GNOME/vte/-/blob/master/src/minifont.cc"),
}
"""Terminals by the name that they answer to XTVERSION. A version that is missing here gets quadrants; `--cells`, or
the test card in the app, chooses any other set."""


def find_cells(name: str, octant_cols: int | None) -> CellSet:
    """Return the finest set of glyphs that a terminal with UTF-8 is known to show.

    Args:
        name: The name that the terminal answered to XTVERSION, see `name_around`; empty without an answer.
        octant_cols: By how many columns an octant moved the terminal's cursor; None if the terminal did not answer.
    """
    match = _NAME_AND_VERSION.match(name)
    known = TERMINALS.get(match[1]) if match else None
    if match is None or known is None or octant_cols != 1:
        return CellSet.QUADRANT
    version = tuple(int(part) for part in re.findall(r"\d+", match[2]))
    if known.octants is not None and version >= known.octants:
        return CellSet.OCTANT
    return CellSet.SEXTANT if version >= known.sextants else CellSet.QUADRANT


def read_cells(environment: Mapping[str, str], *, has_colors: bool = True) -> CellSet | None:
    """Return the set of glyphs that the environment decides on; None if the terminal must be asked.

    Args:
        environment: The environment with which the process was started: Python changes the locale C to UTF-8.
        has_colors: Whether colours are used: without them only braille and signs show greys.
    """
    terminal = environment.get("TERM", "")
    if terminal in _PLAIN or not _may_be_utf8(environment):
        return CellSet.ASCII
    if terminal == "linux":
        # The fonts of the Linux console have the characters of code page 437, which has no braille.
        return CellSet.HALF if has_colors else CellSet.ASCII
    return None if has_colors else CellSet.BRAILLE


def read_colors(environment: Mapping[str, str]) -> str:
    """Return the colour depth that the environment gives for the terminal; `auto` lets Textual find it."""
    terminal = environment.get("TERM", "")
    if is_multiplexer(terminal):
        around = find_colors(terminal.partition(".")[2] or terminal)
        if around != AUTO:
            return around
        if has_all_colors(environment):
            return "truecolor"
        return "256"
    return find_colors(terminal)


def find_colors(terminal: str) -> str:
    """Return the colour depth of a kind of terminal, as in TERM; `auto` if the kind does not determine it."""
    if terminal in _PLAIN or terminal.startswith(("vt1", "vt2", "vt3")):
        return "none"
    if terminal in ("linux", "ansi"):
        # The Linux console has eight colours for backgrounds.
        return "8"
    return AUTO if has_terminfo_colors(terminal) else "none"


def has_terminfo_colors(terminal: str) -> bool:
    """Return whether a kind of terminal has colours according to terminfo; True for an unknown kind.

    curses reads one entry in a process: later calls return the result for the kind of the first call.
    """
    try:
        curses.setupterm(terminal, sys.__stdout__.fileno() if sys.__stdout__ else -1)
        return curses.tigetnum("colors") > 0
    except (OSError, ValueError, curses.error):
        return True


_MULTIPLEXER = "screen"
"""The beginning of TERM in GNU screen, and in tmux unless its settings say otherwise."""
_TMUX_ANSWER_S = 1.0
_ALL_COLORS = "RGB"
"""The feature of a terminal with all colours, as tmux calls it."""


def is_multiplexer(terminal: str) -> bool:
    """Return whether a kind of terminal, as in TERM, is GNU screen, or tmux under the name of GNU screen.

    GNU screen shows reverse video for the code that means italics.
    """
    return terminal == _MULTIPLEXER or terminal.startswith((f"{_MULTIPLEXER}-", f"{_MULTIPLEXER}."))


def has_all_colors(environment: Mapping[str, str]) -> bool:
    """Return whether tmux says that the terminal around it shows 24-bit colours; False without tmux or in GNU screen.

    COLORTERM does not tell, as a multiplexer inherits this variable from the terminal around it. GNU screen cannot be
    asked; before version 5, it takes the code of a 24-bit colour for blinking, underlined text. The variable STY says
    that it runs, perhaps inside tmux.
    """
    return _ALL_COLORS in _ask_tmux("client_termfeatures", environment).split(",")


def name_around(name: str, environment: Mapping[str, str]) -> str:
    """Return the name that a terminal answered; for tmux, the name of the terminal around it if tmux knows that.

    tmux passes glyphs on, and the terminal around it draws them.
    """
    return (name.startswith("tmux") and _ask_tmux("client_termtype", environment)) or name


def _ask_tmux(what: str, environment: Mapping[str, str]) -> str:
    """Return what tmux knows of the terminal around it.

    The result is empty if tmux does not know it, or is not the innermost program.

    Args:
        what: The name of one of tmux's format variables, such as `client_termname`.
        environment: The environment of this process.
    """
    if "TMUX" not in environment or "STY" in environment:
        return ""
    command = ["tmux", "display-message", "-p", f"#{{{what}}}"]
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=_TMUX_ANSWER_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip()


WEB_DRIVER = "textual.drivers.web_driver:WebDriver"
"""The driver that a server such as textual-serve names in the environment of an app in a browser."""


def is_in_browser() -> bool:
    """Return whether a server has started this process to show its app in a browser."""
    return os.environ.get("TEXTUAL_DRIVER") == WEB_DRIVER


def _may_be_utf8(environment: Mapping[str, str]) -> bool:
    """Return whether the locale is UTF-8, or is not set, as in many containers."""
    locale = next(
        (value for name in ("LC_ALL", "LC_CTYPE", "LANG") if (value := environment.get(name))), ""
    )
    return not locale or "utf-8" in locale.lower() or "utf8" in locale.lower()


def read_first_environment() -> Mapping[str, str]:
    """Return the environment with which this process was started, or the present one if the system does not know it."""
    try:
        entries = Path("/proc/self/environ").read_bytes().split(b"\0")
    except OSError:
        return os.environ
    pairs = (os.fsdecode(entry).partition("=") for entry in entries if b"=" in entry)
    return {name: value for name, _, value in pairs}


def choose_cells(*, ask: bool = True, has_colors: bool = True) -> CellSet:
    """Return the finest set of glyphs that this terminal is known to show.

    Args:
        ask: Whether to ask the terminal if the environment does not decide.
        has_colors: Whether colours are used.
    """
    environment = {**read_first_environment(), "TERM": os.environ.get("TERM", "")}
    decided = read_cells(environment, has_colors=has_colors)
    if decided is not None or not ask:
        return decided or CellSet.QUADRANT
    try:
        return _ask_terminal()
    except (OSError, termios.error, ValueError):
        return CellSet.QUADRANT


SILENT = ("", "dumb", "unknown", "linux")
"""Kinds of terminals that are not asked: they may show the questions as text."""
_ROUND_TRIPS = 3


@dataclass(frozen=True, slots=True)
class Answers:
    """The answers of a terminal to all queries of the app, and the shortest time that it took to answer one."""

    facts: TerminalFacts = field(default_factory=TerminalFacts)
    octant_cols: int | None = None
    """By how many columns an octant moved the cursor; None if it did not answer."""
    latency_s: float | None = None
    """The shortest time that an answer took; None if there was none."""
    cell_px: tuple[int, int] | None = None
    """Width and height of a cell as the kernel knows them."""


def ask_everything(fd: int) -> Answers:
    """Ask a terminal all questions of the app, and measure how long it takes to answer.

    Args:
        fd: The terminal, open for reading and writing.

    Raises:
        OSError, termios.error: it is no terminal, or lost.
    """
    before = termios.tcgetattr(fd)
    try:
        tty.setcbreak(fd, termios.TCSANOW)
        octant_cols = _parse_cols(_ask_width(fd, fd))
        latency_s = _measure_latency_s(fd)
        if latency_s is None:
            return Answers(octant_cols=octant_cols)
        text = _ask(fd, QUESTIONS, _has_attributes, fd)
        facts = parse_facts(text.decode("latin-1"))
        if facts.asks_for_kitty:
            text += _ask(fd, KITTY_QUESTIONS, _has_attributes, fd)
        return Answers(
            parse_facts(text.decode("latin-1")), octant_cols, latency_s, read_cell_size_px(fd)
        )
    finally:
        # Drop late answers, which the shell would take for typed text.
        termios.tcsetattr(fd, termios.TCSAFLUSH, before)


def _measure_latency_s(fd: int) -> float | None:
    times_s = []
    for _ in range(_ROUND_TRIPS):
        begun = time.monotonic()
        if not parse_facts(
            _ask(fd, ATTRIBUTES_QUERY, _has_attributes, fd).decode("latin-1")
        ).attributes:
            break
        times_s.append(time.monotonic() - begun)
    return min(times_s, default=None)


def _ask_width(fd: int, output: int | None = None) -> bytes:
    """Print an octant; return the terminal's answer, which says where the cursor is after it.

    Args:
        fd: The terminal, open for reading.
        output: The terminal, open for writing; None if `fd` is that, too.
    """
    answer = _ask(fd, WIDTH_QUERY, _POSITION.search, output)
    _write(_CLEAR, output)
    return answer


def _parse_cols(answer: bytes) -> int | None:
    """Return by how many columns an octant has moved the cursor, from a terminal's answer; None without an answer."""
    position = _POSITION.search(answer)
    return int(position[1]) - 1 if position else None


def _has_attributes(answer: bytes) -> bool:
    return bool(parse_facts(answer.decode("latin-1")).attributes)


def _ask_terminal() -> CellSet:
    """Return the finest set of glyphs that the terminal of standard input and output shows, by asking it.

    First an octant is printed, and the terminal is asked where its cursor is. It is asked for its name only after it
    has answered that the cursor has moved by one column. A late answer would be taken for keys, so a terminal that does
    not answer is asked as little as possible.
    """
    fd = sys.stdin.fileno()
    before = termios.tcgetattr(fd)
    position = b""
    try:
        tty.setcbreak(fd, termios.TCSANOW)
        position = _ask_width(fd)
        cols = _parse_cols(position)
        if cols != 1:
            return find_cells("", cols)
        answers = _ask(fd, NAME_QUERY + ATTRIBUTES_QUERY, _has_attributes)
        position += answers
        return find_cells(
            name_around(parse_facts(answers.decode("latin-1")).name, os.environ), cols
        )
    finally:
        _typed.append(_strip_answers(position))
        termios.tcsetattr(fd, termios.TCSANOW, before)


_typed: list[bytes] = []
"""What the user typed while the terminal was asked: input that was read together with the answers."""


def take_typed() -> str:
    """Return what the user has typed while the terminal was being asked; later calls return an empty text."""
    typed = b"".join(_typed).decode(errors="replace")
    _typed.clear()
    return typed


def _strip_answers(data: bytes) -> bytes:
    text = _POSITION.sub(b"", data).decode("latin-1")
    return ANSWER.sub("", text).encode("latin-1")


def _ask(
    fd: int, query: str, is_answered: Callable[[bytes], object], output: int | None = None
) -> bytes:
    _write(query, output)
    answer = b""
    give_up = time.monotonic() + ANSWER_S
    while not is_answered(answer) and (left := give_up - time.monotonic()) > 0:
        if select.select([fd], [], [], left)[0]:
            data = os.read(fd, 1024)
            if not data:
                break
            answer += data
    return answer


def _write(text: str, output: int | None = None) -> None:
    with suppress(OSError):
        os.write(sys.stdout.fileno() if output is None else output, text.encode())


_OFF = "".join(
    f"\x1b[?{mode}l" for mode in (1000, 1002, 1003, 1015, 1006, 1016, 1004, 2004, 2026, 2048)
)
"""Mouse, focus, bracketed paste, synchronized output and reports of the size."""
RESTORING = f"\x1b[<u{_OFF}\x1b[?1049l\x1b[?7h\x1b[?25h\x1b[0m\x1b(B\x0f\r"
"""Ends the keyboard protocol of kitty on the screen of the app, then that screen; lines wrap, the cursor is visible."""


def restore_terminal(fd: int, term: str) -> None:
    """Undo the settings of a terminal that an app, or another program, has left when it was killed.

    Args:
        fd: The terminal, open for reading and writing.
        term: The variable TERM.

    Raises:
        OSError: the terminal is lost.
    """
    # Images are deleted only where the codes are not shown as text: most terminals ignore codes that they do not know.
    os.write(fd, (RESTORING if term in SILENT else RESTORING + kitty.DELETE_ALL).encode())
    with suppress(termios.error):
        attributes = termios.tcgetattr(fd)
        attributes[:4] = _build_sane_modes(*attributes[:4])
        termios.tcsetattr(fd, termios.TCSAFLUSH, attributes)


def _build_sane_modes(iflag: int, oflag: int, cflag: int, lflag: int) -> list[int]:
    """Return the modes of a terminal, in which those flags that apps change are set as `stty sane` sets them.

    Args:
        iflag, oflag, cflag, lflag: The present modes, as in `termios.tcgetattr`.
    """
    iflag = (iflag | termios.BRKINT | termios.ICRNL | termios.IXON | termios.IMAXBEL) & ~(
        termios.INLCR | termios.IGNCR
    )
    oflag |= termios.OPOST | termios.ONLCR
    lflag |= termios.ISIG | termios.ICANON | termios.IEXTEN
    lflag |= termios.ECHO | termios.ECHOE | termios.ECHOK | termios.ECHOCTL | termios.ECHOKE
    return [iflag, oflag, cflag, lflag]
