"""Which protocol a terminal is drawn with."""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.terminal.graphics import kitty
from tuisim.terminal.graphics.picture import Graphics
from tuisim.terminal.picture_options import AUTO, NO_PIXELS, Protocol
from tuisim.terminal.queries import TerminalFacts

INLINE_IMAGES: Mapping[str, str] = {
    "iTerm2": "https://iterm2.com/documentation-images.html",
    "WezTerm": "https://wezterm.org/imgcat.html",
}
"""Terminals that show inline images of iTerm2."""

TMUX = "tmux"
"""What tmux answers to XTVERSION."""

DEFAULT_CELL_PX = (8, 16)
"""Size of a cell if neither the terminal nor the kernel tells."""


def graphics_of(facts: TerminalFacts, wanted: str, cell_px: tuple[int, int] | None) -> Graphics | None:
    """Return how a terminal is drawn with pixels; None if it cannot, does not tell, or should not.

    Args:
        facts: What it has answered.
        wanted: One of `PIXELS`.
        cell_px: Width and height of a cell as the kernel knows them.
    """
    if wanted == NO_PIXELS:
        return None
    protocol = _protocol_of(facts) if wanted == AUTO else Protocol(wanted)
    if protocol is Protocol.KITTY and facts.has_kitty_graphics is False:
        # Its answer counts for more than a wish: the world would be black.
        return None
    # A terminal that scales its window, as on many laptops, draws in its own pixels, not the kernel's.
    known_px = facts.cell_px or cell_px
    if protocol is None or (protocol is Protocol.SIXEL and wanted == AUTO and known_px is None):
        return None
    return Graphics(protocol, known_px or DEFAULT_CELL_PX, in_tmux=facts.program == TMUX)


def _protocol_of(facts: TerminalFacts) -> Protocol | None:
    name = facts.program
    if name == TMUX:
        # Built with sixel, it says so whatever its own terminal can; elsewhere it shows frames with a text.
        return None
    if name in kitty.TERMINALS and facts.has_kitty_graphics:
        return Protocol.KITTY
    if name in INLINE_IMAGES:
        return Protocol.ITERM
    return Protocol.SIXEL if facts.has_sixel else None
