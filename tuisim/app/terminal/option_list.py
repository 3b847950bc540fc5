"""Every list of options, also Textual's own: it bears pages without room, and clicks on an option that is gone."""

from __future__ import annotations

from typing import Literal

from textual.events import Click
from textual.widgets import OptionList

_click, _move_page = OptionList._on_click, OptionList._move_page


async def click(listed: OptionList, event: Click) -> None:
    """Choose the option that was clicked on; nothing if the list has become shorter since."""
    at = event.style.meta.get("option", 0)
    if at < listed.option_count:
        await _click(listed, event)


def move_page(listed: OptionList, direction: Literal[-1, 1]) -> None:
    """Move by as many lines as are seen; not in a list without room, which has no lines."""
    if listed.scrollable_content_region:
        _move_page(listed, direction)
