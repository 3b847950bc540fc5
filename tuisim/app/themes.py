"""Themes: the app's own colours in the colours of the theme that was chosen.

Style sheet and panels name the colours of one dark design. Under any other theme each of them is replaced while a line
is drawn: greys by the same step between the theme's background and its text, colours with a role by the theme's colour
for that role, and others by the same hue as light or dark as the background needs.
"""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from functools import lru_cache

from rich.color import Color as RichColor
from rich.segment import Segment
from rich.style import Style
from textual.color import Color
from textual.filter import LineFilter
from textual.theme import BUILTIN_THEMES, Theme

from tuisim.app import design
from tuisim.base import palette
from tuisim.terminal.pixels import Rgb
from tuisim.terminal.text_runs import convert_color

OWN_THEME = "textual-dark"
"""The theme in which the app's colours are not replaced."""
UNUSED_THEMES = ("ansi-dark", "ansi-light")
"""Themes that have no colours of their own to compute with."""

HIGH_CONTRAST = Theme(
    "high-contrast",
    primary="#00d7ff",
    secondary="#00d7ff",
    accent="#ffff00",
    warning="#ffff00",
    error="#ff8080",
    success="#80ff80",
    foreground="#ffffff",
    background="#000000",
    surface="#000000",
    panel="#000000",
    dark=True,
)
LIGHT = Theme(
    "light",
    primary="#0050a0",
    secondary="#0050a0",
    accent="#8a5a00",
    warning="#8a5a00",
    error="#b00020",
    success="#006a3a",
    foreground="#101418",
    background="#d6dce2",
    surface="#ccd3da",
    panel="#c2cad2",
    dark=False,
)


def list_themes() -> list[str]:
    """Return the names of the themes that the user can choose."""
    return [
        *(name for name in BUILTIN_THEMES if name not in UNUSED_THEMES),
        HIGH_CONTRAST.name,
        LIGHT.name,
    ]


_ROLES = {
    palette.BLUE: "primary",
    palette.YELLOW: "warning",
    design.RED: "error",
    palette.GREEN: "success",
}
_DARKEST = 0.086
"""Lightness of the dark design's background."""
_LEAST_CONTRAST, _HIGH_CONTRAST = 4.5, 7.0
"""Minimum for text, by WCAG 2.2: https://www.w3.org/TR/WCAG22/#contrast-minimum and #contrast-enhanced."""
_GREYISH = 60
"""Colours whose channels differ by less belong to the design's greys."""


class ThemeColors(LineFilter):
    """Replaces the app's own colours by the colours of a theme.

    Args:
        theme: The theme.
        traces: The colours of the lines in charts, which are replaced as well.
    """

    def __init__(self, theme: Theme, traces: Sequence[Rgb] = ()) -> None:
        super().__init__()
        self._background = Color.parse(theme.background or ("#121212" if theme.dark else "#e0e0e0"))
        self._foreground = Color.parse(theme.foreground or ("#e0e0e0" if theme.dark else "#101010"))
        self._contrast = _HIGH_CONTRAST if theme.name == HIGH_CONTRAST.name else _LEAST_CONTRAST
        roles = {own: getattr(theme, role) or own for own, role in _ROLES.items()}
        own = {Color.parse(name).rgb for name in design.COLORS.values()} | set(traces)
        self._replaced = {rgb: self._find_replacement(rgb) for rgb in own}
        self._replaced |= {
            Color.parse(name).rgb: Color.parse(color).rgb for name, color in roles.items()
        }
        self._style = lru_cache(maxsize=4096)(self._apply_theme)

    def rgb(self, own: Rgb) -> Rgb:
        """Return the theme's colour for one of the app's own colours; any other colour is returned unchanged."""
        return self._replaced.get(own, own)

    def choose_text_rgb(self, own: Rgb) -> Rgb:
        """Return the colour in which the theme shows text or lines of the colour `own`, legible on its background.

        If `own` is none of the app's own colours, it is returned unchanged.
        """
        new = self.rgb(own)
        return (
            self._make_legible(new, self._background.rgb, is_line=own == _LINE)
            if own in self._replaced
            else new
        )

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return segments in which the app's own colours are replaced by those of the theme."""
        return [
            segment
            if segment.style is None or segment.control
            else Segment(segment.text, self._style(segment.style))
            for segment in segments
        ]

    def _find_replacement(self, rgb: Rgb) -> Rgb:
        hue, lightness, saturation = colorsys.rgb_to_hls(*(channel / 255 for channel in rgb))
        step = min(max((lightness - _DARKEST) / (1 - _DARKEST), 0.0), 1.0)
        if max(rgb) - min(rgb) < _GREYISH:
            return self._background.blend(self._foreground, step).rgb
        dark, light = (
            colorsys.rgb_to_hls(*end.normalized)[1] for end in (self._background, self._foreground)
        )
        red, green, blue = colorsys.hls_to_rgb(hue, dark + step * (light - dark), saturation)
        return round(255 * red), round(255 * green), round(255 * blue)

    def _apply_theme(self, style: Style) -> Style:
        fore = convert_color(style.color)
        back = convert_color(style.bgcolor)
        # A white background is not replaced: it shows what a sensor sees, and the app itself has no white background.
        new_fore, new_back = (
            fore and self.rgb(fore),
            back and (back if back == _WHITE else self.rgb(back)),
        )
        if new_fore and fore in self._replaced:
            new_fore = self._make_legible(
                new_fore, new_back or self._background.rgb, is_line=fore == _LINE
            )
        if (new_fore, new_back) == (fore, back):
            return style
        changed = Style(
            color=RichColor.from_rgb(*new_fore) if new_fore else None,
            bgcolor=RichColor.from_rgb(*new_back) if new_back else None,
        )
        return style + changed

    def _make_legible(self, rgb: Rgb, on: Rgb, is_line: bool) -> Rgb:
        """Return a colour moved towards black or white as far as necessary to be legible on a background.

        Args:
            rgb: The colour.
            on: The background.
            is_line: Whether a line has the colour; it needs less contrast than text.
        """
        ground = Color(*on)
        color = Color(*rgb)
        min_contrast = 1.5 if is_line and self._contrast < _HIGH_CONTRAST else self._contrast
        away = Color(255, 255, 255) if _measure_light(ground) < 0.18 else Color(0, 0, 0)
        for step in range(11):
            moved = color.blend(away, step / 10)
            if measure_contrast(moved, ground) >= min_contrast:
                return moved.rgb
        return away.rgb


_WHITE = (255, 255, 255)
_LINE = Color.parse(palette.LINE).rgb
"""Frames need not be as strong as text."""


def _measure_light(color: Color) -> float:
    """Return the relative luminance of a colour, from 0 to 1."""
    channels = (
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color.normalized
    )
    red, green, blue = channels
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def measure_contrast(first: Color, other: Color) -> float:
    """Return the contrast ratio of two colours, from 1 to 21."""
    light, dark = sorted((_measure_light(first), _measure_light(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)
