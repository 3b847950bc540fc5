"""`Image` of `pybricks.media.ev3dev`: pictures in memory, and the screen of the brick."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from typing import TYPE_CHECKING, Any

from tuisim.engine.core.css_colors import Rgb, load_css_colors
from tuisim.engine.runs.brick_state import DISPLAY_HEIGHT, DISPLAY_WIDTH, display_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.display import dark_pixels
from tuisim.engine.shim.pybricks.brick import Connected, invalid_argument, text_of, whole
from tuisim.engine.shim.pybricks.font import Font, drawable
from tuisim.engine.shim.pybricks.media import IMAGES, name_of
from tuisim.engine.shim.pybricks.parameters import Color

if TYPE_CHECKING:
    from PIL.Image import Image as Picture
    from PIL.ImageDraw import ImageDraw

PAINTS: Mapping[str, Rgb] = {
    name: load_css_colors()[name.lower()]
    for name in (*Color.__members__, "CYAN", "GRAY", "MAGENTA", "VIOLET")
}
"""Red, green and blue of each colour that has a name in any version of Pybricks; the screen shows dark greys as black.
"""
BLACK = PAINTS["BLACK"]
WHITE = PAINTS["WHITE"]
MODE = "RGB"
THE_SCREEN = "_screen_"
"""The argument for which `Image` is the screen itself, in place of the path of an image file."""
EXTENSION = ".png"
MOST_PIXELS = 4_000_000
"""Largest number of pixels of an empty image; a larger one is an error, as it does not fit into the brick's memory."""


def paint_of(color: Any) -> Rgb | None:
    """Return red, green and blue of a colour; None for None, with which nothing is drawn.

    Raises:
        TypeError: `color` is not a colour.
    """
    if color is None:
        return None
    if (name := getattr(color, "name", None)) is None:
        raise TypeError(f"a Color is needed, not {type(color).__name__}")
    return PAINTS.get(name) or (None if name == "NONE" else getattr(color, "rgb", None))


class Canvas(Connected):
    """The pixels that an image shares with the images that are parts of it.

    Args:
        width, height: Size in pixels.
        shown: Whether the canvas is the screen.
    """

    def __init__(self, width: int, height: int, shown: bool = False) -> None:
        self.width = width
        self.height = height
        self._shown = shown
        self._row: tuple[bytes, str] = b"", ""

    @cached_property
    def picture(self) -> Picture:
        """The pixels as a Pillow image, which is white at first."""
        from PIL import Image as pillow

        return pillow.new(MODE, (self.width, self.height), WHITE)

    def changed(self) -> None:
        """Display the canvas if it is the screen; count this as a command, which takes no simulated time."""
        session = self.brick.session
        session.command()
        if not self._shown:
            return
        session.charge(session.sim.spec.profile.display_update_ns)
        pixels = dark_pixels(self.picture.convert("L"))
        if pixels != self._row[0]:
            self._row = pixels, display_row(pixels)
        self.brick.screen.show(self._row[1], Stream.DISPLAY)


SCREEN = Canvas(DISPLAY_WIDTH, DISPLAY_HEIGHT, shown=True)


def canvas_of(picture: Picture) -> Canvas:
    """Return a canvas with the pixels of a picture."""
    canvas = Canvas(*picture.size)
    canvas.picture.paste(picture)
    return canvas


def load(path: str) -> Canvas:
    """Return the canvas with the pixels of a source: the screen, one of the brick's images, or a PNG file.

    Raises:
        OSError: there is no such file, or it is not an image.
    """
    if path == THE_SCREEN:
        return SCREEN
    path = path if path.endswith(EXTENSION) else f"{path}{EXTENSION}"
    if (name := name_of(path, IMAGES)) is not None:
        return placeholder(name)
    from PIL import Image as pillow

    with pillow.open(path) as file:
        picture = file.convert("RGBA")
    canvas = Canvas(*picture.size)
    canvas.picture.paste(picture, mask=picture.getchannel("A"))
    return canvas


def placeholder(name: str) -> Canvas:
    """Return a picture as large as the screen that stands for one of the brick's images: its name in a frame."""
    Connected.brick.say_once(
        "images",
        f"the brick's own images are not part of tuisim: the screen shows a frame with a name, as {name}",
    )
    canvas = Canvas(DISPLAY_WIDTH, DISPLAY_HEIGHT)
    font = Font(bold=True)
    pen = pen_on(canvas.picture)
    pen.rectangle((0, 0, canvas.width - 1, canvas.height - 1), outline=BLACK)
    place = (canvas.width - font.text_width(name)) // 2, (canvas.height - font.height) // 2
    pen.text(place, name, BLACK, font.drawn)
    return canvas


def pen_on(picture: Picture) -> ImageDraw:
    """Return the Pillow object that draws on a picture."""
    from PIL import ImageDraw

    return ImageDraw.Draw(picture)


