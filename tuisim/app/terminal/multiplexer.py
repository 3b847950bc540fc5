"""The colours of GNU screen and tmux, which stand between an app and its terminal."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping

KIND = "screen"
"""What TERM begins with in GNU screen, and in tmux unless it is told otherwise."""
_ANSWER_S = 1.0
_ALL_COLORS = "RGB"
"""The feature of a terminal with all colours, as tmux calls it."""


def is_multiplexer(terminal: str) -> bool:
    """Return whether a kind of terminal, as in TERM, is GNU screen, or tmux under that name.

    It takes the code for italics for that of reverse video.
    """
    return terminal == KIND or terminal.startswith((f"{KIND}-", f"{KIND}."))


def has_all_colors(environment: Mapping[str, str]) -> bool:
    """Return whether the multiplexer says that it shows all colours.

    COLORTERM is no answer: it was inherited from the terminal around it. GNU screen before version 5 takes the numbers
    of such a colour for blinking, underlined and coloured text, and has no way to be asked. tmux has; inside GNU screen
    (STY) it may be the one around it.
    """
    if "TMUX" not in environment or "STY" in environment:
        return False
    command = ["tmux", "display-message", "-p", "#{client_termfeatures}"]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=_ANSWER_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return _ALL_COLORS in done.stdout.strip().split(",")
