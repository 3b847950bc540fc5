"""The mat picker."""

from __future__ import annotations

from textual import on
from textual.app import ComposeResult
from textual.widgets import OptionList
from textual.widgets.option_list import Option

from tuisim.ui.screens.dialog import Dialog, name_and_title


class MatPicker(Dialog[str]):
    """Every mat by name and title; gives the name.

    Args:
        current: The mat that lies there now.
    """

    TITLE_TEXT: str = "Mats"
    HINT: str = "Enter lays it out · Escape closes"

    def __init__(self, current: str) -> None:
        super().__init__()
        self._current = current

    def content(self) -> ComposeResult:
        """The list."""
        from tuisim.assets import backgrounds

        mats = backgrounds()
        wide = max(map(len, mats), default=0)
        options = [Option(name_and_title(name, mat.title, wide), id=name) for name, mat in mats.items()]
        listed = OptionList(*options)
        if self._current in mats:
            listed.highlighted = list(mats).index(self._current)
        yield listed

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option.id)
