"""A cache of mats prepared for the sensors: raw files that are memory-mapped.

`prepare` does the slow part once per image and disc diameter and stores the result in the
cache folder; `open_field` maps it. Modules that only `prepare` needs are imported there,
so that a child process can open a field quickly.

Beside each file lies a note of its checksum, and of the file's identity when that was last known to be right: its
inode, size and times. As long as they are the same, nothing has written to it, and it need not be read to be trusted.
A damaged file is made again.
"""

from __future__ import annotations

import mmap
import os
import zlib
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.atomic import make_private_folder, replacing, sweep
from tuisim.base.data_class import dataclass
from tuisim.base.errors import BackgroundError
from tuisim.base.folders import cache_folder
from tuisim.base.regular_file import open_regular, read_regular
from tuisim.engine.core.field import Field, build_disc_mask, find_floor_rgb
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.mat_image import check_fit, decode, fits_as_it_is, read_file

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MAX_CACHED_FILES = 30
"""The cache keeps this many files, the most recently used ones; the file with the sums of one diameter takes 33 MB."""

MAX_DIAMETER_PX = 128
"""Largest diameter of a disc: the sum of a row of its pixels, all white, must fit into a signed 16-bit integer."""

_LAYOUT = 1
"""Version in the names of the cached files: increase it when the files' layout or the decoding of images changes."""
_BLOCK_ROWS = 64
"""Rows summed at a time, few enough for the processor's cache."""
_NOTE_SUFFIX = ".check"
_MOST_NOTE_BYTES = 1000
_READ_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class FieldFiles:
    """The files of a mat that is prepared for colour sensors: one with its pixels, others with sums of pixels.

    The sums say how much red, green and blue a sensor sees in its spot, a disc, at any position. Any process may open
    the files while the cache keeps them.
    """

    width_px: int
    height_px: int
    pixels: Path
    """Raw RGB bytes, rows from the top."""
    sums: tuple[tuple[int, Path], ...]
    """Pairs of disc diameter and the file with its sums; for the layout see `engine.core.field.Field`."""

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files of the mat, and the notes of their checksums."""
        return (*self._sizes, *map(_note_of, self._sizes))

    @property
    def _sizes(self) -> dict[Path, int]:
        """The size of each file in bytes, that of the pixels first."""
        width, height = self.width_px, self.height_px
        sizes = {path: 12 * (width + disc) * (height + disc) for disc, path in self.sums}
        return {self.pixels: 3 * width * height, **sizes}

    def is_for(self, diameters: Collection[int]) -> bool:
        """Return whether these are the files of a mat of the field's size, with sums for discs of these diameters."""
        size = self.width_px, self.height_px
        return size == (FIELD_WIDTH_MM, FIELD_HEIGHT_MM) and {
            diameter for diameter, _ in self.sums
        } >= set(diameters)

    def identities(self) -> tuple[tuple[int, ...], ...]:
        """Return a tuple of numbers for each file, which change when the file is written to or replaced.

        Missing files are left out.
        """
        identities = []
        for path in self._sizes:
            with suppress(OSError):
                identities.append(_identity(path.stat()))
        return tuple(identities)

    @property
    def are_sound(self) -> bool:
        """Whether the cache still has all files, undamaged; if so, they are marked as used now."""
        return all(_in_use(path, size) for path, size in self._sizes.items())

    def to_plain(self) -> dict[str, Any]:
        """Return the files as JSON-compatible data."""
        return {
            "width_px": self.width_px,
            "height_px": self.height_px,
            "pixels": str(self.pixels),
            "sums": [[diameter, str(path)] for diameter, path in self.sums],
        }

    @classmethod
    def from_plain(cls, data: Mapping[str, Any]) -> FieldFiles:
        """Return the files that `to_plain` has turned into data.

        Raises:
            KeyError, TypeError, ValueError: `data` was not written by `to_plain`.
        """
        sums = tuple((int(diameter), Path(path)) for diameter, path in data["sums"])
        return cls(int(data["width_px"]), int(data["height_px"]), Path(data["pixels"]), sums)

    def read_pixels(self) -> NDArray[np.uint8]:
        """Return a copy of a prepared mat for drawing: shape (height, width, 3), rows from the top, read-only.

        Raises:
            BackgroundError: the file is missing or incomplete.
        """
        import numpy as np

        data = _open_data(self.pixels, self._sizes[self.pixels], is_copied=True)
        return np.frombuffer(data, np.uint8).reshape(self.height_px, self.width_px, 3)

    def open_field(self, *, has_floor: bool = False, is_copied: bool = False) -> Field:
        """Return the mat, with its files mapped into memory. Any process may call this.

        Args:
            has_floor: Whether the mat lies on a floor, which has the colour of the mat's edges; see
                `WorldSpec.is_open`.
            is_copied: Whether the files are read into memory instead. A process that outlives programs needs this: the
                system kills a process that reads a mapped file after a program has cut off its end.

        Raises:
            BackgroundError: a file is missing, for example because the cache evicted it, or incomplete.
        """
        width, height = self.width_px, self.height_px
        data = {path: _open_data(path, size, is_copied) for path, size in self._sizes.items()}
        pixels = data[self.pixels]
        sums = {diameter: data[path].cast("I") for diameter, path in self.sums}
        return Field(
            width,
            height,
            pixels,
            sums,
            find_floor_rgb(width, height, pixels) if has_floor else None,
        )

    @classmethod
    def prepare(cls, image: Path, diameters: Iterable[int], fit: str = "stretch") -> FieldFiles:
        """Write the files of a mat into the cache, for colour sensors of given diameters, and return them.

        Files that are already in the cache are reused.

        Args:
            image: Any image that Pillow reads, within the limits of `mat_image`.
            diameters: Disc diameters in pixels, in any order, with or without duplicates.
            fit: How an image whose size differs from the field's is placed, one of
                `engine.core.spec.BACKGROUND_FITS`; see `mat_image`.

        Raises:
            BackgroundError: the image cannot be read, a diameter or `fit` is impossible, or the cache folder cannot be
                written.
        """
        import hashlib

        sizes = sorted(set(diameters))
        for diameter in sizes:
            if not 1 <= diameter <= MAX_DIAMETER_PX:
                raise BackgroundError(
                    f"disc diameter must be from 1 to {MAX_DIAMETER_PX} pixels, got {diameter}"
                )
        check_fit(fit)
        content = read_file(image)
        folder = cache_folder() / "fields"
        how = "" if fits_as_it_is(content) else f"{fit}-"
        stem = f"{hashlib.sha256(content).hexdigest()[:24]}-{how}{_LAYOUT}"
        sums = tuple((diameter, folder / f"{stem}-{diameter}.sums") for diameter in sizes)
        files = cls(FIELD_WIDTH_MM, FIELD_HEIGHT_MM, folder / f"{stem}.rgb", sums)
        missing = {path for path, size in files._sizes.items() if not _in_use(path, size)}
        if missing:
            _make(files, missing, decode(content, image, fit))
        return files


