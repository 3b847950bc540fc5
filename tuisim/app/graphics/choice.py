"""Which protocol a terminal is drawn with."""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.app.graphics import kitty
from tuisim.app.graphics.picture import Graphics, Protocol
from tuisim.app.terminal.queries import TerminalFacts

INLINE_IMAGES: Mapping[str, str] = {
    "iTerm2": "https://iterm2.com/documentation-images.html",
    "WezTerm": "https://wezterm.org/imgcat.html",
}
"""Terminals that show inline images of iTerm2."""

DEFAULT_CELL_PX = (8, 16)
"""Size of a cell if neither the terminal nor the kernel tells."""


def graphics_of(facts: TerminalFacts, wanted: Protocol | None, cell_px: tuple[int, int] | None) -> Graphics | None:
    """Return how a terminal is drawn with pixels; None if it cannot, or does not tell.

    Args:
        facts: What it has answered.
        wanted: A protocol that the user knows it has; None to choose.
        cell_px: Width and height of a cell as the kernel knows them.
    """
    protocol = wanted or _protocol_of(facts)
    if protocol is None:
        return None
    # A terminal that scales its window, as on many laptops, draws in its own pixels, not the kernel's.
    return Graphics(protocol, facts.cell_px or cell_px or DEFAULT_CELL_PX, in_tmux=facts.program == "tmux")


def _protocol_of(facts: TerminalFacts) -> Protocol | None:
    name = facts.program
    if name in kitty.TERMINALS and facts.has_kitty_graphics:
        return Protocol.KITTY
    if name in INLINE_IMAGES:
        return Protocol.ITERM
    if facts.has_sixel and (facts.cell_px or name == "tmux"):
        return Protocol.SIXEL
    return None
