"""How pictures are drawn on the terminal: with which glyphs, colours or pixels, and how finely at present."""

from __future__ import annotations

import os
import termios
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any
from typing import Protocol as TypingProtocol

from rich.console import Console
from textual import constants
from textual.app import App
from textual.timer import Timer
from textual.widget import Widget

from tuisim.terminal import kitty
from tuisim.terminal.cells import MONO, PALETTE_8, PALETTE_16, PALETTE_256, TRUECOLOR
from tuisim.terminal.picture import MAX_PAGE_POINTS, MAX_POINTS, Graphics
from tuisim.terminal.picture_options import AUTO, BLOCKS, NO_PIXELS, CellSet, Protocol
from tuisim.terminal.pixels import Rgb
from tuisim.terminal.probe import (
    SILENT,
    Answers,
    ask_everything,
    choose_cells,
    find_cells,
    is_in_browser,
    name_around,
    read_cells,
    read_colors,
    read_first_environment,
)
from tuisim.terminal.queries import TerminalFacts
from tuisim.terminal.textual_internals import SUPPORTED


class Recoloring(TypingProtocol):
    """A mapping from the app's own colours to other colours, such as those of a theme."""

    def rgb(self, own: Rgb) -> Rgb:
        """Return the colour that replaces one of the app's own colours; any other colour is returned unchanged."""

    def choose_text_rgb(self, own: Rgb) -> Rgb:
        """Return the colour that replaces one of the app's own colours in text and lines, legible on the background."""


@dataclass(slots=True)
class PictureMode:
    """How an app draws pictures: the set of glyphs, the colours, and pixels if the terminal has them."""

    cells: CellSet = CellSet.HALF
    chosen: str = AUTO
    """The user's choice of glyphs: `AUTO`, or the name of a set."""
    best: CellSet = CellSet.HALF
    """The finest set that the terminal is known to show."""
    graphics: Graphics | None = None
    """How pixels are drawn; None to draw cells."""
    most_colors: int = TRUECOLOR
    """The user's limit of the number of colours."""
    theme: Recoloring | None = None
    """The colours in place of the app's own ones; None for those."""
    is_slow: Callable[[], bool] = lambda: False
    """Whether the link to the terminal is too slow for fine cells now."""
    is_idle: Callable[[], bool] = lambda: True
    """Whether the terminal has shown everything that was sent."""

    def choose(self, chosen: str) -> None:
        """Switch to a set of glyphs, given by its name; `AUTO` is the best one for the terminal."""
        self.chosen, self.cells = chosen, self.best if chosen == AUTO else CellSet(chosen)


def choose_colors(colors: str) -> int:
    """Set the colour depth of the terminal, such as `256` or `none`; `auto` takes it from the environment.

    Returns:
        The largest number of colours with which pictures may be drawn.
    """
    if colors == "auto":
        colors = read_colors(os.environ)
    system = {"truecolor": "truecolor", "256": "256", "16": "standard", "8": "standard"}.get(colors)
    if system:
        # Textual reads the environment when it is imported, before the settings are known.
        constants.COLOR_SYSTEM = system  # type: ignore[misc]
    if colors == "none":
        os.environ["NO_COLOR"] = "1"
    return PALETTE_8 if colors == "8" else TRUECOLOR


def choose_picture_mode(argument: str | None, stored: str) -> PictureMode:
    """Return how a starting app draws pictures.

    Args:
        argument: The set of glyphs, or `AUTO`, that the user requests now; None for no request.
        stored: The set that the user has chosen before, perhaps on another terminal.
    """
    chosen = argument or stored
    # Textual decides in the same way whether there are colours.
    has_colors = "NO_COLOR" not in os.environ
    if is_in_browser():
        best = CellSet.QUADRANT if has_colors else CellSet.BRAILLE
    elif not SUPPORTED and has_colors:
        best = CellSet.HALF
    else:
        best = choose_cells(ask=chosen == AUTO, has_colors=has_colors)
    if argument is None and (best is CellSet.ASCII or (not has_colors and chosen in BLOCKS)):
        # The stored set was chosen on another terminal, and this one cannot show it.
        chosen = AUTO
    return PictureMode(best if chosen == AUTO else CellSet(chosen), chosen, best)


_DEPTHS = {"standard": PALETTE_16, "windows": PALETTE_16, "256": PALETTE_256}
"""Number of colours by the name of Rich's colour system."""


def find_color_depth(app: App[Any]) -> int:
    """Return the number of colours with which an app draws; full colour if the terminal does not say.

    If the user wants no colours, block glyphs are drawn in greys, so that the number is above 1 for them.
    """
    picture_mode = find_picture_mode(app)
    if app.no_color and picture_mode.cells not in BLOCKS:
        return MONO
    return min(_DEPTHS.get(app.console.color_system or "", TRUECOLOR), picture_mode.most_colors)


def is_ascii(app: App[Any]) -> bool:
    """Return whether an app draws with ASCII characters only."""
    return find_picture_mode(app).cells is CellSet.ASCII


def find_picture_mode(app: App[Any]) -> PictureMode:
    """Return how an app draws pictures."""
    mode = getattr(app, "picture_mode", None)
    return mode if isinstance(mode, PictureMode) else PictureMode()


INLINE_IMAGES: Mapping[str, str] = {
    "iTerm2": "https://iterm2.com/documentation-images.html",
    "WezTerm": "https://wezterm.org/imgcat.html",
}
"""Terminals that show inline images of iTerm2."""

TMUX = "tmux"
"""What tmux answers to XTVERSION."""

DEFAULT_CELL_PX = (8, 16)
"""Size of a cell if neither the terminal nor the kernel tells."""


