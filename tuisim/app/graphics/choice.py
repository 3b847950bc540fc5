"""Which protocol a terminal is drawn with."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tuisim.app.graphics.picture import Graphics, Protocol
from tuisim.app.terminal.queries import TerminalFacts

PLACEHOLDERS: Mapping[str, str] = {
    "kitty": "https://sw.kovidgoyal.net/kitty/graphics-protocol/#unicode-placeholders (since 0.28)",
    "ghostty": "https://ghostty.org/docs/features (kitty graphics protocol with Unicode placeholders)",
}
"""Terminals that show images of kitty's protocol at placeholders, by name, and where that is written."""
INLINE_IMAGES: Mapping[str, str] = {
    "iTerm2": "https://iterm2.com/documentation-images.html",
    "WezTerm": "https://wezterm.org/imgcat.html",
}
"""Terminals that show inline images of iTerm2."""

_NAME = re.compile(r"[A-Za-z0-9]+")
DEFAULT_CELL_PX = (8, 16)
"""Size of a cell if neither the terminal nor the kernel tells."""


def asks_for_kitty(facts: TerminalFacts) -> bool:
    """Return whether a terminal may know kitty's protocol, and has not been asked yet."""
    return facts.has_kitty_graphics is None and name_of(facts) in PLACEHOLDERS


def name_of(facts: TerminalFacts) -> str:
    """Return the name of a terminal without its version; empty if it does not tell."""
    found = _NAME.match(facts.name)
    return found[0] if found else ""


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
    return Graphics(protocol, facts.cell_px or cell_px or DEFAULT_CELL_PX, in_tmux=name_of(facts) == "tmux")


def _protocol_of(facts: TerminalFacts) -> Protocol | None:
    name = name_of(facts)
    if name in PLACEHOLDERS and facts.has_kitty_graphics:
        return Protocol.KITTY
    if name in INLINE_IMAGES:
        return Protocol.ITERM
    if facts.has_sixel and (facts.cell_px or name == "tmux"):
        return Protocol.SIXEL
    return None
