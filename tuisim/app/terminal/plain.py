"""Text for a terminal that shows ASCII only: for each character one that means the same, and is as wide."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

from rich.cells import cell_len

_SIGNS = {
    "·": ".", "•": "*", "…": "~", "×": "x", "°": " ", "±": "~", "–": "-", "—": "-", "−": "-", "⌀": "D", "Δ": "d",
    "←": "<", "↑": "^", "→": ">", "↓": "v", "◀": "<", "▲": "^", "△": "^", "▶": ">", "▸": ">", "▼": "v", "▽": "v",
    "●": "*", "○": "o", "◆": "*", "◇": "o", "■": "#", "□": "o", "▮": "#", "█": "#", "✓": "v", "✗": "x", "♪": "~",
    "⏎": "E", "↵": "E", "⇧": "S", "⌫": "B", "‘": "'", "’": "'", "“": '"', "”": '"', "░": ".", "▒": ":", "▓": "%",
    "▀": '"', "↕": "|", "‹": "<", "›": ">",
    "▄": "_", "▌": "[", "▐": "]", "▁": "_", "▔": "~", "▏": "|", "▕": "|", "⌷": "#",
}  # fmt: skip
_ELLIPSIS = re.compile(r" … |…  |[A-Za-z0-9]{2}…")
"""An ellipsis with the blanks beside it, or the end of a word that was cut, which three dots replace."""
_BY_DOTS = " .':;+*#@"


def as_ascii(text: str) -> str:
    """Return a text of the same width in ASCII."""
    return text if text.isascii() else "".join(map(_as_ascii, _ELLIPSIS.sub("...", text)))


@lru_cache(maxsize=4096)
def _as_ascii(char: str) -> str:
    if char.isascii():
        return char
    if (sign := _SIGNS.get(char)) is not None:
        return sign
    code = ord(char)
    if 0x2800 <= code < 0x2900:
        return _BY_DOTS[(code - 0x2800).bit_count()]
    if 0x2500 <= code < 0x2580:
        return _line(unicodedata.name(char))
    if 0x2580 <= code < 0x25A0:
        return "#"
    plain = unicodedata.normalize("NFKD", char)[0]
    return plain if plain.isascii() and cell_len(char) == 1 else "?" * cell_len(char)


def _line(name: str) -> str:
    """Return the sign for a line of a frame."""
    if "DIAGONAL" in name:
        return "X" if "CROSS" in name else "/" if "UPPER RIGHT TO LOWER LEFT" in name else "\\"
    across = any(word in name for word in ("HORIZONTAL", "LEFT", "RIGHT"))
    upright = any(word in name for word in ("VERTICAL", "UP", "DOWN"))
    if across and upright:
        return "+"
    heavy = "HEAVY" in name or "DOUBLE" in name
    return ("=" if heavy else "-") if across else ("#" if heavy else "|")