def choose_graphics(
    facts: TerminalFacts, choice: str, cell_px: tuple[int, int] | None
) -> Graphics | None:
    """Return how pixels are drawn in a terminal; None if it cannot or should not show pixels, or does not say.

    Args:
        facts: What the terminal has answered.
        choice: One of `PIXELS`.
        cell_px: Width and height of a cell in pixels, as the kernel knows them.
    """
    if choice == NO_PIXELS:
        return None
    protocol = _find_protocol(facts) if choice == AUTO else Protocol(choice)
    if protocol is Protocol.KITTY and facts.has_kitty_graphics is False:
        # The terminal's answer counts for more than the user's wish: pictures would be black.
        return None
    # A terminal that scales its window, as on many laptops, draws in its own pixels, not the kernel's.
    known_px = facts.cell_px or cell_px
    if protocol is None or (protocol is Protocol.SIXEL and choice == AUTO and known_px is None):
        return None
    most_points = MAX_PAGE_POINTS if facts.program == kitty.PAGE else MAX_POINTS
    return Graphics(protocol, known_px or DEFAULT_CELL_PX, facts.program == TMUX, most_points)


@dataclass(frozen=True, slots=True)
class TerminalReport:
    """What a terminal can show, according to its environment and its answers."""

    name: str
    """Name of the terminal by its own answer; empty without an answer."""
    colors: str
    """Colour depth of the terminal, one of `COLOR_DEPTHS` other than `auto`."""
    has_colors: bool
    """Whether the terminal has colours according to TERM and NO_COLOR."""
    has_fixed_colors: bool
    """Whether TERM or NO_COLOR alone decides on the colours."""
    cells: CellSet
    """The finest set of glyphs that the terminal is known to show."""
    is_limited: bool
    """Whether TERM alone limits `cells`."""
    protocol: str
    """Protocol with which pixels are drawn; empty if none are."""
    is_asked: bool
    latency_s: float | None
    """The shortest time that an answer took; None if there was none."""
    environment: Mapping[str, str]
    """The environment as it was when this process started."""


def describe_terminal(fd: int, environment: Mapping[str, str]) -> TerminalReport | None:
    """Ask a terminal for its abilities, and return a report on them; None if the terminal is lost.

    Args:
        fd: The terminal, open for reading and writing.
        environment: The environment of the app.
    """
    term = environment.get("TERM", "")
    first = read_first_environment()
    is_asked = term not in SILENT
    try:
        answers = ask_everything(fd) if is_asked else Answers()
    except (OSError, termios.error):
        return None
    # Textual draws without colours even if the variable is empty.
    colors = "none" if "NO_COLOR" in environment else read_colors(environment)
    has_colors = colors != "none"
    cells = read_cells({**first, "TERM": term}, has_colors=has_colors)
    graphics = choose_graphics(answers.facts, AUTO if has_colors else NO_PIXELS, answers.cell_px)
    return TerminalReport(
        name=answers.facts.name,
        colors=_find_textual_colors(environment) if colors == AUTO else colors,
        has_colors=has_colors,
        has_fixed_colors=colors != AUTO,
        cells=cells
        or find_cells(name_around(answers.facts.name, environment), answers.octant_cols),
        is_limited=read_cells({**first, "TERM": "xterm"}) is not cells,
        protocol=graphics.protocol if graphics else "",
        is_asked=is_asked,
        latency_s=answers.latency_s,
        environment=first,
    )


def _find_textual_colors(environment: Mapping[str, str]) -> str:
    system = Console(force_terminal=True, _environ=environment).color_system
    depths = {"truecolor": "truecolor", "256": "256", "standard": "16", "windows": "16"}
    return depths.get(system or "", "none")


def _find_protocol(facts: TerminalFacts) -> Protocol | None:
    name = facts.program
    if name == TMUX:
        # tmux built with sixel says so whatever its own terminal can; where that cannot, it shows a frame with a text.
        return None
    if name in kitty.TERMINALS and facts.has_kitty_graphics:
        return Protocol.KITTY
    if name in INLINE_IMAGES:
        return Protocol.ITERM
    return Protocol.SIXEL if facts.has_sixel else None


REFINE_S = 0.1
"""Time between two steps in which a coarse picture becomes fine."""
_STILL_S = 0.3


class Sharpness:
    """Draws a coarse picture of a widget more finely when the link has time for that.

    Args:
        widget: Provides the timer.
        refine: Draws some of the picture more finely; returns whether more is to be done.
        still_s: A picture that has not changed for this long counts as still.
    """

    def __init__(
        self, widget: Widget, refine: Callable[[], bool], still_s: float = _STILL_S
    ) -> None:
        self._widget = widget
        self._refine = refine
        self._still_s = still_s
        self._timer: Timer | None = None
        self._is_coarse = False
        self._changed_s = 0.0

    @property
    def is_still(self) -> bool:
        """Whether the picture has not changed for `still_s`."""
        return time.monotonic() - self._changed_s >= self._still_s

    def record_change(self, *, is_coarse: bool = False) -> None:
        """Record that the picture was drawn.

        Args:
            is_coarse: Whether some of it is coarse, so that it has to be drawn more finely later.
        """
        self._changed_s = time.monotonic()
        self._is_coarse = is_coarse
        if is_coarse and self._timer is None:
            self._timer = self._widget.set_interval(REFINE_S, self._step)

    def _step(self) -> None:
        picture_mode = find_picture_mode(self._widget.app)
        if not picture_mode.is_idle() or (picture_mode.is_slow() and not self.is_still):
            return
        if self._is_coarse:
            self._is_coarse = False
            has_more = self._refine()
            # The function may have drawn the picture, and so noted that it is coarse again.
            self._is_coarse = self._is_coarse or has_more
        if not self._is_coarse and self._timer is not None:
            self._timer.stop()
            self._timer = None
