"""Lossless compression of recordings, to a few bytes per tick.

Of tick records only what the motion does not predict is stored. Each record is predicted from the previous one by the
steps of `core.motion`, in the same order. Decompression does only sums, products and quotients of IEEE numbers, each
rounded as the standard requires: the result is the same on every machine. That is why sine and cosine are implemented
here; where they miss the bits of the recorded run, the difference is stored.

Output rows are stored column by column, then all their texts.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from tuisim.core.drive import mm_per_degree
from tuisim.core.spec import RunSpec
from tuisim.core.tick_record import TICK_FIELDS
from tuisim.runs.records import OUTPUT_ROW

Column = np.ndarray[Any, Any]
Numbers = np.ndarray[Any, np.dtype[np.float64]]

TICK = np.dtype(list(TICK_FIELDS))
"""Type of a tick record."""

SUMS = ("left_position_deg", "right_position_deg", "heading_deg", "x_mm", "y_mm")
"""Fields that grow by some amount in each tick, in the order of their prediction."""
SPEEDS = ("left_speed_dps", "right_speed_dps")
PLAIN = ("tick", "line", "gyro_zero_deg", "flags", "actions")
"""Fields of which only the changes are stored."""

LEVEL = 6
"""Compression level of zlib; higher ones take twice as long and gain 1 %."""

OFTEN = 3
"""Number of occurrences from which a speed is stored with more than the record's 32 bits."""

_DEG_TO_RAD = 0.017453292519943295
_RAD_TO_DEG = 57.29577951308232
_QUARTERS = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
"""A quarter of a turn in three parts, the first two short enough that their multiples are exact."""

HEAD_FIELDS = (("size", "<u4"), ("tick", "<u4"), ("time_ns", "<u8"), ("line", "<u4"), ("stream", "u1"), ("spare", "V3"))
"""Name and numpy type of each field of `records.OUTPUT_ROW`."""
HEAD_COLUMNS = tuple(name for name, kind in HEAD_FIELDS if not kind.startswith("V"))
ROWS_AT_ONCE = 1 << 16


# Columns


def changes(values: Column) -> Column:
    """Return the difference of the bits of each number and its predecessor, modulo their range; the first is kept."""
    bits = np.ascontiguousarray(values).view(f"<u{values.dtype.itemsize}")
    return np.concatenate((bits[:1], bits[1:] - bits[:-1]))


def summed(differences: Column) -> Column:
    """Undo `changes`, exactly for the bits."""
    return np.add.accumulate(differences, dtype=differences.dtype)


def planes(values: Column) -> bytes:
    """Return the bytes of a column: the lowest byte of every number, then the next byte of every number, and so on."""
    return np.ascontiguousarray(values).view(np.uint8).reshape(len(values), values.dtype.itemsize).T.tobytes()


class Source:
    """A reader for bytes, from the beginning on."""

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
        found = np.dtype(kind)
        return np.frombuffer(self._bytes(count * found.itemsize), found)

    def planes(self, count: int, kind: str) -> Column:
        """Read a column written by the function `planes`, shape (count,)."""
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


# Tick records


@dataclass(frozen=True, slots=True)
class RobotGeometry:
    """The robot's parameters that determine its motion, besides the speeds."""

    tick_s: float
    mm_per_deg: float
    spacing_mm: float
    early: float
    """Fraction of a tick's turn that already applies to the motion of that tick."""

    @classmethod
    def of(cls, spec: RunSpec) -> RobotGeometry:
        """Return that of a run, with the numbers that `core.motion` uses; one reversed wheel alone takes more bytes."""
        return cls(
            1.0 / spec.profile.tick_hz,
            mm_per_degree(spec.robot)[0],
            spec.robot.wheel_spacing_mm,
            0.5 if spec.profile.halfway_heading else 0.0,
        )


def fold_ticks(data: bytes, geometry: RobotGeometry) -> bytes:
    """Compress tick records.

    Args:
        data: Records as in a telemetry file, without its header.
        geometry: Geometry of the run; any other gives more bytes, but the same records.
    """
    # A damaged record may hold any numbers.
    with np.errstate(all="ignore"):
        return zlib.compress(b"".join(_folded(np.frombuffer(data, TICK), geometry)), LEVEL)


def _folded(records: Column, geometry: RobotGeometry) -> list[bytes]:
    parts = [changes(records[name]) for name in PLAIN]
    turned = []
    for speed, position in zip(SPEEDS, SUMS[:2], strict=True):
        bits, codes = np.unique(records[speed].view(np.uint32), return_inverse=True)
        steps = _steps(bits, codes, records[position], geometry)
        more = steps.view(np.int64) - _plain_steps(bits, geometry).view(np.int64)
        parts += [np.array([len(bits)], np.uint32), changes(bits), more, codes.astype(np.uint32)]
        turned.append(steps[codes])
    done: dict[str, Numbers] = {}
    resets: list[bytes] = []
    for name in SUMS:
        growth = _growth(name, turned, done, geometry)
        rest, jumps = _rests(records[name], growth)
        parts.append(rest)
        resets += [_number(len(jumps)), jumps.astype("<u4").tobytes(), records[name][jumps].tobytes()]
        done[name] = records[name]
        if name in SUMS[:2]:
            done[name + "+"] = _true_steps(growth, rest)
    return [*resets, *map(planes, parts)]


