"""Draws small log files as robots, loggers, instruments, spreadsheets and programs write them, with what is in them.

`python -m tests.logs.log_files --count 2000 --seed 1` reads as many and prints by kind how many were read wrongly;
`--show 17` prints one file and what is expected of it.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random, SystemRandom
from tempfile import TemporaryDirectory

import numpy

from tests.logs.drawn_lines import (
    draw_dicts,
    draw_long,
    draw_sequences,
    draw_several,
    draw_single,
)
from tests.logs.drawn_tables import draw_table, draw_words_only
from tests.logs.drawn_values import Draft, Points
from tuisim.base.errors import LogError
from tuisim.logs.reader import open_log

MAX_REFUSED = 0.02
MAX_SEED = 10**9
VALUE_TOLERANCE = 1e-9
TIME_TOLERANCE_S = 1e-6
ENCODINGS = {
    "UTF-8": ("utf-8", b""),
    "UTF-8 with BOM": ("utf-8", b"\xef\xbb\xbf"),
    "UTF-16 LE": ("utf-16-le", b"\xff\xfe"),
    "UTF-16 BE": ("utf-16-be", b"\xfe\xff"),
    "Windows-1252": ("cp1252", b""),
}
LINE_ENDS = {"LF": "\n", "CR LF": "\r\n", "CR": "\r"}
SHAPES = {
    draw_table: 600,
    draw_single: 80,
    draw_several: 120,
    draw_sequences: 50,
    draw_dicts: 80,
    draw_long: 60,
    draw_words_only: 8,
}
"""How often each shape is drawn."""


@dataclass(frozen=True)
class Numbers:
    """What a variable has: times in s, as they are or since the first of the file; None if there is none."""

    count: int
    min: float
    max: float
    mean: float
    first_time_s: float | None
    last_time_s: float | None


@dataclass(frozen=True)
class LogFile:
    """A drawn file. `rows` is None if lines are no rows; `refusable` is why a reader may refuse it, or empty."""

    name: str
    content: bytes
    kinds: tuple[str, ...]
    rows: int | None
    variables: Mapping[str, Numbers]
    refusable: str
    seed: int
    encoding: str

    @property
    def lines(self) -> list[str]:
        """The text, without its line ends."""
        return self.content.decode(self.encoding).lstrip("\ufeff").splitlines()


@dataclass(frozen=True)
class Verdict:
    """How a file was read: an error in words, or the differences."""

    file: LogFile
    refusal: str
    differences: tuple[str, ...]

    @property
    def is_right(self) -> bool:
        """Whether it was read as it was written, or refused where that is allowed."""
        return not self.differences and (not self.refusal or bool(self.file.refusable))


def summarize(points: Points) -> Numbers:
    """Return the numbers of a variable; samples without a value do not count."""
    samples = [(time_s, value) for time_s, value in points if value is not None]
    values = [value for _, value in samples]
    mean = math.fsum(values) / len(values)
    return Numbers(len(values), min(values), max(values), mean, samples[0][0], samples[-1][0])


def draw(seed: int) -> LogFile:
    """Draw a file: the same seed gives the same file."""
    random = Random(seed)
    draw_shape = random.choices(tuple(SHAPES), weights=tuple(SHAPES.values()))[0]
    draft: Draft = draw_shape(random)
    encoding = random.choice(tuple(ENCODINGS))
    line_end = random.choice(tuple(LINE_ENDS))
    codec, mark = ENCODINGS[encoding]
    text = LINE_ENDS[line_end].join(draft.lines)
    if random.random() < 0.85:
        text += LINE_ENDS[line_end]
    return LogFile(
        name=f"drawn_{seed}{random.choice(draft.suffixes)}",
        content=mark + text.encode(codec),
        kinds=(*draft.kinds, f"encoding: {encoding}", f"line ends: {line_end}"),
        rows=draft.rows,
        variables={name: summarize(points) for name, points in draft.points.items()},
        refusable=draft.refusable,
        seed=seed,
        encoding=codec,
    )


def read_file(file: LogFile, folder: Path) -> Verdict:
    """Write a file into a folder, open it as a log and compare."""
    path = folder / file.name
    path.write_bytes(file.content)
    try:
        log = open_log(path)
        names = list(log.names)
        differences = [f"no variable {name!r}" for name in file.variables if name not in names] + [
            f"a variable {name!r}" for name in names if name not in file.variables
        ]
        for name, expected in file.variables.items():
            if name in names:
                series = log.series(name)
                values = numpy.asarray(series.values, dtype=float)
                times_s = numpy.asarray(series.time_s, dtype=float)
                differences += compare(name, expected, file.rows, values, times_s)
    except LogError as error:
        return Verdict(file, str(error), ())
    # A crash is worse than a refusal: it is reported with its file.
    except Exception as error:
        return Verdict(file, "", (f"{type(error).__name__}: {error}",))
    finally:
        path.unlink()
    return Verdict(file, "", tuple(differences))


def compare(
    name: str, expected: Numbers, rows: int | None, values: numpy.ndarray, times_s: numpy.ndarray
) -> list[str]:
    """Return how a variable differs from what was written."""
    is_value = ~numpy.isnan(values)
    count = int(is_value.sum())
    if count != expected.count:
        return [f"{name}: {count} values, not {expected.count}"]
    differences = []
    if rows is not None and len(values) > rows:
        differences.append(f"{name}: {len(values)} rows, not {rows}")
    seen = values[is_value]
    # Large values of both signs may have a mean near 0.
    largest = max(abs(expected.min), abs(expected.max))
    for kind, value, right, scale in (
        ("min", seen.min(), expected.min, abs(expected.min)),
        ("max", seen.max(), expected.max, abs(expected.max)),
        ("mean", seen.mean(), expected.mean, largest),
    ):
        if not abs(value - right) <= VALUE_TOLERANCE * scale:
            differences.append(f"{name}: {kind} {value}, not {right}")
    for kind, time_s, right_s in (
        ("first", times_s[is_value][0], expected.first_time_s),
        ("last", times_s[is_value][-1], expected.last_time_s),
    ):
        if right_s is not None and not abs(time_s - right_s) <= TIME_TOLERANCE_S:
            differences.append(f"{name}: {kind} time {time_s} s, not {right_s} s")
    return differences


def describe(verdict: Verdict) -> str:
    """Return what went wrong with a file, with its first lines."""
    complaints = verdict.differences or (f"refused: {verdict.refusal}",)
    lines = [line[:100] for line in verdict.file.lines[:5]]
    return "\n".join(
        [
            f"seed {verdict.file.seed}: {'; '.join(complaints[:3])}",
            f"    {', '.join(verdict.file.kinds)}",
            *(f"    | {line}" for line in lines),
        ]
    )


def tabulate(verdicts: Sequence[Verdict]) -> Iterable[str]:
    """Yield a table: kind, files, refused, different, and the seed of a file that was read wrongly."""
    files = Counter[str]()
    refused = Counter[str]()
    different = Counter[str]()
    examples: dict[str, int] = {}
    for verdict in verdicts:
        kinds = (*sorted(verdict.file.kinds), "all")
        files.update(kinds)
        refused.update(kinds if verdict.refusal else ())
        different.update(kinds if verdict.differences else ())
        if not verdict.is_right:
            examples = dict.fromkeys(kinds, verdict.file.seed) | examples
    yield f"{'kind':44} {'files':>6} {'refused':>8} {'different':>10}  for example"
    for kind in sorted(files, key=lambda kind: (kind == "all", kind)):
        counts = f"{files[kind]:6} {refused[kind]:8} {different[kind]:10}"
        example = f"--show {examples[kind]}" if kind in examples else ""
        yield f"{kind:44} {counts}  {example}".rstrip()


def show(file: LogFile) -> Iterable[str]:
    """Yield a file's text and what is expected."""
    yield from (repr(line)[1:-1] for line in file.lines)
    yield f"-- {file.name}: {', '.join(file.kinds)}"
    yield f"-- {file.rows} rows" + (f"; may be refused: {file.refusable}" if file.refusable else "")
    for name, numbers in file.variables.items():
        yield f"-- {name!r}: {numbers}"


def main() -> None:
    """Read drawn files and print a table, or print one file."""
    parser = argparse.ArgumentParser(prog="python -m tests.logs.log_files", description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="how many files")
    parser.add_argument("--seed", type=int, default=None, help="the first file's; else a new one")
    parser.add_argument("--show", type=int, metavar="SEED", help="print one file, with its verdict")
    parser.add_argument("--failures", type=int, default=0, help="how many failures to print")
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        if options.show is not None:
            file = draw(options.show)
            verdict = read_file(file, Path(folder))
            result = verdict.refusal or "; ".join(verdict.differences) or "as expected"
            print(*show(file), f"-- read: {result}", sep="\n")
            return
        first = SystemRandom().randrange(MAX_SEED) if options.seed is None else options.seed
        verdicts = [read_file(draw(first + i), Path(folder)) for i in range(options.count)]
    wrong = [verdict for verdict in verdicts if not verdict.is_right]
    print(*map(describe, wrong[: options.failures]), *tabulate(verdicts), f"seed {first}", sep="\n")


if __name__ == "__main__":
    main()