def _in_use(path: Path, size: int) -> bool:
    """Return whether the cache has a sound file of this size; if so, mark it as used now."""
    try:
        noted = _noted(path)
        with open_regular(path) as stream:
            status = os.fstat(stream.fileno())
            if status.st_size != size or noted is None:
                return False
            checksum, identity = noted
            if identity == _identity(status):
                os.utime(_note_of(path))
                return True
            if _checksum(stream.fileno()) != checksum:
                return False
        _note(path, checksum, status)
    except OSError:
        return False
    return True


def _note_of(path: Path) -> Path:
    return path.with_name(path.name + _NOTE_SUFFIX)


def _identity(found: os.stat_result) -> tuple[int, ...]:
    """Return numbers that change when a file is written to, or when another file takes its place."""
    return found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns


def _noted(path: Path) -> tuple[int, tuple[int, ...]] | None:
    """Return what the note of a file contains: its checksum, and the numbers of `_identity`.

    Return None if there is no valid note.
    """
    try:
        checksum, *identity = map(int, read_regular(_note_of(path), _MOST_NOTE_BYTES).split())
    except (OSError, ValueError):
        return None
    return checksum, tuple(identity)


def _note(path: Path, checksum: int, found: os.stat_result) -> None:
    with replacing(_note_of(path), durable=False, owner_only=True, follow_links=False) as stream:
        stream.write(" ".join(map(str, (checksum, *_identity(found)))).encode())


def _checksum(descriptor: int) -> int:
    checksum = offset = 0
    while part := os.pread(descriptor, _READ_BYTES, offset):
        checksum = zlib.crc32(part, checksum)
        offset = offset + len(part)
    return checksum


