"""Any image as a mat: checked before it is decoded, and placed on the field.

Every format that Pillow itself decodes is accepted, in any size and mode within the two limits below. An image
is rotated according to its EXIF data and put on white. It is placed on the field by one of
`engine.core.spec.BACKGROUND_FITS`:

stretch   fills the field, without keeping proportions
fit       as large as the field allows, centred, white around it
centre    one pixel is one mm, centred; larger images are cropped
corner    one pixel is one mm, from the upper left corner, as in the course's browser simulator
"""

from __future__ import annotations

import io
import stat
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.errors import BackgroundError
from tuisim.base.regular_file import read_regular
from tuisim.engine.core.spec import BACKGROUND_FITS, FIELD_HEIGHT_MM, FIELD_WIDTH_MM

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.Image import Image

POSTSCRIPT = "EPS"
"""The format that Pillow lets another program draw, which runs what is in the file: it is refused."""
MAX_MEGAPIXELS = 40
"""Images with more pixels are rejected before they are decoded."""

MAX_FILE_MB = 256
"""Larger files are rejected before they are read."""

_HINT = f"a mat is an image such as PNG or JPEG, at most {MAX_MEGAPIXELS} megapixels and {MAX_FILE_MB} MB"
_FIELD = (FIELD_WIDTH_MM, FIELD_HEIGHT_MM)
_PNG = b"\x89PNG\r\n\x1a\n"


def _error(message: str, path: Path) -> BackgroundError:
    return BackgroundError(message, _HINT, file=str(path))


def check_file(path: Path) -> None:
    """Check that an image file exists and can be read; it is not opened.

    Raises:
        BackgroundError: it does not exist, is not a regular file, is empty or too large.
    """
    try:
        status = path.stat()
    except OSError as error:
        raise _error(f"cannot be read: {error.strerror or error}", path) from error
    except ValueError as error:
        # The path contains a null character.
        raise _error(f"is not a file name: {error}", path) from error
    if stat.S_ISDIR(status.st_mode):
        raise _error("is a folder, not an image", path)
    # Reading from a pipe or a device might block forever.
    if not stat.S_ISREG(status.st_mode):
        raise _error("is not a regular file", path)
    if not status.st_size:
        raise _error("is empty, not an image", path)
    if status.st_size > MAX_FILE_MB * 1_000_000:
        raise _error(
            f"is too large: {status.st_size / 1e6:,.0f} MB, the limit is {MAX_FILE_MB} MB", path
        )


def read_file(path: Path) -> bytes:
    """Return the bytes of an image file.

    Raises:
        BackgroundError: `check_file` rejects it, or it cannot be read.
    """
    check_file(path)
    try:
        return read_regular(path, MAX_FILE_MB * 1_000_000, follow_links=True)
    except OSError as error:
        raise _error(f"cannot be read: {error.strerror or error}", path) from error


def check_fit(fit: str) -> None:
    """Check that `fit` is one of BACKGROUND_FITS.

    Raises:
        BackgroundError: it is not.
    """
    if fit not in BACKGROUND_FITS:
        raise BackgroundError(
            f"no such fit {fit!r}", f"one of {', '.join(BACKGROUND_FITS)}", key="background_fit"
        )


def fits_as_it_is(content: bytes) -> bool:
    """Return whether an image is a PNG file of exactly the field's size, so that every fit gives the same result.

    Only the header of the file is read, so this is fast enough to be called before every run.
    """
    size = tuple(int.from_bytes(content[offset : offset + 4], "big") for offset in (16, 20))
    return content.startswith(_PNG) and size == _FIELD and b"eXIf" not in content


def size_of(content: bytes) -> tuple[int, int]:
    """Return width and height in pixels of an image that can be decoded."""
    from PIL import Image

    with Image.open(io.BytesIO(content)) as picture:
        return picture.size


def read_pixels(path: Path, fit: str) -> NDArray[np.uint8]:
    """Return the pixels of the field with the image of a file on it: shape (height, width, 3), rows from the top.

    Args:
        path: The image file.
        fit: One of BACKGROUND_FITS.

    Raises:
        BackgroundError: the file cannot be read, or `decode` raises it.
    """
    return decode(read_file(path), path, fit)


