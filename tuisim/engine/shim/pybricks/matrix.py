"""`Matrix` of `pybricks.tools`, vectors, and the axes and sides of `pybricks.parameters`."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from operator import add
from typing import Any

from tuisim.engine.shim.pybricks.brick import invalid_argument
from tuisim.engine.shim.pybricks.parameters import NamedEnum

Rows = tuple[tuple[float, ...], ...]


def _single(value: float) -> float:
    """Return a number rounded to a float of 32 bits, as the hub stores it."""
    number: float = struct.unpack("f", struct.pack("f", value))[0]
    return number


class Matrix:
    """A matrix of numbers, given row by row."""

    def __init__(self, rows: Sequence[Sequence[float]]) -> None:
        self._rows: Rows = tuple(tuple(map(_single, row)) for row in rows)
        lengths = {len(row) for row in self._rows}
        if len(lengths) != 1 or 0 in lengths:
            raise invalid_argument()

    @property
    def shape(self) -> tuple[int, int]:
        """The number of rows and the number of columns."""
        return len(self._rows), len(self._rows[0])

    @property
    def T(self) -> Matrix:  # noqa: N802 - as the library names it
        """The transposed matrix."""
        return Matrix([*zip(*self._rows, strict=True)])

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, tuple):
            row, column = map(int, index)
            return self._rows[row][column]
        return [*self][int(index)]

    def __iter__(self) -> Iterator[float]:
        return (value for row in self._rows for value in row)

    def __add__(self, other: Matrix) -> Matrix:
        if not isinstance(other, Matrix) or other.shape != self.shape:
            raise invalid_argument()
        pairs = zip(self._rows, other._rows, strict=True)
        return Matrix([[*map(add, *pair)] for pair in pairs])

    def __sub__(self, other: Matrix) -> Any:
        return self + -other

    def __neg__(self) -> Any:
        return self * -1

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, Matrix):
            return Matrix([[value * other for value in row] for row in self._rows])
        if self.shape[1] != other.shape[0]:
            raise invalid_argument()
        columns = other.T._rows
        product = [
            [sum(a * b for a, b in zip(row, column, strict=True)) for column in columns]
            for row in self._rows
        ]
        return product[0][0] if len(product) == len(columns) == 1 else Matrix(product)

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Any:
        return self * (1 / divisor)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Matrix) and self._rows == other._rows

    def __hash__(self) -> int:
        return hash(self._rows)

    def __repr__(self) -> str:
        rows = (", ".join(f"{value:8.3f}" for value in row) for row in self._rows)
        return "Matrix([\n" + "".join(f"    [{row}],\n" for row in rows) + "])"


def vector(x: float, y: float, z: float | None = None) -> Matrix:
    """Return a matrix of one column with two or three numbers."""
    return Matrix([[value] for value in (x, y, z) if value is not None])


def cross(a: Matrix, b: Matrix) -> Matrix:
    """Return the cross product of two vectors of three numbers."""
    (ax, ay, az), (bx, by, bz) = a, b
    return vector(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)


class Axis:
    """The axes of a robot: forward, to the left, and up."""

    X = vector(1, 0, 0)
    Y = vector(0, 1, 0)
    Z = vector(0, 0, 1)


class Side(NamedEnum):
    """The sides of a hub."""

    TOP, BOTTOM, FRONT, BACK, LEFT, RIGHT = range(1, 7)
