"""The analyser on long logs: opening, each key, and memory."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median

from tests.bench.figures import Figure
from tests.bench.longlogs import KINDS, MILLION, written
from tests.bench.references import paints
from tests.bench.sampling import Effort
from tests.bench.viewer import Viewer

CHART = "[⠁-⣿]"
"""What a drawn curve consists of."""
RIGHT = b"\x1b[C"
DOWN = b"\x1b[B"
KEYS: Mapping[str, Sequence[bytes]] = {
    "zoom": [b"z", b"z", b"Z", b"z", b"z", b"z", b"Z", b"Z", b"z", b"Z"],
    "pan": [b"]", b"]", b"[", b"]", b"]", b"]", b"[", b"[", b"]", b"["],
    "cursor": [RIGHT] * 10,
    "row": [DOWN] * 10,
}
"""What is pressed, in this order; what is panned has been zoomed."""
MOST_OPEN, MOST_KEY, MOST_TIMES = 8.2, 0.25, 3.0
FEW_ROWS = 1000
"""Of the log that tells how much memory the app needs for itself."""


def analyser(path: Path) -> Viewer:
    """Start the analyser with a log."""
    return Viewer([sys.executable, "-m", "tuisim", "analyse", str(path)])


def logs(effort: Effort) -> Iterator[Figure]:
    """Yield what long logs cost, in CPU time of the whole process of the analyser, and in memory."""
    with tempfile.TemporaryDirectory() as folder:
        for kind, make in KINDS.items():
            path = written(make(MILLION), Path(folder) / f"{kind}.csv")
            yield from _opened(f"1 M rows CSV, {kind}", path, MILLION, effort.repeats)
            yield from _keys(f"1 M rows CSV, {kind}", path, MILLION)
        for kind in KINDS:
            yield from _parquet(Path(folder) / f"{kind}.parquet", kind, effort.parquet_rows)


def _whole(rows: int) -> str:
    """What the title says when a log has been read to its end."""
    return rf"row [\d,]+ of {rows:,} · \S+ s {{4,}}(?!reading)"


def _opened(name: str, path: Path, rows: int, repeats: int) -> Iterator[Figure]:
    first = []
    whole = []
    for _ in range(repeats):
        with analyser(path) as viewer:
            first.append(viewer.until(CHART))
            whole.append(viewer.until(_whole(rows)))
    goal = MOST_OPEN if path.suffix == ".csv" else None
    for what, used_s in (("first chart", median(first)), ("chart of all rows", median(whole))):
        yield Figure(
            f"{name}: open to the {what}", used_s, "s CPU", most=goal, ratio=paints(used_s)
        )


def _keys(name: str, path: Path, rows: int) -> Iterator[Figure]:
    with analyser(path) as viewer:
        viewer.until(_whole(rows))
        viewer.until_calm()
        for what, keys in KEYS.items():
            used = [viewer.key_s(key) for key in keys]
            for which, used_s in (("median", median(used)), (f"worst of {len(keys)}", max(used))):
                ratio = paints(used_s)
                yield Figure(
                    f"{name}: {what}, {which}", 1e3 * used_s, "ms CPU", most=MOST_KEY, ratio=ratio
                )


def _parquet(path: Path, kind: str, rows: int) -> Iterator[Figure]:
    """Yield the figures of a Parquet file; its memory is what the app needs beyond what it needs for a short log."""
    name = f"{rows // MILLION} M rows Parquet, {kind}"
    table = KINDS[kind](rows)
    columns_bytes = table.nbytes
    written(table, path)
    del table
    few = written(KINDS[kind](FEW_ROWS), path.with_stem("few"))
    own_bytes = _peak_bytes(few, FEW_ROWS)
    yield from _opened(name, path, rows, 1)
    yield from _keys(name, path, rows)
    growth = _peak_bytes(path, rows) - own_bytes
    yield Figure(f"{name}: columns in memory", columns_bytes / 1e6, "MB")
    yield Figure(f"{name}: peak beyond that of a log of {FEW_ROWS:,} rows", growth / 1e6, "MB")
    yield Figure(
        f"{name}: as a multiple of the columns", growth / columns_bytes, "", most=MOST_TIMES
    )
    path.unlink()


def _peak_bytes(path: Path, rows: int) -> int:
    """Return the most memory that the analyser uses from its start through all the keys."""
    with analyser(path) as viewer:
        viewer.until(_whole(rows))
        viewer.until_calm()
        for keys in KEYS.values():
            for key in keys:
                viewer.key_s(key)
        return viewer.peak_bytes()
