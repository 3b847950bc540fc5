"""A compositor that tells every widget its size, and draws all that has changed: Textual's leaves out some of it."""

from __future__ import annotations

from textual._compositor import Compositor, CompositorMap, ReflowResult
from textual.geometry import Size
from textual.widget import Widget


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
