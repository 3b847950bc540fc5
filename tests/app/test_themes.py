"""Themes: everything follows them, and can be read."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from rich.color import Color as RichColor
from rich.segment import Segment
from rich.style import Style
from textual.color import Color
from textual.theme import BUILTIN_THEMES

import tuisim.app
from tests.app.app_help import LOGS, open_lab, settings, until
from tuisim.app import design
from tuisim.app.app import LabApp
from tuisim.app.dialogs.palette import ThemeChooser
from tuisim.app.themes import (
    HIGH_CONTRAST,
    LIGHT,
    OWN_THEME,
    UNUSED_THEMES,
    ThemeColors,
    measure_contrast,
)
from tuisim.pictures.charts.traces import TRACE_COLORS

THEMES = [
    *(
        pytest.param(theme, id=name)
        for name, theme in BUILTIN_THEMES.items()
        if name not in UNUSED_THEMES
    ),
    pytest.param(HIGH_CONTRAST, id="high contrast"),
    pytest.param(LIGHT, id="light"),
]
TEXT = [
    "#d8dee6",
    "#ffffff",
    "#9fb0c3",
    "#8fa0b2",
    "#7f8fa1",
    "#5fafff",
    "#ffd75f",
    "#ff6e6e",
    "#87d7af",
    "#d7a0ff",
]
GROUNDS = ["#10151c", "#18202a", "#1c242e", "#263545"]


def test_every_colour_of_the_palette_is_used_and_named_once() -> None:
    folder = Path(tuisim.app.__file__).parents[1]
    files = [
        path
        for path in folder.rglob("*")
        if path.suffix in (".py", ".tcss") and path.name not in ("design.py", "palette.py")
    ]
    text = "".join(path.read_text("utf-8") for path in files)

    used = {
        name
        for name in design.COLORS
        if any(
            use in text for use in (f"palette.{name}", f"design.{name}", f"$tuisim-{_in_css(name)}")
        )
    }

    assert used == set(design.COLORS)
    assert len(set(design.COLORS.values())) == len(design.COLORS)


def _in_css(name: str) -> str:
    return name.lower().replace("_", "-")


def shown(colors: ThemeColors, style: Style) -> tuple[Color, Color]:
    """Foreground and background of a text under a theme."""
    segment = colors.apply([Segment("a", style)], Color(0, 0, 0))[0]
    assert segment.style and segment.style.color and segment.style.bgcolor
    fore = segment.style.color.triplet
    back = segment.style.bgcolor.triplet
    assert fore and back
    return Color(*fore), Color(*back)


@pytest.mark.parametrize("theme", THEMES)
def test_text_has_enough_contrast_in_every_theme(theme: object) -> None:
    colors = ThemeColors(theme, TRACE_COLORS)  # type: ignore[arg-type]
    least = 7.0 if theme is HIGH_CONTRAST else 4.5
    traces = [f"#{red:02x}{green:02x}{blue:02x}" for red, green, blue in TRACE_COLORS]

    for text, ground in itertools.product([*TEXT, *traces], GROUNDS):
        assert (
            measure_contrast(*shown(colors, Style(color=text, bgcolor=ground))) >= least - 0.05
        ), (
            text,
            ground,
        )


def test_themes_do_not_change_the_colours_that_a_sensor_sees() -> None:
    for seen in ((255, 255, 255), (255, 0, 0), (0, 0, 0)):
        swatch = Style(color="#d8dee6", bgcolor=RichColor.from_rgb(*seen))
        assert shown(ThemeColors(LIGHT), swatch)[1].rgb == seen


@pytest.mark.slow
async def test_a_theme_is_chosen_from_the_list_and_kept() -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("f10")
        await until(pilot, lambda: isinstance(app.screen, ThemeChooser) and app.screen.is_ready)
        await pilot.press(*"light")
        await until(pilot, lambda: app.theme == "light")
        await pilot.press("escape")
        await until(pilot, lambda: app.theme == OWN_THEME)
        await pilot.press("f10", *"high-contrast", "enter")
        await until(pilot, lambda: app.theme == "high-contrast" and len(app.screen_stack) == 1)
        await pilot.pause()
        assert app.picture_mode.theme is not None
        background = {
            segment.style.bgcolor.triplet
            for strip in app.screen._compositor.render_strips()
            for segment in strip
            if segment.style and segment.style.bgcolor and segment.text == "╭─ "
        }
        assert all(triplet is None or tuple(triplet) == (0, 0, 0) for triplet in background)

    assert LabApp(settings(LOGS)).theme == "high-contrast"


# Machado, Oliveira, Fernandes 2009, severity 1.0: https://www.inf.ufrgs.br/~oliveira/pubs_files/CVD_Simulation/
SEEN_BY = {
    "protan": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deutan": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.01182, 0.04294, 0.968881],
    ],
    "tritan": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.3039],
    ],
}


def lab_of(light: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return CIE L*a*b* (D65) of shares of linear red, green and blue."""
    to_xyz = [
        [0.4124564, 0.2126729, 0.0193339],
        [0.3575761, 0.7151522, 0.1191920],
        [0.1804375, 0.0721750, 0.9503041],
    ]
    xyz = light @ np.array(to_xyz) / np.array([0.95047, 1.0, 1.08883])
    root = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * (29 / 6) ** 2 / 3 + 4 / 29)
    x, y, z = root[..., 0], root[..., 1], root[..., 2]
    return np.stack((116 * y - 16, 500 * (x - y), 200 * (y - z)), axis=-1)


@pytest.mark.parametrize("eyes", SEEN_BY)
def test_colours_of_traces_stay_apart_also_for_colour_blind_eyes(eyes: str) -> None:
    value = np.array(TRACE_COLORS) / 255
    light = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    seen = np.clip(light @ np.array(SEEN_BY[eyes]).T, 0, 1)
    lab = lab_of(seen)

    assert min(np.linalg.norm(one - other) for one, other in itertools.combinations(lab, 2)) > 15
