"""The glyphs of the world: the option, the test card, and the choice that is kept."""

from __future__ import annotations

import pytest
from textual.widgets import OptionList

from tests.app.app_help import LOGS, ready, screen_text, settings, until
from tuisim.app.app import LabApp
from tuisim.app.dialogs.cells import CellsCard
from tuisim.settings.user_config import CELL_SET, UserConfig
from tuisim.terminal import picture_mode as modes
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.glyphs import GLYPHS
from tuisim.terminal.picture_mode import PictureMode, choose_picture_mode
from tuisim.terminal.picture_options import CellSet


@pytest.fixture(autouse=True)
def known_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(modes, "choose_cells", lambda **_: CellSet.SEXTANT)


def started(cells: str | None) -> PictureMode:
    """How an app that starts draws pictures."""
    return choose_picture_mode(cells, str(UserConfig.load().value(CELL_SET)))


def glyphs(view: PixelView) -> set[str]:
    """The glyphs of a picture."""
    return {GLYPHS[cell >> 48] for cell in view._cells.ravel().tolist()}


@pytest.mark.quick_cases("80x24")
@pytest.mark.parametrize("size", [(80, 24), (60, 18), (120, 40)], ids=["80x24", "60x18", "120x40"])
async def test_the_dialog_for_glyph_sets_shows_each_set_and_stores_the_chosen_one(
    size: tuple[int, int],
) -> None:
    async with LabApp(settings(LOGS), started(None)).run_test(size=size) as pilot:
        app = await ready(pilot)
        assert app.picture_mode.cells is CellSet.SEXTANT
        await pilot.press("V")
        await until(pilot, lambda: isinstance(app.screen, CellsCard))
        listed = app.screen.query_one(OptionList)
        card = app.screen.query_one(PixelView)
        listed.highlighted = listed.get_option_index("octant")
        await until(
            pilot, lambda: any("\U0001cd00" <= glyph <= "\U0001cde5" for glyph in glyphs(card))
        )
        assert app.screen.query_one(".dialog").region.contains_region(card.region)
        await pilot.press("enter")
        world = app.panel_area.screen.query_one("WorldView", PixelView)
        await until(
            pilot, lambda: any("\U0001cd00" <= glyph <= "\U0001cde5" for glyph in glyphs(world))
        )

    assert started(None).cells is CellSet.OCTANT
    assert started("half").cells is CellSet.HALF
    assert started("auto").cells is CellSet.SEXTANT


async def test_a_narrow_dialog_for_glyph_sets_says_what_each_set_is() -> None:
    async with LabApp(settings(LOGS), started(None)).run_test(size=(65, 58)) as pilot:
        await ready(pilot)
        await pilot.press("V")
        await until(pilot, lambda: "2 × 4 points, Unicode 16" in screen_text(pilot.app))
