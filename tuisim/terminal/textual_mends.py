"""What Textual's own screens and lists get wrong, mended."""

from __future__ import annotations

from typing import Literal

from textual._compositor import Compositor, CompositorMap, ReflowResult
from textual.events import Click
from textual.geometry import Size
from textual.widget import Widget
from textual.widgets import OptionList


class ThoroughCompositor(Compositor):
    """Compares a layout with the last layout that the widgets were told.

    Textual compares it with the map of all widgets, and makes that map anew when somebody asks for the size of a widget
    between two layouts. To a widget that was mounted in between it would never send `Resize` or `Show`, and one that
    was removed would stay on the screen. Whether somebody asks in between depends on how busy the machine is.
    """

    def __init__(self) -> None:
        super().__init__()
        self._told: CompositorMap = {}

    def reflow(self, parent: Widget, size: Size) -> ReflowResult:
        """Lay out the widgets, and return which of them are hidden, shown and resized since they were last told."""
        before = self._full_map
        hidden, shown, resized = super().reflow(parent, size)
        told, self._told = self._told, self._full_map
        if before is not told:
            shown = shown | (self._told.keys() - told.keys())
            resized = resized | {
                widget
                for widget in self._told.keys() & told.keys()
                if self._told[widget].region.size != told[widget].region.size
            }
            changes = (geometry for _, geometry in self._told.items() ^ told.items())
            self._dirty_regions.update(filter(None, (one.clip.intersection(one.region) for one in changes)))
        return ReflowResult(hidden, shown, resized)


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