def unfold_ticks(data: bytes, count: int, geometry: RobotGeometry) -> bytes:
    """Return the original records, from the result of `fold_ticks` for the same geometry.

    Raises:
        ValueError: the bytes are damaged.
    """
    try:
        source = Source(zlib.decompress(data))
        with np.errstate(all="ignore"):
            return _unfolded(source, count, geometry).tobytes()
    except (zlib.error, IndexError) as error:
        raise ValueError(str(error)) from error


def _unfolded(source: Source, count: int, geometry: RobotGeometry) -> Column:
    jumps = {}
    for name in SUMS:
        number = source.number()
        jumps[name] = source.values(number, "<u4"), source.values(number, "<f8")
    records = np.zeros(count, TICK)
    for name in PLAIN:
        records[name] = summed(source.planes(count, f"<u{TICK[name].itemsize}")).view(TICK[name])
    turned = []
    for name in SPEEDS:
        known = int(source.planes(1, "<u4")[0])
        bits = summed(source.planes(known, "<u4"))
        steps = (_plain_steps(bits, geometry).view(np.int64) + source.planes(known, "<i8")).view(np.float64)
        codes = source.planes(count, "<u4")
        records[name] = bits[codes].view(np.float32)
        turned.append(steps[codes])
    done: dict[str, Numbers] = {}
    for name in SUMS:
        growth, rest = _growth(name, turned, done, geometry), source.planes(count, "<f8")
        records[name] = done[name] = _grown(growth, rest, *jumps[name])
        if name in SUMS[:2]:
            done[name + "+"] = _true_steps(growth, rest)
    return records


def _number(value: int) -> bytes:
    return value.to_bytes(4, "little")


def _plain_steps(bits: Column, geometry: RobotGeometry) -> Numbers:
    """Return the degrees that a wheel turns in a tick at recorded speeds, with the precision of 32 bits."""
    speeds = bits.view(np.float32).astype(np.float64)
    return np.asarray(speeds * geometry.tick_s)


def _steps(bits: Column, codes: Column, positions: Numbers, geometry: RobotGeometry) -> Numbers:
    """Return the degrees per tick at each speed: for frequent speeds those that fit the positions best.

    The positions before and after a tick bound the step between them to a narrow range; many ticks with
    the same speed narrow it further.
    """
    steps = _plain_steps(bits, geometry)
    if len(codes) < OFTEN:
        return steps
    moved = positions[1:] - positions[:-1]
    half = np.spacing(np.abs(positions[1:])) / 2
    at = codes[1:]
    # Ticks with other events, such as the end of a move, provide no information.
    telling = np.abs(moved - steps[at]) <= 2e-7 * np.abs(steps[at]) + half
    at, moved, half = at[telling], moved[telling], half[telling]
    low, high = np.full(len(bits), -np.inf), np.full(len(bits), np.inf)
    np.maximum.at(low, at, moved - half)
    np.minimum.at(high, at, moved + half)
    fits = (np.bincount(at, minlength=len(bits)) >= OFTEN) & ~((low <= steps) & (steps <= high)) & (low <= high)
    steps[fits] = (low[fits] + high[fits]) / 2
    return steps


def _true_steps(growth: Numbers, rest: Numbers) -> Numbers:
    """Return the rotation of the wheel in each tick: the step, corrected by the position."""
    # A jump of the position, or a count without rotation, is not part of the wheel's rotation.
    small = np.abs(rest) <= 1e-6 * np.abs(growth) + 1e-9
    return np.asarray(np.where(small, growth + rest, growth))


def _growth(name: str, turned: list[Numbers], done: dict[str, Numbers], geometry: RobotGeometry) -> Numbers:
    """Return the predicted growth of a field in each tick, from the fields before it in `SUMS`."""
    if name in SUMS[:2]:
        return turned[SUMS.index(name)]
    left_mm, right_mm = done[SUMS[0] + "+"] * geometry.mm_per_deg, done[SUMS[1] + "+"] * geometry.mm_per_deg
    turn_deg = (right_mm - left_mm) / geometry.spacing_mm * _RAD_TO_DEG
    if name == "heading_deg":
        return turn_deg
    key = "across" if name == "x_mm" else "up"
    if key not in done:
        before = np.concatenate((done["heading_deg"][:1], done["heading_deg"][:-1]))
        forward = (left_mm + right_mm) / 2
        cosine, sine = _cosine_and_sine((before + turn_deg * geometry.early) * _DEG_TO_RAD)
        done["across"], done["up"] = forward * cosine, forward * sine
    return done[key]


