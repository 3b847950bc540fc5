"""Presets: which panels they show, in every size of terminal, and that they leave the run alone."""

from __future__ import annotations

import pytest

from tests.app.app_help import (
    LOGS,
    open_lab,
    screen_text,
    until,
)
from tests.cases import for_each
from tuisim.app.layout.arrangement import (
    Preset,
    arrange,
    choose_panels,
    find_core_panels,
    measure_mat,
)
from tuisim.app.layout.tree import PanelLayout
from tuisim.app.panels import PANELS

SIZES = [(80, 24), (100, 30), (120, 40), (160, 48), (200, 60), (300, 100), (60, 80)]
KEYS = {Preset.DRIVE: "f6", Preset.DEBUG: "f7", Preset.ANALYSE: "f8"}

in_each_size = for_each(size=SIZES)
in_each_size_and_preset = for_each(size=SIZES, preset=Preset)


def layout_of(preset: Preset, width: int, height: int) -> PanelLayout:
    wanted, fill = choose_panels(preset, {}, width, height - 1)
    return arrange(wanted, width, height - 1, fill, preset)


@in_each_size_and_preset
def test_each_preset_shows_its_core_panels_and_fills_the_screen(
    preset: Preset, size: tuple[int, int]
) -> None:
    layout = layout_of(preset, *size)
    assert set(find_core_panels(preset, size[0], size[1] - 1)) <= set(layout.boxes)
    assert not layout.left_out
    for panel, box in layout.boxes.items():
        assert box.height >= PANELS[panel].min_rows and box.width >= 24, panel
    assert sum(box.width * box.height for box in layout.boxes.values()) == size[0] * (size[1] - 1)


@in_each_size_and_preset
def test_no_preset_leaves_a_third_of_a_panel_empty(preset: Preset, size: tuple[int, int]) -> None:
    for panel, box in layout_of(preset, *size).boxes.items():
        if panel == "world":
            assert measure_mat(box) > 2 / 3 * (box.width - 2) * (box.height - 3)
        elif not PANELS[panel].grows:
            # Those that grow show more in more rows; the others need the rows of their text.
            assert box.height - 2 < 1.5 * (PANELS[panel].good_rows - 2), panel


def test_most_lines_of_code_are_whole_in_a_medium_terminal() -> None:
    layout = layout_of(Preset.STANDARD, 120, 40)
    assert layout.boxes["code"].width - 2 >= 59 and layout.boxes["code"].height - 2 >= 14
    # The end of a run, with the lines before it.
    assert layout.boxes["output"].height - 2 >= 4
    # Tick boxes, seven rows of curves, from which on the ticks are round numbers, and times.
    assert layout.boxes["chart"].height - 2 >= 9


@in_each_size
def test_the_output_leaves_its_rows_to_the_code_when_debugging(size: tuple[int, int]) -> None:
    boxes = layout_of(Preset.DEBUG, *size).boxes
    assert (
        "output" not in boxes
        or boxes["output"].height <= PANELS["output"].good_rows < boxes["code"].height
    )


@pytest.mark.quick_cases("analyse")
@pytest.mark.parametrize("preset, key", KEYS.items(), ids=KEYS)
async def test_the_key_of_a_preset_shows_it_and_pressed_again_the_standard_layout(
    preset: Preset, key: str
) -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        standard = set(app.panel_area.arrangement.boxes)
        await pilot.press(key)
        core = find_core_panels(preset, 80, 23)
        assert set(core) == set(app.panel_area.arrangement.boxes)
        await until(
            pilot, lambda: all(f" {PANELS[panel].title}" in screen_text(app) for panel in core)
        )
        await pilot.press(key)
        assert set(app.panel_area.arrangement.boxes) == standard


@pytest.mark.slow
@pytest.mark.parametrize(
    "size, round_",
    [
        ((80, 24), ["debug", "analyse", "standard"]),
        ((120, 40), ["drive", "debug", "analyse", "standard"]),
    ],
    ids=["80x24", "120x40"],
)
async def test_f9_cycles_through_the_presets_that_differ_at_this_size(
    size: tuple[int, int], round_: list[str]
) -> None:
    async with open_lab(LOGS, size=size) as (pilot, app):
        shown = []
        for _ in round_:
            before = app.panel_area.arrangement.boxes
            await pilot.press("f9")
            assert app.panel_area.arrangement.boxes != before
            shown.append(str(app.panel_area.preset))
        assert shown == round_


@in_each_size
def test_the_world_stays_with_every_panel_asked_for(size: tuple[int, int]) -> None:
    width, height = size[0], size[1] - 1
    wanted, fill = choose_panels(Preset.STANDARD, dict.fromkeys(PANELS, True), width, height)
    box = arrange(wanted, width, height, fill).boxes["world"]
    # Two rows of panels below it leave it narrower than its panel in a low terminal.
    least = 2 / 3 if height >= 39 else 0.4
    assert measure_mat(box) > least * (box.width - 2) * (box.height - 3)