class Image(Connected):
    """A picture, or the screen.

    Args:
        source: The path of a PNG file, of which `.png` may be missing, or another image, which is copied.
        sub: Whether the image is a part of the source and shares its pixels.
        x1, y1, x2, y2: The first and the last pixel of that part; by default those of the source.

    Raises:
        OSError: there is no such file, or it is not an image.
        ValueError: the part is not inside the source.
    """

    def __init__(
        self,
        source: Image | str,
        *,
        sub: bool = False,
        x1: float | None = None,
        y1: float | None = None,
        x2: float | None = None,
        y2: float | None = None,
    ) -> None:
        base = source if isinstance(source, Image) else Image._on(load(text_of(source)))
        left, top, right, bottom = base._box
        if sub:
            x, y = whole(x1 or 0), whole(y1 or 0)
            to_x = base.width - 1 if x2 is None else whole(x2)
            to_y = base.height - 1 if y2 is None else whole(y2)
            if not (0 <= x <= to_x < base.width and 0 <= y <= to_y < base.height):
                raise invalid_argument()
            self._set_up(base._canvas, (left + x, top + y, left + to_x + 1, top + to_y + 1))
        elif base is source:
            self._set_up(canvas_of(base._pixels()), (0, 0, right - left, bottom - top))
        else:
            self._set_up(base._canvas, base._box)

    @classmethod
    def _on(cls, canvas: Canvas) -> Image:
        """Return an image that covers the whole of a canvas."""
        image: Image = cls.__new__(cls)
        image._set_up(canvas, (0, 0, canvas.width, canvas.height))
        return image

    def _set_up(self, canvas: Canvas, box: tuple[int, int, int, int]) -> None:
        self._canvas = canvas
        self._box = box
        self._font = Font.DEFAULT
        self._print_x = self._print_y = 0

    @staticmethod
    def empty(width: float = DISPLAY_WIDTH, height: float = DISPLAY_HEIGHT) -> Image:
        """Return a white image.

        Raises:
            ValueError: a size is not above 0.
            MemoryError: the brick has no memory for it.
        """
        if whole(width) <= 0 or whole(height) <= 0:
            raise invalid_argument()
        if whole(width) * whole(height) > MOST_PIXELS:
            raise MemoryError
        return Image._on(Canvas(whole(width), whole(height)))

    @property
    def width(self) -> int:
        """Width of the image in pixels."""
        return self._box[2] - self._box[0]

    @property
    def height(self) -> int:
        """Height of the image in pixels."""
        return self._box[3] - self._box[1]

    def _pixels(self) -> Picture:
        """Return the image's pixels: the canvas itself if the image covers all of it, else a copy of its part."""
        whole_picture = self._canvas.picture
        return (
            whole_picture
            if whole_picture.size == (self.width, self.height)
            else whole_picture.crop(self._box)
        )

    @contextmanager
    def _drawing(self) -> Iterator[tuple[Picture, ImageDraw]]:
        """Return a context that yields the pixels and a Pillow object to change them; at its end they are displayed."""
        picture = self._pixels()
        yield picture, pen_on(picture)
        if picture is not self._canvas.picture:
            self._canvas.picture.paste(picture, self._box)
        self._canvas.changed()

    # Drawing

    def clear(self) -> None:
        """Make the image white; the next `print` begins at the top."""
        with self._drawing() as (picture, _):
            self._wipe(picture)

    def _wipe(self, picture: Picture) -> None:
        picture.paste(WHITE, (0, 0, *picture.size))
        self._print_x = self._print_y = 0

    def draw_pixel(self, x: float, y: float, color: Color | None = Color.BLACK) -> None:
        """Draw one pixel of the image, `x` from the left and `y` from the top, in a colour; with None, draw nothing."""
        with self._drawing() as (_, pen):
            if paint := paint_of(color):
                pen.point((whole(x), whole(y)), paint)

    def draw_line(
        self,
        x1: float,
        y1: float,
        x2: float,
        y2: float,
        width: float = 1,
        color: Color | None = Color.BLACK,
    ) -> None:
        """Draw a line between two points; coordinates and `width` are in pixels. With `color` None, draw nothing."""
        with self._drawing() as (_, pen):
            if paint := paint_of(color):
                pen.line((whole(x1), whole(y1), whole(x2), whole(y2)), paint, max(1, whole(width)))

    def draw_box(
        self,
        x1: float,
        y1: float,
        x2: float,
        y2: float,
        r: float = 0,
        fill: bool = False,
        color: Color | None = Color.BLACK,
    ) -> None:
        """Draw a box between two corners, both included.

        Args:
            x1, y1, x2, y2: The corners, in pixels.
            r: The radius with which corners are rounded.
            fill: Whether the box is filled; otherwise only its outline is drawn.
            color: The colour; None draws nothing.
        """
        left, right = sorted((whole(x1), whole(x2)))
        top, bottom = sorted((whole(y1), whole(y2)))
        radius = min(max(whole(r), 0), (right - left) // 2, (bottom - top) // 2)
        with self._drawing() as (_, pen):
            if paint := paint_of(color):
                pen.rounded_rectangle(
                    (left, top, right, bottom), radius, paint if fill else None, paint
                )

    def draw_circle(
        self, x: float, y: float, r: float, fill: bool = False, color: Color | None = Color.BLACK
    ) -> None:
        """Draw a circle.

        Args:
            x, y: The centre, in pixels.
            r: The radius.
            fill: Whether the circle is filled; otherwise only its outline is drawn.
            color: The colour; None draws nothing.
        """
        x, y, r = map(whole, (x, y, r))
        with self._drawing() as (_, pen):
            if (paint := paint_of(color)) and r >= 0:
                pen.ellipse((x - r, y - r, x + r, y + r), paint if fill else None, paint)

    def draw_image(
        self, x: float, y: float, source: Image | str, transparent: Color | None = None
    ) -> None:
        """Draw an image with its top left corner at a point.

        Args:
            x, y: The point, in pixels from the top left corner of this image.
            source: The image, or the path of a PNG file.
            transparent: The colour whose pixels are left out; None for none.
        """
        copied = pixels_of(source)
        paint = paint_of(transparent)
        with self._drawing() as (picture, _):
            picture.paste(
                copied, (whole(x), whole(y)), None if paint is None else mask_without(copied, paint)
            )

    def load_image(self, source: Image | str, /) -> None:
        """Clear this image, and draw another one, given as an object or by its path, in its centre."""
        centred = pixels_of(source)
        with self._drawing() as (picture, _):
            self._wipe(picture)
            picture.paste(
                centred,
                (int((self.width - centred.width) / 2), int((self.height - centred.height) / 2)),
            )

    # Text

    def set_font(self, font: Font, /) -> None:
        """Set the font of `draw_text` and `print`."""
        if not isinstance(font, Font):
            raise TypeError(f"a Font is needed, not {type(font).__name__}")
        self._font = font

    def draw_text(
        self,
        x: float,
        y: float,
        text: Any,
        text_color: Color | None = Color.BLACK,
        background_color: Color | None = None,
    ) -> None:
        """Draw a line of text with its top left corner at a point.

        Args:
            x, y: The point, in pixels from the top left corner of the image.
            text: The text; other values are converted to text as by `print`.
            text_color: The colour of the text; None draws no text.
            background_color: The colour behind the text; None for none.
        """
        with self._drawing() as (_, pen):
            self._write(
                pen,
                (whole(x), whole(y)),
                str(text),
                paint_of(text_color),
                paint_of(background_color),
            )

    def _write(
        self,
        pen: ImageDraw,
        place: tuple[int, int],
        text: str,
        paint: Rgb | None,
        background: Rgb | None,
    ) -> int:
        """Draw a line of text, and return its width in pixels.

        Args:
            pen: The Pillow object that draws.
            place: The top left corner of the text.
            text: The text.
            paint: The colour of the text; None draws no text.
            background: The colour behind it; None for none.
        """
        x, y = place
        width = self._font.text_width(text)
        line = drawable(text)
        if background and width:
            pen.rectangle((x, y, x + width - 1, y + self._font.height - 1), background)
        if paint:
            pen.text(place, line, paint, self._font.drawn)
        return width

    def print(self, *args: Any, sep: str = " ", end: str = "\n") -> None:
        """Print values as text, black on white, after the text printed before; if the image is full, lines move up."""
        buffer = io.StringIO()
        print(*args, sep=sep, end=end, file=buffer)
        with self._drawing() as (picture, pen):
            for at, line in enumerate(buffer.getvalue().split("\n")):
                if at:
                    self._print_x, self._print_y = 0, self._print_y + self._font.height
                if line:
                    self._scroll(picture)
                    self._print_x += self._write(
                        pen, (self._print_x, self._print_y), line, BLACK, WHITE
                    )

    def _scroll(self, picture: Picture) -> None:
        """Move the lines of text up until there is space for another line."""
        missing = self._print_y + self._font.height - self.height
        if missing > 0:
            rest = picture.crop((0, missing, self.width, self.height + missing))
            rest.paste(WHITE, (0, self.height - missing, self.width, self.height))
            picture.paste(rest)
            self._print_y -= missing

    def save(self, filename: str, /) -> None:
        """Save the image as a PNG file; `.png` is appended if it is missing."""
        path = text_of(filename)
        self._pixels().save(path if path.endswith(EXTENSION) else f"{path}{EXTENSION}", "PNG")


def pixels_of(source: Image | str) -> Picture:
    """Return the pixels of an image, given as an object or by the path of its file.

    Raises:
        OSError: there is no such file, or it is not an image.
    """
    return (source if isinstance(source, Image) else Image(source))._pixels()


def mask_without(picture: Picture, paint: Rgb) -> Picture:
    """Return a mask of those pixels of a picture that do not have the colour `paint`."""
    from PIL import Image as pillow
    from PIL import ImageChops

    other, *more = ImageChops.difference(picture, pillow.new(MODE, picture.size, paint)).split()
    for channel in more:
        other = ImageChops.lighter(other, channel)
    return other.point([255 * (difference > 0) for difference in range(256)], "1")
