"""The slider: keys, mouse, ends."""

from __future__ import annotations

import pytest
from textual.app import App, ComposeResult

from tuisim.app.form import Slider


class Frame(App[None]):
    def __init__(self) -> None:
        super().__init__()
        self.slider = Slider(128, id="it")
        self.values: list[int] = []

    def compose(self) -> ComposeResult:
        """The slider alone."""
        yield self.slider

    def on_slider_changed(self, message: Slider.Changed) -> None:
        """Keep what it says."""
        self.values.append(message.value)


@pytest.mark.parametrize(
    "keys, expected",
    [
        (["right", "right", "left"], [1, 2, 1]),
        (["left"], []),
        (["shift+right", "pageup", "pagedown"], [10, 20, 10]),
        (["end", "right", "shift+left"], [128, 118]),
        (["end", "home"], [128, 0]),
    ],
    ids=["one", "not below 0", "ten", "not above the end", "ends"],
)
async def test_arrow_and_page_keys_move_the_slider_by_1_or_10(
    keys: list[str], expected: list[int]
) -> None:
    async with Frame().run_test(size=(40, 3)) as pilot:
        app = pilot.app
        assert isinstance(app, Frame)
        app.slider.focus()
        await pilot.press(*keys)
        await pilot.pause()
        assert app.values == expected


async def test_a_click_or_drag_sets_the_slider_and_stops_at_its_ends() -> None:
    async with Frame().run_test(size=(41, 3)) as pilot:
        app = pilot.app
        assert isinstance(app, Frame)
        await pilot.click(Slider, offset=(20, 0))
        assert app.slider.value == 64
        await pilot.mouse_down(Slider, offset=(20, 0))
        await pilot.hover(Slider, offset=(40, 0))
        await pilot.mouse_up(Slider, offset=(40, 0))
        assert app.slider.value == 128
        await pilot.hover(Slider, offset=(0, 0))
        assert app.slider.value == 128
        assert app.values == [64, 64, 128, 128]


async def test_setting_a_sliders_value_in_code_sends_no_message_and_is_clamped() -> None:
    async with Frame().run_test(size=(40, 3)) as pilot:
        app = pilot.app
        assert isinstance(app, Frame)
        app.slider.value = 500
        await pilot.pause()
        assert (app.slider.value, app.values) == (128, [])


@pytest.mark.parametrize("value", [0, 1, 64, 127, 128])
@pytest.mark.parametrize("width", [6, 14, 40])
async def test_the_slider_fills_its_row(value: int, width: int) -> None:
    async with Frame().run_test(size=(width, 3)) as pilot:
        app = pilot.app
        assert isinstance(app, Frame)
        app.slider.value = value
        assert len(app.slider.render().plain) == width