def _cosine_and_sine(angle: Numbers) -> tuple[Numbers, Numbers]:
    """Return both for angles in radians, accurate to about the last bit."""
    quarter = np.rint(angle * 0.6366197723675814)
    rest = angle
    for part in _QUARTERS:
        rest = rest - quarter * part
    square = rest * rest
    sine, cosine = np.zeros_like(rest), np.zeros_like(rest)
    for factor in range(15, 1, -2):
        sine = (1.0 - sine) * square / (factor * (factor - 1))
        cosine = (1.0 - cosine) * square / ((factor + 1) * factor)
    cosine = 1.0 - (1.0 - cosine) * square / 2
    sine = rest - rest * sine
    which = np.mod(quarter, 4.0)
    swapped = (which == 1.0) | (which == 3.0)
    return (
        np.where(swapped, sine, cosine) * np.where((which == 1.0) | (which == 2.0), -1.0, 1.0),
        np.where(swapped, cosine, sine) * np.where(which >= 2.0, -1.0, 1.0),
    )


def _rests(values: Numbers, growth: Numbers) -> tuple[Numbers, Column]:
    """Return the residuals of a sum of growths, and the records at which it must restart.

    `values[k] == (values[k - 1] + growth[k]) + rest[k]` holds bit by bit.
    """
    rest = np.zeros(len(values))
    near = values[:-1] + growth[1:]
    rest[1:] = values[1:] - near
    exact = (near + rest[1:]).view(np.int64) == np.ascontiguousarray(values[1:]).view(np.int64)
    # The bits of results with NaN depend on the machine.
    exact &= np.isfinite(near) & np.isfinite(rest[1:])
    jumps = np.concatenate((np.zeros(min(1, len(values)), np.int64), np.flatnonzero(~exact) + 1))
    rest[jumps] = 0.0
    return rest, jumps


def _grown(growth: Numbers, rest: Numbers, jumps: Column, starts: Column) -> Numbers:
    """Undo `_rests`: each value is the previous one plus the growth plus the residual, rounded after each sum."""
    values = np.empty(len(growth))
    ends = np.append(jumps, len(growth))[1:]
    for begin, end, start in zip(jumps.tolist(), ends.tolist(), starts, strict=True):
        terms = np.empty(2 * (end - begin) - 1)
        terms[0] = start
        terms[1::2] = growth[begin + 1 : end]
        terms[2::2] = rest[begin + 1 : end]
        values[begin:end] = np.add.accumulate(terms)[::2]
    return values


# Output rows


def fold_rows(data: bytes) -> bytes:
    """Compress complete rows, as in an output file without its header.

    Raises:
        ValueError: the last row is incomplete.
    """
    heads, texts, at = [], [], 0
    while at < len(data):
        text_at = at + OUTPUT_ROW.size
        heads.append(data[at:text_at])
        at = text_at + int.from_bytes(data[at : at + 4], "little")
        texts.append(data[text_at:at])
    if at != len(data):
        raise ValueError("the last row is incomplete")
    table = np.frombuffer(b"".join(heads), np.dtype(list(HEAD_FIELDS)))
    columns = [planes(changes(table[name])) for name in HEAD_COLUMNS]
    return zlib.compress(b"".join([len(heads).to_bytes(4, "little"), *columns, *texts]), LEVEL)


def unfold_rows(data: bytes) -> bytes:
    """Return the original rows.

    Raises:
        ValueError: the bytes are damaged.
    """
    try:
        source = Source(zlib.decompress(data))
    except zlib.error as error:
        raise ValueError(str(error)) from error
    count = source.number()
    table = np.zeros(count, np.dtype(list(HEAD_FIELDS)))
    for name, kind in HEAD_FIELDS[: len(HEAD_COLUMNS)]:
        table[name] = summed(source.planes(count, kind))
    text = source.rest()
    if int(table["size"].sum(dtype=np.int64)) != len(text):
        raise ValueError("its rows have another length than their texts")
    pieces, used = [], 0
    for first in range(0, count, ROWS_AT_ONCE):
        heads = table[first : first + ROWS_AT_ONCE]
        size = int(heads["size"].sum(dtype=np.int64))
        pieces.append(_rows(heads, text[used : used + size]))
        used += size
    return b"".join(pieces)


def _rows(heads: Column, text: bytes) -> bytes:
    """Return rows: each head followed by its part of the text."""
    whole = OUTPUT_ROW.size + heads["size"].astype(np.int64)
    places = (np.cumsum(whole) - whole)[:, None] + np.arange(OUTPUT_ROW.size)
    rows = np.empty(int(whole.sum()), np.uint8)
    of_text = np.ones(len(rows), np.bool_)
    of_text[places] = False
    rows[places] = np.ascontiguousarray(heads).view(np.uint8).reshape(len(heads), OUTPUT_ROW.size)
    rows[of_text] = np.frombuffer(text, np.uint8)
    return rows.tobytes()
