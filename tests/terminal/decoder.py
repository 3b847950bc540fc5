"""A terminal that decodes pictures: sixel, inline images of iTerm2, and images of kitty at placeholders."""

from __future__ import annotations

import re
import zlib
from base64 import b64decode
from io import BytesIO

import numpy as np
import numpy.typing as npt
from PIL import Image

from tuisim.terminal import kitty

Pixels = npt.NDArray[np.uint8]

_CODE = re.compile(
    r"\x1b\[(?P<row>\d+);(?P<col>\d+)H"
    r"|\x1b\[(?P<style>[\d;]*)m"
    r"|\x1b\[(?P<steps>\d+)C"
    r"|\x1b\[(?P<other>[?>=]?[\d;$]*[a-zA-Z])"
    r"|\x1b\](?!1337)(?P<command>[^\x1b\x07]*)(?:\x1b\\|\x07)"
    r"|\x1bPtmux;(?P<tmux>(?:\x1b\x1b|[^\x1b])*)\x1b\\"
    r"|\x1bP[\d;]*q(?P<sixel>[^\x1b]*)\x1b\\"
    r"|\x1b_G(?P<keys>[^;\x1b]*)(?:;(?P<data>[^\x1b]*))?\x1b\\"
    r"|\x1b\]1337;File=(?P<file>[^:]*):(?P<content>[^\x07]*)\x07"
    rf"|{kitty.PLACEHOLDER}(?P<down>.)(?P<right>.)"
    r"|(?P<text>.)",
    re.DOTALL,
)


