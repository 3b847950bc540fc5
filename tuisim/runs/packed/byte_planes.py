"""Number columns as compressible bytes: delta encoding, and all first bytes before all second bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

    Column = np.ndarray[Any, Any]


def changes(values: Column) -> Column:
    """Return the difference of the bits of each number and its predecessor, modulo their range; the first is kept."""
    import numpy as np

    bits = np.ascontiguousarray(values).view(f"<u{values.dtype.itemsize}")
    return np.concatenate((bits[:1], bits[1:] - bits[:-1]))


def summed(differences: Column) -> Column:
    """Undo `changes`, exactly for the bits."""
    import numpy as np

    return np.add.accumulate(differences, dtype=differences.dtype)


def planes(values: Column) -> bytes:
    """Return the bytes of a column: the lowest byte of every number, then the next byte of every number, and so on."""
    import numpy as np

    return np.ascontiguousarray(values).view(np.uint8).reshape(len(values), values.dtype.itemsize).T.tobytes()


class Source:
    """A reader for bytes, from the beginning on.

    Args:
        data: The bytes.
    """

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def number(self) -> int:
        """Read an integer of four bytes.

        Raises:
            ValueError: too few bytes are left; also raised by the other methods.
        """
        return int.from_bytes(self._bytes(4), "little")

    def values(self, count: int, kind: str) -> Column:
        """Read consecutive numbers, shape (count,)."""
        import numpy as np

        found = np.dtype(kind)
        return np.frombuffer(self._bytes(count * found.itemsize), found)

    def planes(self, count: int, kind: str) -> Column:
        """Read a column written by the function `planes`, shape (count,)."""
        import numpy as np

        found = np.dtype(kind)
        raw = np.frombuffer(self._bytes(count * found.itemsize), np.uint8).reshape(found.itemsize, count)
        return np.ascontiguousarray(raw.T).reshape(-1).view(found)

    def rest(self) -> bytes:
        """Read the remaining bytes."""
        return self._bytes(len(self._data) - self._at)

    def _bytes(self, size: int) -> bytes:
        piece = self._data[self._at : self._at + size]
        if len(piece) != size:
            raise ValueError("its end is missing")
        self._at += size
        return piece
