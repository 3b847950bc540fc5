"""Panels: one file per panel, and the table of them.

To add a panel: write its file, a `Widget` with `show(snapshot)`, and add a line to `PANELS`. Its title, its key,
its place on the screen, the help and the command palette follow from the line. Handlers of its messages are
methods of `app.panel_messages`; data over time, instead of one instant, come from `app.feed`; an option or a world
file that shows it needs a line in `OPTIONS`.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast, runtime_checkable

from tuisim.base.data_class import dataclass

if TYPE_CHECKING:
    from tuisim.app.setup.next_run import NextRun
    from tuisim.app.snapshot import Snapshot


class TerminalSize(StrEnum):
    """The class of a terminal's size, which decides which panels are shown at the start."""

    SMALL = "small"
    """A terminal that is smaller than a medium one, such as 80×24."""
    MEDIUM = "medium"
    """A terminal of at least 100 columns and 30 rows that is not large."""
    LARGE = "large"
    """A terminal of at least 170 columns and 50 rows."""


class PanelPlace(StrEnum):
    """The area of the screen in which a panel is usually shown."""

    MAIN = "main"
    BOTTOM = "bottom"
    """The strip below the main area of the screen."""
    SIDE = "side"
    """The column beside the main area and the strip."""


class Panel(Protocol):
    """The interface that each panel has besides the interface of `Widget`."""

    def show(self, snapshot: Snapshot) -> None:
        """Show an instant of the run; takes almost no time if nothing has changed."""


@runtime_checkable
class NextRunPanel(Protocol):
    """The interface of a panel that edits the plan of the next run; such a panel also has the interface `Panel`."""

    def show_next_run(self, plan: NextRun) -> None:
        """Show the plan of the next run."""


@dataclass(frozen=True, slots=True)
class PanelInfo:
    """The key, the area and the sizes of a panel, which the app knows without importing its class.

    Rows and columns include the border.
    """

    id: str
    title: str
    key: str
    """The panel's key in Textual's notation, such as `f9`; `action.label_of_key` returns its display name."""
    path: str
    """The panel's module in this package, and after a colon its class; imported when the panel is first shown."""
    place: PanelPlace
    sizes: tuple[TerminalSize, ...]
    """Terminal sizes at which the panel is shown by default."""
    min_rows: int
    fair_rows: int
    """Height in rows with which the panel shows all its content, but compactly."""
    good_rows: int
    """Preferred height in rows."""
    weight: int = 1
    """Share of the space, relative to panels beside it or that grow with it. Lines of examples are whole at 200×60."""
    grows: bool = False
    """Whether the panel makes use of more rows than `good_rows`."""
    min_cols: int = 24
    """Minimum width in columns beside another panel; that of *Output* has room for a printed fraction in one line."""

    def load(self) -> type[Panel]:
        """Import the panel's class and return it."""
        module, _, name = self.path.partition(":")
        return cast("type[Panel]", getattr(import_module(f"{__name__}.{module}"), name))


_MAIN, _BOTTOM, _SIDE = PanelPlace
_ALL = tuple(TerminalSize)
_MEDIUM_UP = (TerminalSize.MEDIUM, TerminalSize.LARGE)
_LARGE = (TerminalSize.LARGE,)

# The order is the priority: if space runs out, the later panels are hidden first.
PANELS: Mapping[str, PanelInfo] = {
    panel.id: panel
    for panel in (
        PanelInfo("world", "World", "W", "world:World", _MAIN, _ALL, 8, 14, 14),
        PanelInfo("lesson", "Lesson", "E", "lesson:LessonPanel", _SIDE, (), 11, 24, 40, grows=True),
        PanelInfo(
            "instrumentation",
            "Instrumentation",
            "i",
            "instrumentation:Instrumentation",
            _SIDE,
            _ALL,
            4,
            13,
            16,
        ),
        PanelInfo(
            "output",
            "Output",
            "O",
            "output:Output",
            _BOTTOM,
            _ALL,
            5,
            7,
            9,
            weight=13,
            grows=True,
            min_cols=28,
        ),
        PanelInfo("arrays", "Sensor arrays", "A", "arrays:Arrays", _SIDE, _MEDIUM_UP, 8, 10, 13),
        PanelInfo(
            "code", "Code", "D", "code:Code", _BOTTOM, _MEDIUM_UP, 5, 11, 20, weight=29, grows=True
        ),
        PanelInfo(
            "chart",
            "Chart",
            "c",
            "chart:Chart",
            _BOTTOM,
            _MEDIUM_UP,
            8,
            14,
            16,
            weight=28,
            grows=True,
        ),
        PanelInfo(
            "controls",
            "Simulator controls",
            "H",
            "controls:Controls",
            _SIDE,
            _LARGE,
            11,
            11,
            12,
        ),
        PanelInfo(
            "positioning", "Positioning", "X", "position:Positioning", _SIDE, _LARGE, 8, 8, 8
        ),
        PanelInfo("noise", "Noise", "z", "noise:Noise", _SIDE, _LARGE, 6, 6, 6),
        PanelInfo("debug", "Debug", "G", "debug:Debug", _SIDE, (), 7, 10, 18, grows=True),
        PanelInfo(
            "brick", "Brick", "K", "brick:Brick", _BOTTOM, (), 9, 12, 20, weight=28, grows=True
        ),
        PanelInfo(
            "obstacles", "Obstacles", "B", "obstacles:Obstacles", _SIDE, (), 11, 12, 16, grows=True
        ),
        PanelInfo("goals", "Goals", "J", "goals:Goals", _SIDE, (), 9, 20, 20, grows=True),
        PanelInfo(
            "settings", "Settings", "Z", "settings:Settings", _SIDE, (), 14, 15, 40, grows=True
        ),
    )
}
"""All panels by id."""