def decode(content: bytes, path: Path, fit: str) -> NDArray[np.uint8]:
    """Return the pixels of the field with an image on it.

    Args:
        content: The bytes of the image file.
        path: The path of the file, for messages.
        fit: One of BACKGROUND_FITS.

    Returns:
        Shape (height, width, 3), rows from the top.

    Raises:
        BackgroundError: it is not an image, is damaged, has no pixels or too many.
    """
    import numpy as np
    from PIL import Image, ImageOps

    with warnings.catch_warnings():
        # Pillow warns of odd metadata and large sizes; the limits are checked below.
        warnings.simplefilter("ignore")
        try:
            picture = Image.open(io.BytesIO(content))
        except Image.DecompressionBombError as error:
            raise _error(
                f"is too large: far more than {MAX_MEGAPIXELS} megapixels", path
            ) from error
        # Pillow may raise any exception on a damaged file, also undocumented ones.
        except Exception as error:
            raise _error("is not a readable image", path) from error
        with picture:
            if picture.format == POSTSCRIPT:
                raise _error("is PostScript, a program", path)
            _check_size(picture, path)
            try:
                ImageOps.exif_transpose(picture, in_place=True)
                upright = _on_white(picture)
            # As above.
            except Exception as error:
                reason = str(error) or type(error).__name__
                raise _error(f"is a damaged image: {reason}", path) from error
    _check_size(upright, path)
    return np.asarray(_placed(upright, fit))


def _check_size(picture: Image, path: Path) -> None:
    width, height = picture.size
    if width < 1 or height < 1:
        raise _error(f"has no pixels: {width} × {height}", path)
    if width * height > MAX_MEGAPIXELS * 1_000_000:
        raise _error(
            f"is too large: {width:,} × {height:,} pixels are {width * height / 1e6:,.0f} megapixels, "
            f"the limit is {MAX_MEGAPIXELS}",
            path,
        )


def _on_white(picture: Image) -> Image:
    """Return the image in RGB, with transparent parts on white."""
    from PIL import Image

    if picture.mode[0] in "IF":
        return _in_eight_bits(picture)
    if picture.has_transparency_data:
        seen = picture.convert("RGBA")
        white = Image.new("RGB", seen.size, "white")
        white.paste(seen, mask=seen)
        return white
    return picture.convert("RGB")


def _in_eight_bits(picture: Image) -> Image:
    """Return a grey image that has more than eight bits per pixel as an RGB image with eight bits per channel.

    Values of 16 bits, or of 0 to 1, are scaled to 0 … 255; all other values stay.
    """
    import numpy as np
    from PIL import Image

    values = np.nan_to_num(np.asarray(picture, dtype=np.float32), nan=0.0)
    top = float(values.max())
    if picture.mode == "F" and top <= 1.0:
        values = values * 255.0
    elif picture.mode.startswith("I;16") or top > 255.0:
        values = values / 257.0
    return Image.fromarray(np.rint(np.clip(values, 0.0, 255.0)).astype(np.uint8)).convert("RGB")


def _placed(picture: Image, fit: str) -> Image:
    """Return an image of the field's size that shows the given image on white, placed or scaled as `fit` says."""
    from PIL import Image

    if picture.size == _FIELD:
        return picture
    if fit == "stretch":
        return picture.resize(_FIELD, Image.Resampling.LANCZOS)
    if fit == "fit":
        scale = min(side / own for side, own in zip(_FIELD, picture.size, strict=True))
        width, height = (max(1, round(own * scale)) for own in picture.size)
        picture = picture.resize((width, height), Image.Resampling.LANCZOS)
    field = Image.new("RGB", _FIELD, "white")
    corner = fit == "corner"
    left, top = (
        0 if corner else (side - own) // 2 for side, own in zip(_FIELD, picture.size, strict=True)
    )
    field.paste(picture, (left, top))
    return field
