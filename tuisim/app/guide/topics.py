"""What the guide shows first: the page and the keys of the panel with the focus.

To add a panel: add a line to `TOPICS`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tuisim.app.action import KeyWord


@dataclass(frozen=True, slots=True)
class KeyPage:
    """The first page of the guide: how to start, and every key."""

    title: str
    start: str
    groups: Mapping[str, Iterable[KeyWord]]
    """The keys by the name of their group."""


@dataclass(frozen=True, slots=True)
class Topic:
    """What belongs to a panel."""

    page: str = ""
    """Empty for the page with every key."""
    groups: tuple[str, ...] = ()
    """The groups of keys that stand above the page."""


_TIME = ("Program", "Time")

TOPICS: Mapping[str, Topic] = {
    "world": Topic(),
    "lesson": Topic("lessons", ("Lesson",)),
    "instrumentation": Topic("how-sensors-see"),
    "output": Topic("writing-programs", ("Program",)),
    "arrays": Topic("how-sensors-see"),
    "code": Topic("writing-programs", ("In the code", "Program")),
    "chart": Topic("measuring-bands", _TIME),
    "controls": Topic("virtual-time", ("Program",)),
    "positioning": Topic("motion-and-drift", ("Robot",)),
    "noise": Topic("how-sensors-see"),
    "debug": Topic("stepping", ("Debugging",)),
    "brick": Topic("the-brick"),
    "obstacles": Topic("world-files", ("Robot",)),
    "goals": Topic("goal-files"),
    "settings": Topic("options"),
}
"""The topics by id of the panel."""
