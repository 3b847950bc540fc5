"""The colours that only the app has, of its one dark design; themes replace each of them."""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.base import palette

GROUND = "#10151c"
RAISED = "#18202a"
BAR = "#1c242e"
TRACK = "#2a333d"
DONE_GROUND = "#2c4a2c"
CHOSEN = "#2f4a66"
FOCUS_GROUND = "#2f5f8f"
BUTTON = "#4a4f57"
FAINT = "#5f6f80"
THUMB = "#6a7a8c"
ERROR_GROUND = "#6e1f28"
DISABLED = "#7c8b9a"
SUBTITLE = "#7f8fa1"
PALE = "#8fa0b2"
FOOTER = "#b8c4d0"
LIGHT = "#e8e8e8"
RED = "#ff6e6e"
"""Colour of errors."""
STRING = "#a6d189"
NUMBER = "#ffaf6e"
KEYWORD = "#d7a0ff"
"""Colour of Python's keywords in the program's text, and of the marks of user actions in the time bar."""
BUILTIN = "#87d7ff"
NAME = "#9fd3ff"
BREAKPOINT = "#ff8787"
WAITING = "#d7af5f"
EVENT = "#ffaf5f"
PRESSED = "#ffd866"

COLORS: Mapping[str, str] = {
    name: color for name, color in {**vars(palette), **globals()}.items() if name.isupper()
}
"""The colours of this module and of the palette, by name."""
