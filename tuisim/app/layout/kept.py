"""The arrangement that the user has made, kept for the next start: panels, preset, and borders that were moved."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from tuisim.app.layout.arrangement import Preset
from tuisim.app.panels import PANELS, TerminalSize
from tuisim.config.preferences import keep, preference

_NAME = "layout"


@dataclass
class KeptLayout:
    """The arrangement for a size of the terminal."""

    preset: Preset = Preset.STANDARD
    asked: dict[str, bool] = field(default_factory=dict)
    """Panels that were shown or hidden by their keys, the latest last."""


def load_layout(size: TerminalSize) -> KeptLayout:
    """Return what was kept for a size; what is damaged or unknown is left out."""
    found = _table(preference(_NAME)).get(size)
    kept = _table(found)
    layout = KeptLayout()
    with suppress(ValueError):
        layout.preset = Preset(str(kept.get("preset", "")))
    rows = kept.get("panels")
    for row in rows if isinstance(rows, list) else []:
        match row:
            case [str(panel), bool(on)] if panel in PANELS:
                layout.asked[panel] = on
            case _:
                pass
    return layout


def save_layout(size: TerminalSize, layout: KeptLayout) -> None:
    """Keep an arrangement; without a writable folder it lasts until the app ends."""
    # A list: the order counts, and the file sorts the keys of tables.
    panels = [[panel, on] for panel, on in layout.asked.items()]
    _save(size, {"preset": layout.preset.value, "panels": panels})


def load_borders(shape: str) -> dict[str, float]:
    """Return the borders that were moved in a form of the screen: share of their split, by name."""
    borders = _table(_table(preference(_NAME)).get("borders"))
    return {
        name: float(share)
        for name, share in _table(borders.get(shape)).items()
        if isinstance(share, int | float) and 0 < share < 1
    }


def save_borders(shape: str, moved: Mapping[str, float]) -> None:
    """Keep the borders that were moved in a form of the screen; none forgets them."""
    borders = _table(_table(preference(_NAME)).get("borders"))
    shapes = {**borders, shape: {name: round(share, 4) for name, share in moved.items()}}
    _save("borders", {name: of for name, of in shapes.items() if of})


def _save(part: str, value: object) -> None:
    with suppress(OSError):
        keep(_NAME, {**_table(preference(_NAME)), part: value})


def _table(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
