"""The screen, and the frame buffer into which the library copies its image."""

from __future__ import annotations

import mmap
import types
from functools import cache, wraps
from typing import Any

from tuisim.runs.brick_state import DISPLAY_HEIGHT, DISPLAY_WIDTH, display_row
from tuisim.runs.records import Stream
from tuisim.shim.fonts import plain_font
from tuisim.shim.session import Session

BITS_A_PIXEL = 32
"""As the driver reports it; the display itself is black and white."""
LINE_BYTES = DISPLAY_WIDTH * BITS_A_PIXEL // 8
WHITE, DARK_BELOW = 255, 128
"""Greys below `DARK_BELOW` are dark."""
TRUE_COLOR = 2
"""The kernel's visual type for red, green and blue pixels."""
NO_FILE = -1
"""Replaces the descriptor of the device file."""


class Screen:
    """Records the contents of the brick's screen, images and text, each time they change."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._shown: tuple[str, Stream] | None = None

    def show(self, row: str, stream: Stream) -> None:
        """Show an image or a text, in the format of `runs.brick_state`; unchanged contents are not recorded again."""
        if (row, stream) != self._shown:
            self._shown = (row, stream)
            self._session.show(row, stream)


class FrameBuffer(mmap.mmap):
    """The memory of the display: bytes written there are displayed.

    Each pixel has four bytes: unused, red, green, blue.
    """

    def __new__(cls, _session: Session, _screen: Screen) -> FrameBuffer:
        """Allocate anonymous memory instead of mapping a file."""
        return super().__new__(cls, NO_FILE, LINE_BYTES * DISPLAY_HEIGHT)

    def __init__(self, session: Session, screen: Screen) -> None:
        self.session, self.screen = session, screen
        self.pixels, self.row = b"", ""
        super().__setitem__(slice(None), bytes([WHITE]) * len(self))

    def __setitem__(self, key: Any, value: Any) -> None:
        """Write bytes and display them. Charges the time of an update on the brick."""
        super().__setitem__(key, value)
        # Counted even if it costs nothing.
        self.session.command()
        self.session.charge(self.session.sim.spec.profile.display_update_ns)
        pixels = self[:]
        if pixels != self.pixels:
            self.pixels, self.row = pixels, display_row(picture_of(pixels))
        self.screen.show(self.row, Stream.DISPLAY)


def picture_of(pixels: bytes) -> bytes:
    """Return the image in the display's memory, one bit per pixel, in the format of `runs.brick_state`.

    Of the four bytes per pixel the display shows the green one.
    """
    from PIL import Image

    grey = Image.frombytes("L", (DISPLAY_WIDTH, DISPLAY_HEIGHT), pixels[2::4])
    return grey.point([WHITE if level < DARK_BELOW else 0 for level in range(256)], "1").tobytes()


def patch_display_module(session: Session, module: types.ModuleType, screen: Screen) -> None:
    """Patch `ev3dev2.display` after its import: a frame buffer without a device file."""
    display: Any = module
    memory = display.FbMem

    def fixed_info(_fbfid: int) -> Any:
        size = LINE_BYTES * DISPLAY_HEIGHT
        return memory.FixScreenInfo(id_name=b"st7586", smem_len=size, visual=TRUE_COLOR, line_length=LINE_BYTES)

    def variable_info(_fbfid: int) -> Any:
        info = memory.VarScreenInfo(
            xres=DISPLAY_WIDTH,
            yres=DISPLAY_HEIGHT,
            xres_virtual=DISPLAY_WIDTH,
            yres_virtual=DISPLAY_HEIGHT,
            bits_per_pixel=BITS_A_PIXEL,
        )
        for color, offset in (("red", 16), ("green", 8), ("blue", 0)):
            setattr(info, color, memory.VarScreenInfo.FbBitField(offset, 8, 0))
        return info

    @cache
    def buffer() -> FrameBuffer:
        return FrameBuffer(session, screen)

    memory._open_fbdev = staticmethod(lambda _fbdev=None: NO_FILE)
    memory._get_fix_info = staticmethod(fixed_info)
    memory._get_var_info = staticmethod(variable_info)
    memory._map_fb_memory = staticmethod(lambda _fbfid, _fix_info: buffer())
    _use_the_bricks_font(display)


def _use_the_bricks_font(display: Any) -> None:
    """Draw text without a named font in the default font of the brick's Pillow."""
    make = display.Display.__init__

    @wraps(make)
    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N807
        make(self, *args, **kwargs)
        self.draw.font = plain_font()

    display.Display.__init__ = __init__
