"""The screen, and the frame buffer into which the library copies its image."""

from __future__ import annotations

import errno
import mmap
import os
import stat
import struct
from functools import cached_property, wraps
from typing import TYPE_CHECKING, Any

from tuisim.engine.runs.brick_state import DISPLAY_HEIGHT, DISPLAY_WIDTH, display_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.files.entries import DeviceFile, OpenFile, refuse_ioctl
from tuisim.engine.shim.fonts import plain_font
from tuisim.engine.shim.session import DeviceSession

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

BITS_A_PIXEL = 32
"""Bits of a pixel in the memory of the screen, as the kernel's driver reports them; the display itself is black and
white.
"""
LINE_BYTES = DISPLAY_WIDTH * BITS_A_PIXEL // 8
WHITE = 255
DARK_BELOW = 128
"""A pixel whose grey, 0 to 255, is below this is black on the display; all others are white."""
TRUE_COLOR = 2
"""The kernel's number for screens whose pixels have red, green and blue, `FB_VISUAL_TRUECOLOR`."""
NO_FILE = -1
"""The file descriptor that makes `mmap` create memory which belongs to no file."""
DISPLAY_PATH = "/dev/fb0"
FIXED_INFO = struct.pack(
    "@16s L 4I 3H I L I I 3H", b"st7586", 0, LINE_BYTES * DISPLAY_HEIGHT, 0, 0, TRUE_COLOR, 0, 0, 0, LINE_BYTES,
    0, 0, 0, 0, 0, 0,
)  # fmt: skip
"""The bytes of the kernel's structure `fb_fix_screeninfo` for this display, whose driver is `st7586`."""
VARIABLE_INFO = struct.pack(
    "@8I 3I 3I 3I 3I 20I", DISPLAY_WIDTH, DISPLAY_HEIGHT, DISPLAY_WIDTH, DISPLAY_HEIGHT, 0, 0, BITS_A_PIXEL, 0,
    16, 8, 0, 8, 8, 0, 0, 8, 0, 0, 0, 0, *[0] * 20,
)  # fmt: skip
"""The bytes of the kernel's structure `fb_var_screeninfo`: the sizes of the display, then for red, green, blue and
alpha the offset, number and order of their bits in a pixel.
"""


class Screen:
    """The recorder of the brick's screen: it records images and texts each time they change."""

    def __init__(self, session: DeviceSession) -> None:
        self._session = session
        self._shown: tuple[str, Stream] | None = None

    def show(self, row: str, stream: Stream) -> None:
        """Record an image or a text of the screen, as a row of output, if it differs from the last one.

        Args:
            row: The text of the row, in the format of `engine.runs.brick_state`.
            stream: The stream of the row, which says whether it is an image or a text.
        """
        if (row, stream) != self._shown:
            self._shown = (row, stream)
            self._session.show(row, stream)


class DisplayBuffer(mmap.mmap):
    """The memory of the display: bytes that are written to it are displayed.

    Each pixel has four bytes: unused, red, green, blue.
    """

    def __new__(cls, _session: DeviceSession, _screen: Screen) -> DisplayBuffer:
        """Return the display's memory, which is allocated without a file instead of mapped."""
        return super().__new__(cls, NO_FILE, LINE_BYTES * DISPLAY_HEIGHT)

    def __init__(self, session: DeviceSession, screen: Screen) -> None:
        self.session = session
        self.screen = screen
        self.pixels = b""
        self.row = ""
        super().__setitem__(slice(None), bytes([WHITE]) * len(self))

    def __setitem__(self, key: Any, value: Any) -> None:
        """Write bytes to a position in the display's memory, and display them."""
        super().__setitem__(key, value)
        self._update()

    def write(self, data: Any) -> int:
        """Write bytes at the present position of the memory, display them, and return their number."""
        size = super().write(data)
        self._update()
        return size

    def flush(self, *_part: int) -> None:
        """Display bytes that were written in other ways, such as through a `memoryview`."""
        self._update()

    def close(self) -> None:
        """Do nothing: a program's other mappings of the display are this same object, which may still be in use."""

    def _update(self) -> None:
        """Display the contents of the memory, and let the time of such an update on the brick pass."""
        # An update counts as a command even if it takes no time, so that no loop of updates runs forever.
        self.session.command()
        self.session.charge(self.session.sim.spec.profile.display_update_ns)
        pixels = self[:]
        if pixels != self.pixels:
            self.pixels, self.row = pixels, display_row(picture_of(pixels))
        self.screen.show(self.row, Stream.DISPLAY)


class DisplayFile(DeviceFile):
    """The device file of the display's memory, `/dev/fb0`."""

    def __init__(self, session: DeviceSession, screen: Screen) -> None:
        super().__init__(DISPLAY_PATH, stat.S_IFCHR | 0o660)
        self._session = session
        self._screen = screen

    @cached_property
    def _memory(self) -> DisplayBuffer:
        return DisplayBuffer(self._session, self._screen)

    def read(self, opened: OpenFile, size: int) -> bytes:
        """Return up to `size` bytes of the display's memory from the file's present position on."""
        end = len(self._memory) if size < 0 else opened.at + size
        part = self._memory[opened.at : end]
        opened.at += len(part)
        return part

    def write(self, opened: OpenFile, data: bytes) -> int:
        """Write pixels, display them, and return the number of written bytes."""
        room = len(self._memory) - opened.at
        if data and room <= 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        part = data[:room]
        self._memory[opened.at : opened.at + len(part)] = part
        opened.at += len(part)
        return len(part)

    def ioctl(self, request: int) -> bytes:
        """Return the kernel's information about the display: its size and the format of its pixels.

        Raises:
            NotSimulated: the request is for something else.
        """
        match request:
            case 0x4600:
                return VARIABLE_INFO
            case 0x4602:
                return FIXED_INFO
        raise refuse_ioctl(
            self.path,
            request,
            "a program may ask for the screen's size and format, and write pixels",
        )

    def mapping(self, length: int) -> Any:
        """Return the memory of the display."""
        if length > len(self._memory):
            raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))
        return self._memory


def picture_of(pixels: bytes) -> bytes:
    """Return the image in the display's memory with one bit per pixel, in the format of `engine.runs.brick_state`.

    Of the four bytes per pixel, the display shows the green one.
    """
    from PIL import Image

    return dark_pixels(Image.frombytes("L", (DISPLAY_WIDTH, DISPLAY_HEIGHT), pixels[2::4]))


def dark_pixels(grey: Picture) -> bytes:
    """Return the dark pixels of a grey picture, one bit per pixel, in the format of `engine.runs.brick_state`."""
    return grey.point([WHITE if level < DARK_BELOW else 0 for level in range(256)], "1").tobytes()


def draw_with_the_bricks_font(screen_class: Any) -> None:
    """Patch a class so that its objects draw text in the brick's default font, unless the program names another.

    Args:
        screen_class: A class of the library; its objects have an `ImageDraw` in `draw`.
    """
    make = screen_class.__init__

    @wraps(make)
    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N807
        make(self, *args, **kwargs)
        self.draw.font = plain_font()

    screen_class.__init__ = __init__
