"""The test card: a picture in each set of glyphs, to choose by eye."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.chooser import ListDialog
from tuisim.app.dialogs.dialog import WIDTHS, name_and_title
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.picture_options import AUTO, CellSet
from tuisim.terminal.pixels import Pixels

_SETS = {
    AUTO: "finest known to work here",
    CellSet.HALF: "1 × 2 points in a cell",
    CellSet.QUADRANT: "2 × 2 points",
    CellSet.SEXTANT: "2 × 3 points, Unicode 13",
    CellSet.OCTANT: "2 × 4 points, Unicode 16",
    CellSet.BRAILLE: "2 × 4 dots",
    CellSet.ASCII: "for any terminal",
}
_ADVICE = (
    "Choose the last one that shows a round disc, a straight line and three greys. Boxes, question marks, gaps or "
    "shifted rows mean that the font lacks these glyphs."
)
_NAME_CELLS = 9
_SAMPLES = 4
"""Each point of the picture is the mean of so many samples in each direction, which smooths its edges."""


def draw_test_card(cols: int, rows: int, cell_px: tuple[int, int]) -> Pixels:
    """Return the picture by which the user compares sets of glyphs: a disc, a line and three greys.

    Args:
        cols: Width of the picture in cells.
        rows: Height of the picture in cells.
        cell_px: Width and height of a cell in pixels.
    """

    def compute_middles(cells: int, points: int, size: float) -> npt.NDArray[np.float64]:
        count = cells * points * _SAMPLES
        return (np.arange(count) + 0.5) * size / count

    # The unit is the height of the picture; cells are twice as high as wide.
    wide = cols / rows / 2
    x, y = (
        compute_middles(cols, cell_px[0], wide)[None],
        compute_middles(rows, cell_px[1], 1.0)[:, None],
    )
    fine = np.full((y.size, x.size, 3), 255.0)
    fine[np.hypot(x - 0.42, y - 0.5) < 0.36] = 200, 30, 30
    fine[np.abs((x - 0.85) - (1 - y) * 0.3) < 0.04] = 0
    for index, grey in enumerate((220, 211, 128)):
        left = 1.25 + index * (wide - 1.3) / 3
        fine[(x >= left) & (x < left + (wide - 1.3) / 4) & (np.abs(y - 0.5) < 0.36)] = grey
    blocks = fine.reshape(rows * cell_px[1], _SAMPLES, cols * cell_px[0], _SAMPLES, 3)
    picture: Pixels = np.rint(blocks.mean(axis=(1, 3))).astype(np.uint8)
    return picture


class _TestCard(PixelView):
    """The picture by which the user compares sets of glyphs, drawn with the set that is highlighted in the list."""

    def __init__(self, best: CellSet) -> None:
        super().__init__()
        self._best = best
        self._tried = best

    @property
    def graphics(self) -> None:
        """None, since the test picture is drawn with glyphs even where the terminal can draw pixels."""

    @property
    def cell_set(self) -> CellSet:
        return self._tried

    def show(self, name: str) -> None:
        """Draw the picture with a set of glyphs, given by its name or `AUTO`."""
        self._tried = self._best if name == AUTO else CellSet(name)
        self.draw_picture()

    def draw_picture(self) -> None:
        """Draw the test picture for the present size of the widget."""
        cell = self.choose_cell(None)
        if self.size.width and self.size.height:
            self.set_fine_picture(
                draw_test_card(self.size.width, self.size.height, (cell.cols, cell.rows))
            )


class CellsCard(ListDialog):
    """The dialog with a test picture in each set of glyphs; it returns the name of the chosen set.

    Args:
        current: The name of the set that is chosen now, or `AUTO`.
        best: The set that `auto` stands for.
    """

    TITLE_TEXT: str = "Glyphs of the world"
    HINT: str = "Enter selects · Escape closes"
    HORIZONTAL_BREAKPOINTS: list[tuple[int, str]] | None = WIDTHS

    def __init__(self, current: str, best: CellSet) -> None:
        super().__init__()
        self._current = current
        self._best = best

    def compose_content(self) -> ComposeResult:
        listed = OptionList(
            *(
                Option(name_and_title(name, title, _NAME_CELLS), id=name)
                for name, title in _SETS.items()
            )
        )
        listed.highlighted = list(_SETS).index(self._current)
        with Horizontal(classes="cells"):
            yield listed
            with Vertical():
                yield _TestCard(self._best)
        yield Static(Text(_ADVICE), id="message")

    @on(OptionList.OptionHighlighted)
    def _show_set(self, event: OptionList.OptionHighlighted) -> None:
        self.query_one(_TestCard).show(event.option.id or AUTO)
