"""Panels: one file per panel, and the table of them.

To add a panel: write its file, a `Widget` with `TITLE` and `show(snapshot)`, and add a line to `PANELS`. Its key, its
place on the screen, the help and the command palette follow from the line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import ClassVar, Protocol, cast, runtime_checkable

from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import Snapshot

SMALL, MEDIUM, LARGE = "small", "medium", "large"
"""Terminal sizes: from 80×24, from 112×34, from 170×50."""

MAIN, BOTTOM, SIDE = "main", "bottom", "side"
"""Areas of the screen: the main area, the strip below it, the column beside both."""


class Panel(Protocol):
    """The interface of a panel, in addition to `Widget`."""

    TITLE: ClassVar[str]

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment; almost free if nothing has changed."""


@runtime_checkable
class NextRunPanel(Protocol):
    """The additional interface of a panel that edits the plan of the next run."""

    def show_next_run(self, plan: NextRun) -> None:
        """Show a plan."""


@dataclass(frozen=True, slots=True)
class PanelInfo:
    """One line of `PANELS`. Rows and columns include the border."""

    id: str
    title: str
    key: str
    path: str
    """Module in this package, and class; imported when the panel is first shown."""
    place: str
    sizes: tuple[str, ...]
    """Terminal sizes at which it is on by default."""
    min_rows: int
    good_rows: int
    """Preferred height: filled before another panel gets more than its minimum."""
    weight: int = 1
    """Its share of the width among panels that are side by side."""

    def load(self) -> type[Panel]:
        """Import the panel's class."""
        module, _, name = self.path.partition(":")
        return cast("type[Panel]", getattr(import_module(f"{__name__}.{module}"), name))


ALL = (SMALL, MEDIUM, LARGE)

# By priority: if space runs out, the later ones are hidden first.
PANELS: Mapping[str, PanelInfo] = {
    panel.id: panel
    for panel in (
        PanelInfo("world", "World", "W", "world:World", MAIN, ALL, 8, 14),
        PanelInfo("instrumentation", "Instrumentation", "i", "instrumentation:Instrumentation", SIDE, ALL, 8, 15),
        PanelInfo("output", "Output", "O", "output:Output", BOTTOM, ALL, 5, 9, weight=3),
        PanelInfo("arrays", "Sensor arrays", "A", "arrays:Arrays", SIDE, (MEDIUM, LARGE), 8, 13),
        PanelInfo("code", "Code", "D", "code:Code", BOTTOM, (MEDIUM, LARGE), 5, 9, weight=4),
        PanelInfo("chart", "Chart", "c", "chart:Chart", BOTTOM, (LARGE,), 8, 16, weight=5),
        PanelInfo("controls", "Simulator controls", "H", "controls:Controls", SIDE, (MEDIUM, LARGE), 11, 12),
        PanelInfo("positioning", "Positioning", "X", "position:Positioning", SIDE, (LARGE,), 8, 8),
        PanelInfo("noise", "Noise", "z", "noise:Noise", SIDE, (LARGE,), 6, 6),
        PanelInfo("debug", "Debug", "G", "debug:Debug", SIDE, (), 9, 18),
        PanelInfo("brick", "Brick", "K", "brick:Brick", BOTTOM, (), 9, 20, weight=4),
        PanelInfo("obstacles", "Obstacles", "B", "obstacles:Obstacles", SIDE, (), 11, 16),
        PanelInfo("settings", "Settings", "Z", "settings:Settings", SIDE, (), 14, 40),
    )
}
"""Every panel by id."""
