"""The colours of the app, of its style sheet and of charts as text: one dark design; themes replace each of them.

Below them those of pages for browsers.
"""

from __future__ import annotations

from collections.abc import Mapping

GROUND = "#10151c"
BLACK = "#101010"
RAISED = "#18202a"
BAR = "#1c242e"
FIELD = "#1c2733"
HERE = "#263545"
TRACK = "#2a333d"
DONE_GROUND = "#2c4a2c"
CHOSEN = "#2f4a66"
FOCUS_GROUND = "#2f5f8f"
LINE = "#44505e"
BUTTON = "#4a4f57"
FAINT = "#5f6f80"
THUMB = "#6a7a8c"
ERROR_GROUND = "#6e1f28"
DISABLED = "#7c8b9a"
SUBTITLE = "#7f8fa1"
PALE = "#8fa0b2"
SOFT = "#9fb0c3"
LABEL = "#a8a8a8"
FOOTER = "#b8c4d0"
INK = "#d8dee6"
LIGHT = "#e8e8e8"
WHITE = "#ffffff"
BLUE = "#5fafff"
"""What has the focus, what a heading says."""
GREEN = "#87d7af"
"""What is well."""
YELLOW = "#ffd75f"
"""What is chosen or to be noticed."""
RED = "#ff6e6e"
"""What is wrong."""
LINK = "#87afff"
STRING = "#a6d189"
NUMBER = "#ffaf6e"
KEYWORD = "#d7a0ff"
"""Of the program's text, and what the user has done."""
BUILTIN = "#87d7ff"
NAME = "#9fd3ff"
BREAKPOINT = "#ff8787"
WAITING = "#d7af5f"
EVENT = "#ffaf5f"
PRESSED = "#ffd866"

COLORS: Mapping[str, str] = {name: color for name, color in globals().items() if name.isupper()}
"""All of them by name."""

MET, PARTLY, MISSED = "#1f8a4c", "#c98a00", "#c0392b"
"""Verdicts on a page for browsers, on a light ground and on a dark one."""

PAGE = """\
:root { color-scheme: light dark; --ink: #1d2329; --soft: #5c6670; --paper: #fff; --rule: #d5dade; --area: #f4f6f8;
  --link: #0b57a4; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #d8dee6; --soft: #9aa6b2; --paper: #14191f; --rule: #38424d; --area: #1c242c; --link: #7db4f0; }
}
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --paper: #fff; --rule: #bbb; --area: #fff; --link: #000; }
}
"""
"""The colours of a page for browsers, as a style sheet with variables: light, dark and on paper."""
