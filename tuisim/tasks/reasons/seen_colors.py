"""The colours that a loop saw and waited for, as its program writes them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.programs.facts import LoopEnd

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]


def describe_colors(loop: LoopEnd, device: str, codes: Array, has_codes: bool) -> str:
    """Return the colour that a loop waited for and the ones that were seen; empty if the loop saw its colour.

    Args:
        loop: The loop.
        device: The sensor that was read, in words.
        codes: Codes of the colours that it read, shape (n,).
        has_codes: Whether `color` is a number in the program's library.
    """
    seen = name_seen(loop, codes)
    color = name_limit(loop)
    if loop.operator != "==" or color in {"", *seen}:
        return ""
    text = f"{device} to see {color}: it saw only {', '.join(seen)}"
    names = [name.lower() for name in COLOR_NAMES]
    if not has_codes or loop.attribute != "color" or not loop.color or not _is_text(loop):
        return text
    code = names.index(loop.color)
    return f"{text}; color is a number ({code} for {color}), color_name is the word"


def _is_text(loop: LoopEnd) -> bool:
    """Return whether a loop compares with a text such as `"Red"`, not with a constant such as `COLOR_RED`."""
    return isinstance(loop.limit, str) and not loop.limit.isupper()


def name_seen(loop: LoopEnd, codes: Array) -> list[str]:
    """Return the colours that were seen, in words; if the loop compares with a text, as the program reads them."""
    names = {COLOR_NAMES[int(code)]: f"{code:g}" for code in codes}
    if not _is_text(loop):
        return sorted("no colour" if name == COLOR_NAMES[0] else name.lower() for name in names)
    return sorted(names.values() if loop.attribute == "color" else map(repr, names))


def name_limit(loop: LoopEnd) -> str:
    """Return the colour that a loop compares with: in words or, if it is a text, as it stands in the program."""
    return repr(loop.limit) if _is_text(loop) else loop.color