class PixelTerminal:
    """What a terminal shows.

    Args:
        rows: Number of rows.
        cols: Number of columns.
        cell_px: Width and height of a cell.
    """

    def __init__(self, rows: int, cols: int, cell_px: tuple[int, int]) -> None:
        self._cell_px = cell_px
        self._drawn: Pixels = np.zeros((rows * cell_px[1], cols * cell_px[0], 3), np.uint8)
        self.texts: dict[tuple[int, int], str] = {}
        """Characters that are not part of a picture, by row and column."""
        self._placed: dict[tuple[int, int], tuple[int, int, int]] = {}
        """The image, row and column that the placeholder of a cell shows."""
        self.images: dict[int, tuple[Pixels, int, int]] = {}
        """Images of kitty with their columns and rows, by number."""
        self._row = self._col = self._color = 0
        self._keys: dict[str, str] = {}
        self._data = ""

    def feed(self, codes: str) -> None:
        """Take codes."""
        for match in _CODE.finditer(codes):
            found = match.groupdict()
            if found["row"]:
                self._row, self._col = int(found["row"]) - 1, int(found["col"]) - 1
            elif found["style"] is not None:
                parts = found["style"].split(";")
                if parts[:2] == ["38", "2"]:
                    self._color = int(parts[2]) << 16 | int(parts[3]) << 8 | int(parts[4])
            elif found["steps"]:
                self._col += int(found["steps"])
            elif found["other"] is not None or found["command"] is not None:
                continue
            elif found["tmux"] is not None:
                self.feed(found["tmux"].replace("\x1b\x1b", "\x1b"))
            elif found["sixel"] is not None:
                self._sixel(found["sixel"])
            elif found["keys"] is not None:
                self._kitty(found["keys"], found["data"] or "")
            elif found["file"] is not None:
                self._inline(found["file"], found["content"])
            elif found["down"]:
                at = kitty.DIACRITICS.index(found["down"]), kitty.DIACRITICS.index(found["right"])
                self.texts.pop((self._row, self._col), None)
                self._placed[self._row, self._col] = self._color, *at
                self._col += 1
            else:
                self._write(found["text"])

    def _write(self, text: str) -> None:
        assert text.isprintable() or text == "\n", repr(text)
        self._placed.pop((self._row, self._col), None)
        self.texts[self._row, self._col] = text
        self._col += 1

    def _cells(self, top: int, left: int, height_px: int, width_px: int) -> tuple[slice, slice]:
        width, height = self._cell_px
        for row in range(top, top - -height_px // height):
            for col in range(left, left - -width_px // width):
                self.texts.pop((row, col), None)
        return slice(top * height, top * height + height_px), slice(
            left * width, left * width + width_px
        )

    def _paste(self, pixels: Pixels) -> None:
        height_px, width_px = pixels.shape[:2]
        rows, cols = self._cells(self._row, self._col, height_px, width_px)
        assert self._drawn[rows, cols].shape == pixels.shape, "drawn beyond the screen"
        self._drawn[rows, cols] = pixels

    def _inline(self, keys: str, content: str) -> None:
        values = dict(key.split("=") for key in keys.split(";"))
        data = b64decode(content)
        assert int(values["size"]) == len(data)
        width_px, height_px = (
            int(values["width"]) * self._cell_px[0],
            int(values["height"]) * self._cell_px[1],
        )
        image = Image.open(BytesIO(data)).convert("RGB")
        self._paste(np.asarray(image.resize((width_px, height_px), Image.Resampling.NEAREST)))

    def _kitty(self, keys: str, data: str) -> None:
        values = dict(key.split("=") for key in keys.split(","))
        if values.get("a") == "d":
            if values["d"] == "I":
                del self.images[int(values["i"])]
            elif values["d"] == "R":
                gone = range(int(values["x"]), int(values["y"]) + 1)
                self.images = {
                    number: one for number, one in self.images.items() if number not in gone
                }
            # Images at placeholders are not placed on the screen, so `d=A` does not concern them.
            return
        self._keys = self._keys or values
        self._data = self._data + data
        assert len(data) <= 4096
        if values.get("m") == "1":
            return
        first = self._keys
        raw = zlib.decompress(b64decode(self._data))
        pixels = np.frombuffer(raw, np.uint8).reshape(int(first["v"]), int(first["s"]), 3)
        self.images[int(first["i"])] = pixels, int(first["c"]), int(first["r"])
        self._keys = {}
        self._data = ""

    def _sixel(self, data: str) -> None:
        size, _, data = data.partition("#")
        width_px, height_px = map(int, size.strip('"').split(";")[2:])
        canvas = np.zeros((height_px, width_px, 3), np.uint8)
        colors: dict[int, tuple[int, ...]] = {}
        top = at = 0
        color: tuple[int, ...] = (0, 0, 0)
        for match in re.finditer(
            r"#(\d+)(?:;2;(\d+);(\d+);(\d+))?|!(\d+)(.)|([?-~])|([$-])", "#" + data
        ):
            number, red, green, blue, count, repeated, single, move = match.groups()
            if number and red:
                colors[int(number)] = tuple(
                    round(int(channel) * 255 / 100) for channel in (red, green, blue)
                )
            elif number:
                color = colors[int(number)]
            elif move:
                at = 0
                top = top + 6 * (move == "-")
            else:
                bits = ord(repeated or single) - 63
                many = int(count or 1)
                for row in range(6):
                    if bits & 1 << row:
                        canvas[top + row, at : at + many] = color
                at += many
        self._paste(canvas)

    @property
    def pixels(self) -> Pixels:
        """What is seen of pictures; black where there is text."""
        shown, (width, height) = self._drawn.copy(), self._cell_px
        for (row, col), (number, down, right) in self._placed.items():
            if number not in self.images:
                continue
            image, cols, rows = self.images[number]
            scaled = np.asarray(
                Image.fromarray(image).resize(
                    (cols * width, rows * height), Image.Resampling.NEAREST
                )
            )
            part = scaled[down * height : (down + 1) * height, right * width : (right + 1) * width]
            shown[row * height : (row + 1) * height, col * width : (col + 1) * width] = part
        for row, col in self.texts:
            shown[row * height : (row + 1) * height, col * width : (col + 1) * width] = 0
        return shown
