"""Charts as files: SVG, PNG and text; the suffix selects the format."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Callable, Collection, Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.core.css_colors import Rgb
from tuisim.logs.export import check_place
from tuisim.pictures.charts.layout import (
    FONT_PX,
    ChartData,
    Drawing,
    Raster,
    Rule,
    Shade,
    Shape,
    Stroke,
    Words,
)

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont
    from PIL.ImageFont import ImageFont as BitmapFont

Size = tuple[int, int]


_SIZE = re.compile(r"(\d{1,6})[x×](\d{1,6})")


def parse_size(text: str, smallest: Size, largest: Size) -> Size | None:
    """Return the size that a text such as `800x600` stands for; None if it is no size, or outside the limits."""
    match = _SIZE.fullmatch(text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    is_allowed = all(
        low <= side <= high for low, side, high in zip(smallest, size, largest, strict=True)
    )
    return size if is_allowed else None


def describe_limits(smallest: Size, largest: Size) -> str:
    """Return the smallest and the largest size in words, such as `200x150 to 6000x6000`."""
    return " to ".join(f"{width}x{height}" for width, height in (smallest, largest))


@dataclass(frozen=True, slots=True)
class ChartFormat:
    """A file format of charts: the function that writes it, and its sizes."""

    write: Callable[[ChartData, Size], bytes]
    size: Size
    """Default width and height, in the format's unit."""
    smallest: Size
    largest: Size
    unit: str
    finer: Size = (1, 1)
    """Resolution: subdivisions of a unit."""

    def parse_size(self, text: str) -> Size:
        """Return the size of a chart that a text such as `800x600` stands for.

        Raises:
            ConfigError: it is no size, or not within the limits.
        """
        size = parse_size(text, self.smallest, self.largest)
        if size is None:
            allowed = f"width and height, {describe_limits(self.smallest, self.largest)}"
            raise ConfigError(f"cannot draw a chart of {text!r}", allowed, key="--size")
        return size


def _encode_svg(chart: ChartData, size: Size) -> bytes:
    return draw_svg(chart.lay_out(*size)).encode()


def _encode_png_chart(chart: ChartData, size: Size) -> bytes:
    return encode_png(draw_image(chart.lay_out(*size)))


def encode_png(image: Image) -> bytes:
    """Return an image as the content of a PNG file."""
    content = io.BytesIO()
    image.save(content, "png")
    return content.getvalue()


def _encode_text(chart: ChartData, size: Size) -> bytes:
    from tuisim.pictures.charts.text_chart import draw_text

    return f"{draw_text(chart, *size).plain}\n".encode()


CHART_FORMATS: Mapping[str, ChartFormat] = {
    ".svg": ChartFormat(_encode_svg, (960, 420), (200, 150), (10_000, 10_000), "pixels"),
    ".png": ChartFormat(_encode_png_chart, (960, 420), (200, 150), (6_000, 6_000), "pixels"),
    ".txt": ChartFormat(_encode_text, (80, 24), (20, 8), (1_000, 500), "characters", (2, 4)),
}
"""Every format of a chart by the suffix of its files. To add one: write its function and a line here."""

FACET_PX = 200
"""Default height of a facet in an image."""


def find_format(path: Path) -> ChartFormat:
    """Return the format that belongs to a file's suffix, after checking that the file can be written.

    Raises:
        ExportError: unknown suffix, or the file cannot be written.
    """
    check_format(path, "chart", CHART_FORMATS)
    return CHART_FORMATS[path.suffix.lower()]


def check_format(path: Path, what: str, formats: Collection[str]) -> None:
    """Check that a file can be written, and that its suffix is one of `formats`.

    Args:
        path: The file.
        what: What is written, such as `chart`, for errors.
        formats: The allowed suffixes.

    Raises:
        ExportError: unknown suffix, or it cannot be written.
    """
    if path.suffix.lower() not in formats:
        allowed = ", ".join(formats)
        raise ExportError(
            f"cannot write {path}: unknown format {path.suffix!r}", f"a {what} ends in {allowed}"
        )
    check_place(path)


def save_chart(
    chart_of: Callable[[int, int], ChartData], path: Path, size: Size | None = None
) -> None:
    """Write a chart to a file, which may exist.

    Args:
        chart_of: Returns the chart for a width and a height in the smallest parts that the format can show: pixels, or
            for text the dots of a character.
        path: Its suffix selects the format, one of `CHART_FORMATS`.
        size: Width and height in the format's unit; None for its own.

    Raises:
        ExportError: the file cannot be written; an existing one is unchanged.
        LogError: a variable to draw against another one does not exist.
    """
    kind = find_format(path)
    width, height = size or kind.size
    chart = chart_of(width * kind.finer[0], height * kind.finer[1])
    if chart.facets and size is None and kind.unit == "pixels":
        height = max(height, 80 + FACET_PX * len(chart.lines))
    write_whole(path, kind.write(chart, (width, height)))


def write_whole(path: Path, content: bytes) -> None:
    """Write the content of a file completely or not at all; the file may exist.

    Raises:
        ExportError: it cannot be written; an existing file is unchanged.
    """
    try:
        with replacing(path) as handle:
            handle.write(content)
    except OSError as error:
        raise ExportError(f"cannot write {path}: {error.strerror or error}") from error


