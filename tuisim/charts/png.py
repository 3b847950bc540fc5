"""Pictures as PNG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.charts.layout import FONT_PX, Drawing, Rule, Shade, Shape, Stroke, Words

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont
    from PIL.ImageFont import ImageFont as BitmapFont

_INK, _FAINT, _SHADE = (34, 34, 34), (222, 222, 222), (238, 238, 238)
_FINE = 2
"""Times as large it is drawn and then reduced, for smooth lines."""
_ANCHORS = {"start": "lm", "middle": "mm", "end": "rm"}


def image_of(drawing: Drawing) -> Image:
    """Return a picture as a Pillow image, on white."""
    from PIL import Image, ImageDraw, ImageFont

    image = Image.new("RGB", (drawing.width * _FINE, drawing.height * _FINE), "white")
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(FONT_PX * _FINE)
    for shape in drawing.shapes:
        _draw(draw, shape, font)
    return image.resize((drawing.width, drawing.height), Image.Resampling.LANCZOS)


def _draw(draw: ImageDraw, shape: Shape, font: FreeTypeFont | BitmapFont) -> None:
    match shape:
        case Rule():
            ends = [end * _FINE for end in (shape.x1, shape.y1, shape.x2, shape.y2)]
            draw.line(ends, fill=_FAINT if shape.faint else _INK, width=_FINE)
        case Words():
            x, y = shape.x * _FINE, shape.y * _FINE
            # The font has one weight: what is strong is written once more, half a pixel beside.
            for place in ((x, y), (x + 1, y))[: 1 + shape.strong]:
                draw.text(place, shape.text, fill=shape.rgb or _INK, font=font, anchor=_ANCHORS[shape.anchor])
        case Shade():
            corners = (shape.x, shape.y, shape.x + shape.width, shape.y + shape.height)
            draw.rectangle([corner * _FINE for corner in corners], fill=_SHADE)
        case Stroke():
            points = [(x * _FINE, y * _FINE) for x, y in shape.points.tolist()]
            if not shape.dots:
                draw.line(points, fill=shape.rgb, width=2 * _FINE, joint="curve")
            for x, y in points if shape.dots else ():
                reach = 2.5 * _FINE
                draw.ellipse((x - reach, y - reach, x + reach, y + reach), fill=shape.rgb)
