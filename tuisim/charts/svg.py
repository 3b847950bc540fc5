"""Pictures as SVG."""

from __future__ import annotations

import re
from html import escape

from tuisim.charts.layout import FONT_PX, Drawing, Rule, Shade, Shape, Stroke, Words
from tuisim.core.css_colors import Rgb

_INK, _PAPER = "#222", "#fff"
_FONT = "system-ui, sans-serif"
_NOWHERE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]")
"""Control characters, halves of surrogate pairs, and what is no character at all."""


def svg_of(drawing: Drawing, *, inside: bool = False) -> str:
    """Return a picture as SVG.

    Args:
        drawing: The picture.
        inside: Whether it becomes a part of a page, whose colours it then takes, instead of a file.
    """
    size = f'viewBox="0 0 {drawing.width} {drawing.height}" width="{drawing.width}" height="{drawing.height}"'
    look = f'font-family="{_FONT}" font-size="{FONT_PX}" role="img"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}{"" if inside else f" color={chr(34)}{_INK}{chr(34)}"}>',
        f"<title>{clean(drawing.title)}</title>",
    ]
    if not inside:
        parts.append(f'<rect width="100%" height="100%" fill="{_PAPER}"/>')
    parts += [_shape(shape) for shape in drawing.shapes]
    return "\n".join([*parts, "</svg>", ""])


def clean(text: str) -> str:
    """Return a text as XML and HTML take it; characters that have no place in either become a question mark."""
    return escape(_NOWHERE.sub("\ufffd", text))


def _hex(rgb: Rgb) -> str:
    return f"#{bytes(rgb).hex()}"


def _shape(shape: Shape) -> str:
    match shape:
        case Rule():
            ends = f'x1="{shape.x1:.1f}" y1="{shape.y1:.1f}" x2="{shape.x2:.1f}" y2="{shape.y2:.1f}"'
            faint = ' stroke-opacity="0.15"' if shape.faint else ""
            return f'<line {ends} stroke="currentColor"{faint}/>'
        case Words():
            place = f'x="{shape.x:.1f}" y="{shape.y:.1f}" dy="0.35em" text-anchor="{shape.anchor}"'
            color = _hex(shape.rgb) if shape.rgb else "currentColor"
            strong = ' font-weight="bold"' if shape.strong else ""
            return f'<text {place} fill="{color}"{strong}>{clean(shape.text)}</text>'
        case Shade():
            place = f'x="{shape.x:.1f}" y="{shape.y:.1f}" width="{shape.width:.1f}" height="{shape.height:.1f}"'
            return f'<rect {place} fill="currentColor" fill-opacity="0.08"/>'
        case Stroke():
            points = [f"{x:.1f} {y:.1f}" for x, y in shape.points.tolist()]
            color = _hex(shape.rgb)
            if shape.dots:
                # A line of no length with round ends is a point, and a few letters long.
                path = "".join(f"M{point}h0" for point in points)
                return f'<path d="{path}" fill="none" stroke="{color}" stroke-width="5" stroke-linecap="round"/>'
            path = "M" + "L".join(points)
            return f'<path d="{path}" fill="none" stroke="{color}" stroke-width="1.8" stroke-linejoin="round"/>'