_FONT = "system-ui, sans-serif"
_INVALID = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]")
"""Control characters, lone surrogates and noncharacters."""


def draw_svg(drawing: Drawing, *, inside: bool = False) -> str:
    """Return a picture as the content of an SVG file.

    Args:
        drawing: The picture.
        inside: Whether to return an element of a page instead, which has the colours of the page.
    """
    size = f'viewBox="0 0 {drawing.width} {drawing.height}" width="{drawing.width}" height="{drawing.height}"'
    look = f'font-family="{_FONT}" font-size="{FONT_PX}" role="img"'
    ink = "" if inside else f' color="{_format_hex(_INK)}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}{ink}>',
        f"<title>{_clean(drawing.title)}</title>",
    ]
    if not inside:
        parts.append('<rect width="100%" height="100%" fill="white"/>')
    parts += [_draw_svg_shape(shape) for shape in drawing.shapes]
    return "\n".join([*parts, "</svg>", ""])


def replace_invalid(text: str) -> str:
    """Return a text with U+FFFD in place of characters that are invalid in XML or HTML."""
    return _INVALID.sub("\ufffd", text)


def _clean(text: str) -> str:
    return escape(replace_invalid(text))


def _format_hex(rgb: Rgb) -> str:
    return f"#{bytes(rgb).hex()}"


def _draw_svg_shape(shape: Shape) -> str:
    match shape:
        case Rule():
            ends = (
                f'x1="{shape.x1:.1f}" y1="{shape.y1:.1f}" x2="{shape.x2:.1f}" y2="{shape.y2:.1f}"'
            )
            faint = ' stroke-opacity="0.15"' if shape.faint else ""
            return f'<line {ends} stroke="currentColor"{faint}/>'
        case Words():
            place = f'x="{shape.x:.1f}" y="{shape.y:.1f}" dy="0.35em" text-anchor="{shape.anchor}"'
            color = _format_hex(shape.rgb) if shape.rgb else "currentColor"
            strong = ' font-weight="bold"' if shape.strong else ""
            return f'<text {place} fill="{color}"{strong}>{_clean(shape.text)}</text>'
        case Shade():
            return f'<rect {_place(shape)} fill="currentColor" fill-opacity="0.08"/>'
        case Stroke():
            points = [f"{x:.1f} {y:.1f}" for x, y in shape.points.tolist()]
            color = _format_hex(shape.rgb)
            if shape.dots:
                # A line of length 0 with round ends is a point, and short to write.
                path = "".join(f"M{point}h0" for point in points)
                return f'<path d="{path}" fill="none" stroke="{color}" stroke-width="5" stroke-linecap="round"/>'
            path = "M" + "L".join(points)
            return f'<path d="{path}" fill="none" stroke="{color}" stroke-width="1.8" stroke-linejoin="round"/>'
        case Raster():
            data = base64.b64encode(encode_png(_load_image(shape))).decode()
            return f'<image {_place(shape)} preserveAspectRatio="none" href="data:image/png;base64,{data}"/>'


def _place(shape: Shade | Raster) -> str:
    return (
        f'x="{shape.x:.1f}" y="{shape.y:.1f}" width="{shape.width:.1f}" height="{shape.height:.1f}"'
    )


def _load_image(shape: Raster) -> Image:
    from PIL import Image

    return Image.fromarray(shape.pixels)


_INK = (34, 34, 34)
_FAINT = (222, 222, 222)
_SHADE = (238, 238, 238)
_FINE = 2
"""The image is drawn this many times larger and then reduced, for smooth lines."""
_ANCHORS = {"start": "lm", "middle": "mm", "end": "rm"}


def draw_image(drawing: Drawing) -> Image:
    """Return a picture as a Pillow image on a white background."""
    from PIL import Image, ImageDraw, ImageFont

    image = Image.new("RGB", (drawing.width * _FINE, drawing.height * _FINE), "white")
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(FONT_PX * _FINE)
    for shape in drawing.shapes:
        if isinstance(shape, Raster):
            sides = round(shape.width * _FINE), round(shape.height * _FINE)
            image.paste(
                _load_image(shape).resize(sides), (round(shape.x * _FINE), round(shape.y * _FINE))
            )
        else:
            _paint(draw, shape, font)
    return image.resize((drawing.width, drawing.height), Image.Resampling.LANCZOS)


def _paint(
    draw: ImageDraw, shape: Rule | Words | Shade | Stroke, font: FreeTypeFont | BitmapFont
) -> None:
    match shape:
        case Rule():
            ends = [end * _FINE for end in (shape.x1, shape.y1, shape.x2, shape.y2)]
            draw.line(ends, fill=_FAINT if shape.faint else _INK, width=_FINE)
        case Words():
            x, y = shape.x * _FINE, shape.y * _FINE
            # The font has one weight: bold text is drawn twice, half a pixel apart.
            for place in ((x, y), (x + 1, y))[: 1 + shape.strong]:
                draw.text(
                    place,
                    shape.text,
                    fill=shape.rgb or _INK,
                    font=font,
                    anchor=_ANCHORS[shape.anchor],
                )
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
