"""Edges of a log: what lies between two levels, and is no level itself.

A sensor sees a spot. While its spot crosses an edge, the reading passes from one level to another in one direction. If
the robot is slow, the passage takes many samples, and some in a row may be equal, or nearly so with noise. They are no
level: a level lasts longer than such a step, compared with the whole passage.
"""

from __future__ import annotations

import numpy as np

from tuisim.engine.runs.arrays import IntArray
from tuisim.logs.pieces import (
    NEAR_SAMPLES,
    STRAY_SAMPLES,
    BoolArray,
    Pieces,
    Signal,
    count_samples,
    find_strays,
    group_by_length,
)
from tuisim.logs.stillness import PART_OF_SLOPE, PlateauArray, read_spans

EDGE_SAMPLES = 3
"""A plateau of up to this number of samples may be a step on an edge, however few samples are between the levels on
both sides.
"""

_MAX_STEP = 1 / 3
"""A plateau of more than `EDGE_SAMPLES` may be a step on an edge only if it has at most this fraction of the samples
between the levels on both sides: two equally long plateaus there are levels.
"""

_MIN_LEVELS = 2 / 3
"""A plateau may consist of several levels only if more than this fraction of its samples is in pieces of at least
`NEAR_SAMPLES`: a slope is cut into shorter pieces.
"""


def find_edges(plateaus: PlateauArray) -> BoolArray:
    """Return for each plateau whether it is no level of its own, but only a step on an edge between two others.

    An edge rises or falls all the time, from one plateau to another. A plateau of more than `NEAR_SAMPLES` samples is
    never a step: that many samples show whether it is level.
    """
    level = plateaus["level"]
    lengths = count_samples(read_spans(plateaus))
    is_corner = lengths > NEAR_SAMPLES
    steps = np.diff(level)
    is_corner[1:-1] |= steps[1:] * steps[:-1] <= 0.0
    is_corner[:1] = is_corner[-1:] = True
    corners = np.flatnonzero(is_corner)
    inner = np.flatnonzero(~is_corner)
    place = np.searchsorted(corners, inner)
    before, after = corners[place - 1], corners[place]
    passage = plateaus["start"][after] - plateaus["stop"][before]
    slope = np.abs(level[after] - level[before]) / passage
    is_step = lengths[inner] <= np.maximum(EDGE_SAMPLES, _MAX_STEP * (passage - 1))
    rise = slope * lengths[inner]
    is_step |= plateaus["spread"][inner] > PART_OF_SLOPE * rise / np.sqrt(12.0)
    edges = np.zeros(len(plateaus), bool)
    # The log may have cut off its first and its last level.
    lengths[:1] = lengths[-1:] = lengths.max(initial=0)
    edges[inner] = is_step & (lengths[inner] < np.minimum(lengths[before], lengths[after]))
    return edges


def find_hidden_edges(
    signal: Signal, plateaus: PlateauArray, cut: Pieces, owners: IntArray
) -> BoolArray:
    """Return for each plateau whether it really consists of several levels, with the edges between them.

    This is so if more samples in a row are far from the plateau's level than strays can be: at most `STRAY_SAMPLES`
    wrong samples in a row count as strays.

    Args:
        signal: The log.
        plateaus: Its plateaus, without gaps between them.
        cut: The pieces that were joined to these plateaus.
        owners: For each piece, the index of its plateau.
    """
    lengths = count_samples(cut)
    long = np.bincount(owners, lengths * (lengths >= NEAR_SAMPLES), len(plateaus))
    hidden: BoolArray = plateaus["strays"] > STRAY_SAMPLES
    hidden &= long > _MIN_LEVELS * count_samples(read_spans(plateaus))
    suspects = np.flatnonzero(hidden)
    for some, part in group_by_length(signal.values, read_spans(plateaus[suspects])):
        off = find_strays(part, signal.sigma)
        for _ in range(STRAY_SAMPLES):
            off = off[:, 1:] & off[:, :-1]
        hidden[suspects[some]] = off.any(axis=1)
    return hidden