def _make(files: FieldFiles, missing: Collection[Path], pixels: NDArray[np.uint8]) -> None:
    """Write the pixels and the missing sums into the cache, then evict old files."""
    folder = files.pixels.parent
    try:
        make_private_folder(folder)
        _store(files.pixels, pixels)
        for diameter, path in files.sums:
            if path in missing:
                _store(path, _disc_sums(pixels, diameter))
        _trim(folder, files._sizes)
    except OSError as error:
        raise BackgroundError(
            f"the mat cannot be prepared: {error.strerror or error}",
            "set TUISIM_HOME to a writable folder",
            file=str(folder),
        ) from error


def _disc_sums(pixels: NDArray[np.uint8], diameter: int) -> NDArray[np.uint32]:
    """Return the sums of red, green and blue over the disc at every position, shape (height + d, width + d, 3).

    Here d is the diameter. `Field.sums` describes which position has which index.
    """
    import numpy as np

    height, width, _ = pixels.shape
    # From one disc to its right neighbour the sum gains the pixel after each row of the
    # disc and loses the row's first: two small additions per row, and one cumulative sum.
    dark = np.zeros((height + 2 * diameter, width + 2 * diameter + 1, 3), np.int16)
    dark[diameter : diameter + height, diameter + 1 : diameter + 1 + width] = pixels
    around = dark.reshape(len(dark), -1)
    spans = [
        (row, 3 * inside.index(True), 3 * (diameter - inside[::-1].index(True)))
        for row, inside in enumerate(build_disc_mask(diameter))
        if any(inside)
    ]
    sums = np.empty((height + diameter, width + diameter, 3), np.uint32)
    samples = 3 * (width + diameter)
    for top in range(0, len(sums), _BLOCK_ROWS):
        block = sums[top : top + _BLOCK_ROWS]
        change = np.zeros((len(block), samples), np.int16)
        for row, first, after in spans:
            beneath = around[top + row : top + row + len(block)]
            change += beneath[:, after : after + samples]
            change -= beneath[:, first : first + samples]
        # A negative change wraps around in unsigned numbers, and the total wraps back.
        np.cumsum(change.reshape(block.shape), axis=1, dtype=np.uint32, out=block)
    return sums


def _store(path: Path, array: NDArray[Any]) -> None:
    # The file is on the disk before its note says that it is valid: after a power failure, it could contain zeros.
    with replacing(path, owner_only=True, follow_links=False) as stream:
        stream.write(array.data)
    _note(path, zlib.crc32(array.data), path.stat())


def _by_age(folder: Path) -> Iterator[tuple[float, Path]]:
    """Yield the time at which each file of the cache was last used, with the file.

    That time is the modification time of the note about the file.
    """
    for path in folder.iterdir():
        # Another process may be removing files too.
        with suppress(FileNotFoundError):
            if path.suffix == _NOTE_SUFFIX:
                yield path.stat().st_mtime, path.with_suffix("")


def _trim(folder: Path, keep: Collection[Path]) -> None:
    """Remove the least recently used files beyond MAX_CACHED_FILES, and temporary files of killed processes.

    Files in `keep` are never removed.
    """
    sweep(folder)
    cached = sorted(_by_age(folder))
    surplus = max(0, len(cached) - MAX_CACHED_FILES)
    for used, path in [(used, path) for used, path in cached if path not in keep][:surplus]:
        # Another process may have removed the file, or used it, which changes the time of its note.
        with suppress(FileNotFoundError):
            if _note_of(path).stat().st_mtime == used:
                path.unlink(missing_ok=True)
                _note_of(path).unlink()


def _open_data(path: Path, size: int, is_copied: bool) -> memoryview:
    try:
        with open_regular(path) as stream:
            status = os.fstat(stream.fileno())
            if status.st_size != size:
                what = f"has {status.st_size} bytes, not {size}"
                raise BackgroundError(what, "remove it to recreate it", file=str(path))
            noted = _noted(path)
            # If another process has just made the file again, the identity differs, but not the checksum.
            if noted is None or (
                noted[1] != _identity(status) and noted[0] != _checksum(stream.fileno())
            ):
                raise BackgroundError("is damaged", "the next run makes it again", file=str(path))
            if is_copied:
                return memoryview(os.pread(stream.fileno(), size, 0))
            return memoryview(mmap.mmap(stream.fileno(), size, access=mmap.ACCESS_READ))
    except OSError as error:
        message = f"the prepared mat cannot be opened: {error.strerror or error}"
        raise BackgroundError(message, file=str(path)) from error
