"""Any picture as a mat: found, checked before it is decoded, and laid on the field.

Whatever Pillow reads will do, in any size and mode up to the two limits below. A picture
is turned as its EXIF data say and put on white. How it meets the field is one of
`core.spec.BACKGROUND_FITS`:

stretch   fills the field, the proportions give way
fit       as large as the field allows, in the middle, white around it
centre    one pixel is one mm, in the middle; what is too large is cut off
corner    one pixel is one mm, from the upper left corner, as in the browser simulator of the course
"""

from __future__ import annotations

import stat
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.core.spec import BACKGROUND_FITS, FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.errors import BackgroundError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.Image import Image

MAX_MEGAPIXELS = 40
"""Pictures with more pixels are refused before they are decoded."""

MAX_FILE_MB = 256
"""Larger files are refused before they are read."""

_HINT = f"a mat is a picture such as PNG or JPEG, at most {MAX_MEGAPIXELS} megapixels and {MAX_FILE_MB} MB"
_FIELD = (FIELD_WIDTH_MM, FIELD_HEIGHT_MM)
_PNG = b"\x89PNG\r\n\x1a\n"


def _refused(message: str, path: Path) -> BackgroundError:
    return BackgroundError(message, _HINT, file=str(path))


def check_file(path: Path) -> None:
    """Make sure that there is a file to read a picture from; it is not opened.

    Raises:
        BackgroundError: there is none, it is a folder or a device, is empty or too large.
    """
    try:
        found = path.stat()
    except OSError as error:
        raise _refused(f"cannot be read: {error.strerror or error}", path) from error
    except ValueError as error:
        # A null character.
        raise _refused(f"is no file name: {error}", path) from error
    if stat.S_ISDIR(found.st_mode):
        raise _refused("is a folder, not a picture", path)
    # Reading from a pipe or a device might never end.
    if not stat.S_ISREG(found.st_mode):
        raise _refused("is not a regular file", path)
    if not found.st_size:
        raise _refused("is empty, not a picture", path)
    if found.st_size > MAX_FILE_MB * 1_000_000:
        raise _refused(f"is too large: {found.st_size / 1e6:,.0f} MB, allowed are {MAX_FILE_MB} MB", path)


def read_file(path: Path) -> bytes:
    """Return the bytes of a picture's file.

    Raises:
        BackgroundError: `check_file` refuses it, or it cannot be read.
    """
    check_file(path)
    try:
        return path.read_bytes()
    except OSError as error:
        raise _refused(f"cannot be read: {error.strerror or error}", path) from error


def check_fit(fit: str) -> None:
    """Make sure that `fit` is one of BACKGROUND_FITS.

    Raises:
        BackgroundError: it is not.
    """
    if fit not in BACKGROUND_FITS:
        raise BackgroundError(f"no such fit {fit!r}", f"one of {', '.join(BACKGROUND_FITS)}", key="background_fit")


def fits_as_it_is(content: bytes) -> bool:
    """Return whether a picture is surely a field's own size, so that every fit gives the same.

    Looks only at what a PNG file begins with: cheap enough to be asked before every run.
    """
    size = tuple(int.from_bytes(content[at : at + 4], "big") for at in (16, 20))
    return content.startswith(_PNG) and size == _FIELD and b"eXIf" not in content


def size_of(content: bytes) -> tuple[int, int]:
    """Return width and height of a picture that can be decoded, in pixels."""
    import io

    from PIL import Image

    with Image.open(io.BytesIO(content)) as picture:
        return picture.size


def decode(content: bytes, path: Path, fit: str) -> NDArray[np.uint8]:
    """Return the field as a picture shows it.

    Args:
        content: The picture's file.
        path: What it is called, for messages.
        fit: One of BACKGROUND_FITS.

    Returns:
        Shape (height, width, 3), rows from the top.

    Raises:
        BackgroundError: it is no picture, is damaged, has no pixels or too many.
    """
    import io
    import warnings

    import numpy as np
    from PIL import Image, ImageOps

    with warnings.catch_warnings():
        # Odd metadata and large sizes: what matters is refused below.
        warnings.simplefilter("ignore")
        try:
            picture = Image.open(io.BytesIO(content))
        except Image.DecompressionBombError as error:
            raise _refused(f"is too large: far more than {MAX_MEGAPIXELS} megapixels", path) from error
        # A damaged file makes the readers of Pillow raise anything, also what they do not document.
        except Exception as error:
            raise _refused("is not a picture that can be read", path) from error
        with picture:
            _check_size(picture, path)
            try:
                ImageOps.exif_transpose(picture, in_place=True)
                upright = _on_white(picture)
            # As above.
            except Exception as error:
                reason = str(error) or type(error).__name__
                raise _refused(f"is not a picture that can be read whole: {reason}", path) from error
    _check_size(upright, path)
    return np.asarray(_laid(upright, fit))


def _check_size(picture: Image, path: Path) -> None:
    width, height = picture.size
    if width < 1 or height < 1:
        raise _refused(f"has no pixels: {width} × {height}", path)
    if width * height > MAX_MEGAPIXELS * 1_000_000:
        raise _refused(
            f"is too large: {width:,} × {height:,} pixels are {width * height / 1e6:,.0f} megapixels, "
            f"allowed are {MAX_MEGAPIXELS}",
            path,
        )


def _on_white(picture: Image) -> Image:
    """The picture in RGB, its transparent parts on white."""
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
    """A grey picture of more than eight bits a pixel, with all its shades in 0 … 255."""
    import numpy as np
    from PIL import Image

    values = np.nan_to_num(np.asarray(picture, dtype=np.float32), nan=0.0)
    top = float(values.max())
    if picture.mode == "F" and top <= 1.0:
        values = values * 255.0
    elif picture.mode.startswith("I;16") or top > 255.0:
        values = values / 257.0
    return Image.fromarray(np.rint(np.clip(values, 0.0, 255.0)).astype(np.uint8)).convert("RGB")


def _laid(picture: Image, fit: str) -> Image:
    """The picture on the field."""
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
    left, top = (0 if corner else (side - own) // 2 for side, own in zip(_FIELD, picture.size, strict=True))
    field.paste(picture, (left, top))
    return field
