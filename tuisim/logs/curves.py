"""Which plateaus are only parts of a curve, such as the steepest part of a sine or the steps of its readings.

A level has an edge on either side, which a curve has not. So the samples beside a plateau tell: if one smooth line
explains them and the plateau better than a level between two edges does, the plateau is a part of a curve. The same is
so if each sample follows from the one before it, as in a random walk.
"""

from __future__ import annotations

import numpy as np

from tuisim.engine.runs.arrays import FloatArray, IntArray, find_spans
from tuisim.logs.pieces import BoolArray, Signal, count_samples
from tuisim.logs.stillness import PlateauArray, read_spans

_BLOCKS = 16
"""A plateau of many samples is reduced to the means of about this many blocks: edges are then as steep for a slow robot
as for a fast one.
"""

_MIN_BESIDE = 3
"""Fewest samples of a plateau that can be part of a curve, and of those before and after it together."""

_BETTER = 0.8
"""A plateau is part of a curve if the curve leaves less than this fraction of the variance of the plateau's samples
about their level.
"""

_REACH = 3.0
"""Samples of a plateau that are farther from its level than this multiple of its spread are moved to that distance."""

_MAX_TREAD = 0.02
"""Largest step of the scale of readings, as a fraction of the log's range, that short plateaus of a slow curve can have
between them.
"""

_MIN_TREADS = 3
"""Fewest short plateaus in a row, all rising or all falling, that count as a slow curve."""

_TREAD_RISE = 2.5
"""In a slow curve, the readings change by fewer steps of the scale than this, from a plateau to as many samples before
or after it as it has.
"""


def find_curves(signal: Signal, plateaus: PlateauArray) -> BoolArray:
    """Return for each plateau whether it is no level, but only a part of a curve."""
    curves = _find_treads(signal, plateaus)
    spans = read_spans(plateaus)
    lengths = count_samples(spans)
    judged = np.flatnonzero((lengths >= _MIN_BESIDE) & (plateaus["spread"] > 0.0))
    beside = np.maximum(lengths, _MIN_BESIDE)
    count = len(signal.values)
    left = np.minimum(beside, spans[:, 0])
    right = np.minimum(beside, count - spans[:, 1])
    shapes = np.stack((left, lengths, right), axis=1)[judged]
    kinds, members = np.unique(shapes, axis=0, return_inverse=True)
    for kind, shape in enumerate(kinds):
        some = judged[members.ravel() == kind]
        starts = spans[some, 0] - shape[0]
        windows = signal.values[starts[:, None] + np.arange(shape.sum())]
        # Strays are no part of a level.
        inside = windows[:, shape[0] : shape[0] + shape[1]]
        level = plateaus["level"][some, None]
        reach = _REACH * plateaus["spread"][some, None]
        np.clip(inside, level - reach, level + reach, out=inside)
        curves[some] |= _go_on(windows, shape)
    return curves


def _go_on(windows: FloatArray, shape: IntArray) -> BoolArray:
    """Return for each plateau whether it belongs to a curve that goes on before and after it, shape (m,).

    A curve must explain the samples better than a level between two edges does.

    Args:
        windows: The samples before, of and after m plateaus of one length, shape (m, n).
        shape: The number of samples before, of and after each plateau, shape (3,).
    """
    before, inside, after = (
        _compute_block_means(part, max(1, int(shape[1]) // _BLOCKS))
        for part in np.split(windows, np.cumsum(shape)[:-1], axis=1)
    )
    blocks = np.concatenate((before, inside, after), axis=1)
    count = blocks.shape[1]
    if before.shape[1] + after.shape[1] < _MIN_BESIDE or count < 2 * _MIN_BESIDE:
        return np.zeros(len(windows), bool)
    level = inside.var(axis=1, ddof=1)
    _, misfits, *_ = np.polyfit(np.linspace(-1.0, 1.0, count), blocks.T, 2, full=True)
    smooth = misfits / (count - 3)
    walk = (np.diff(blocks, axis=1) ** 2).mean(axis=1)
    goes_on: BoolArray = np.minimum(smooth, walk) < _BETTER * level
    return goes_on


def _compute_block_means(part: FloatArray, size: int) -> FloatArray:
    """Return the means of blocks of `size` samples of each row; samples that fill no block are left out."""
    count = part.shape[1] // size
    means: FloatArray = part[:, : count * size].reshape(len(part), count, size).mean(axis=2)
    return means


def _find_treads(signal: Signal, plateaus: PlateauArray) -> BoolArray:
    """Return for each plateau whether it is only a step in a slow curve, shape (n,).

    Values are read in steps of their scale, such as whole percents. A curve that changes slowly thus has several short
    plateaus in a row, which are no levels.
    """
    steps = np.abs(np.diff(signal.values))
    tread = steps[steps > 1e-9 * np.abs(signal.values).max()].min(initial=np.inf)
    treads = np.zeros(len(plateaus), bool)
    if tread > _MAX_TREAD * signal.range:
        return treads
    spans = read_spans(plateaus)
    lengths = count_samples(spans)
    last = len(signal.values) - 1
    before = signal.values[np.maximum(spans[:, 0] - lengths, 0)] - plateaus["level"]
    after = signal.values[np.minimum(spans[:, 1] + lengths - 1, last)] - plateaus["level"]
    is_flat = plateaus["spread"] < tread / 2.0
    gentle = is_flat & (np.maximum(np.abs(before), np.abs(after)) < _TREAD_RISE * tread)
    inner = gentle & (before * after < 0.0)
    for start, stop in find_spans(inner).tolist():
        if stop - start >= _MIN_TREADS:
            treads[max(start - 1, 0) : stop + 1] = gentle[max(start - 1, 0) : stop + 1]
    return treads
