"""Columns of numbers as bytes that pack well: their changes, and all first bytes before all second ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

    Column = np.ndarray[Any, Any]


def changes(values: Column) -> Column:
    """Return the difference of each number's bits from those of the one before, wrapped; the first stays."""
    import numpy as np

    bits = np.ascontiguousarray(values).view(f"<u{values.dtype.itemsize}")
    return np.concatenate((bits[:1], bits[1:] - bits[:-1]))


def summed(differences: Column) -> Column:
    """Undo `changes`, as far as the bits."""
    import numpy as np

    return np.add.accumulate(differences, dtype=differences.dtype)


def planes(values: Column) -> bytes:
    """Return the bytes of a column: the lowest of each number first, then the next of each, and so on."""
    import numpy as np

    return np.ascontiguousarray(values).view(np.uint8).reshape(len(values), values.dtype.itemsize).T.tobytes()


class Source:
    """Bytes that are read from their start on.

    Args:
        data: All of them.
    """

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def number(self) -> int:
        """Return a number of four bytes.

        Raises:
            ValueError: there are no such bytes any more, here as below.
        """
        return int.from_bytes(self._bytes(4), "little")

    def values(self, count: int, kind: str) -> Column:
        """Return numbers that stand one after the other, shape (count,)."""
        import numpy as np

        found = np.dtype(kind)
        return np.frombuffer(self._bytes(count * found.itemsize), found)

    def planes(self, count: int, kind: str) -> Column:
        """Return a column that `planes` has written, shape (count,)."""
        import numpy as np

        found = np.dtype(kind)
        raw = np.frombuffer(self._bytes(count * found.itemsize), np.uint8).reshape(found.itemsize, count)
        return np.ascontiguousarray(raw.T).reshape(-1).view(found)

    def rest(self) -> bytes:
        """Return what is left."""
        return self._bytes(len(self._data) - self._at)

    def _bytes(self, size: int) -> bytes:
        piece = self._data[self._at : self._at + size]
        if len(piece) != size:
            raise ValueError("its end is missing")
        self._at += size
        return piece
