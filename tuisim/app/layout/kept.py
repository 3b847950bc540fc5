"""The arrangement that the user has made, kept for the next start: panels and preset."""

from __future__ import annotations

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
    with suppress(OSError):
        keep(_NAME, {**_table(preference(_NAME)), size: {"preset": layout.preset.value, "panels": panels}})


def drop_former() -> bool:
    """Forget what earlier versions kept and no layout has any more: moved borders, and the preset to teach.

    Returns:
        Whether there was any.
    """
    kept = _table(preference(_NAME))
    known = {part: of for part, of in kept.items() if part != "borders" and _table(of).get("preset") != "teach"}
    if known == kept:
        return False
    with suppress(OSError):
        keep(_NAME, known)
    return True


def _table(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
