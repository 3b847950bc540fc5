"""The mat picker: every mat by name, with a preview of the selected one, or a custom image."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app import background
from tuisim.app.dialogs.chooser import ListDialog
from tuisim.app.render.mat import Pixels, shrink
from tuisim.app.render.viewport import whole_field
from tuisim.app.terminal.cell_view import PixelView
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.config.mats import Background

WIDEST_NAME = 32
"""Most columns of the list: a custom file may have any name."""


class MatPicker(ListDialog):
    """Returns the name of the chosen mat, or the path of an image.

    Args:
        current: The current mat, as named in a specification.
        known: All mats by name.
        folder: The user's own folder of mats; None for the default one only.
    """

    TITLE_TEXT: str = "Mats"
    HINT: str = "Enter lays it out · tab to the field · Escape closes"

    def __init__(self, current: str, known: Mapping[str, Background], folder: str | None) -> None:
        super().__init__()
        self._current, self._mats, self._folder = current, known, folder
        self._shown = ""
        self._pictures: dict[tuple[str, int, int], Pixels] = {}

    def content(self) -> ComposeResult:
        """Return the list, the preview, and a path field."""
        from tuisim.config.mats import spec_name

        listed = OptionList(*(Option(name, id=name) for name in self._mats), markup=False)
        listed.styles.width = min(max(map(len, self._mats), default=0) + 5, WIDEST_NAME)
        names = [spec_name(mat) for mat in self._mats.values()]
        listed.highlighted = names.index(self._current) if self._current in names else 0
        with Horizontal(classes="mats"):
            yield listed
            with Vertical():
                yield PixelView()
                yield Static(id="title", markup=False)
        yield Input(placeholder="Or the path of an image of your own", compact=True, select_on_focus=False)

    def on_mount(self) -> None:
        """Set the height of the preview from its width."""
        self.call_after_refresh(self._begin)

    def on_resize(self) -> None:
        """Fit the preview to the new width."""
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        view = self.query_one(PixelView)
        view.styles.height = max(1, round(view.size.width * FIELD_HEIGHT_MM / FIELD_WIDTH_MM / 2))
        self.call_after_refresh(self._show_again)

    def _show_again(self) -> None:
        # Show the current selection: it may have changed meanwhile.
        self._show(self._shown)

    @on(OptionList.OptionHighlighted)
    def _highlighted(self, event: OptionList.OptionHighlighted) -> None:
        self._show(event.option.id or "")

    def _show(self, name: str) -> None:
        """Preview a mat: its title at once, its image as soon as it is decoded."""
        self._shown = name
        view = self.query_one(PixelView)
        if name not in self._mats or not view.size:
            return
        self.query_one("#title", Static).update(self._mats[name].title)
        width, height = view.size.width, 2 * view.size.height
        if (picture := self._pictures.get((name, width, height))) is not None:
            view.set_picture(picture)
        else:
            work = partial(self._decode, name, width, height, view.ground_rgb)
            then, failed = partial(self._decoded, (name, width, height)), partial(self._failed, name)
            background.run(self, work, then, failed, group="picture", exclusive=True)

    def _decode(self, name: str, width: int, height: int, outside_rgb: tuple[int, int, int]) -> Pixels:
        from tuisim.config.mat_image import decode, read_file
        from tuisim.config.mats import find_mat

        found = find_mat(name, self._folder)
        mat = decode(read_file(found.image), found.image, found.fit or "stretch")
        return shrink(mat, whole_field(width, height), outside_rgb)

    def _decoded(self, key: tuple[str, int, int], picture: Pixels) -> None:
        self._pictures[key] = picture
        if not self.is_attached or key[0] != self._shown:
            return
        view = self.query_one(PixelView)
        if key[1:] == (view.size.width, 2 * view.size.height):
            view.set_picture(picture)
        else:
            # The view got its height while the image was decoded.
            self._show_again()

    def _failed(self, name: str, error: TuisimError) -> None:
        if self.is_attached and name == self._shown:
            self.query_one(PixelView).clear_picture()
            self.query_one("#title", Static).update(str(error))
