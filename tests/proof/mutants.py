"""`python -m tests.proof mutants [PLACE…]`: flip a comparison or an operator, and see whether the quick tests find it.

Each mutant is one flip in a copy of this checkout. The tests of its module run first, then those of its room, then the
programs; the first that fails, or a limit of CPU time, ends it. A mutant that survives says that no test stands there.
"""

from __future__ import annotations

import argparse
import ast
import os
import shutil
import signal
import subprocess
import sys
import venv
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from math import ceil
from pathlib import Path
from queue import SimpleQueue
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from tests.conftest import ROOT
from tests.test_rules import TESTED_BESIDE

ROOMS = (
    *("engine/core", "engine/shim", "engine/runs", "logs", "tasks/goals"),
    *("batch", "settings", "programs", "analysis", "pictures/charts", "pictures/scene"),
)
"""What is drawn from otherwise."""

FLIPS: Mapping[type[ast.AST], tuple[type[Any], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Mult,),
    ast.Mod: (ast.FloorDiv,),
    ast.LShift: (ast.RShift,),
    ast.RShift: (ast.LShift,),
    ast.USub: (ast.UAdd,),
}
"""What becomes of an operator: the bound moved by one, or the opposite."""

TESTS: Mapping[str, Sequence[str]] = {
    **{room: (f"tests/{room}",) for room in ROOMS},
    "programs": (
        "tests/test_examples.py",
        "tests/test_brick_programs.py",
        "tests/test_pybricks_programs.py",
        "tests/test_real_programs.py",
    ),
}
"""The quick tests of each room, and those of the programs."""

_SKIPPED = (".git", ".venv", "*_cache", "__pycache__", ".hypothesis")
_PYTEST = ("-q", "-x", "-n0", "-p", "no:randomly", "-p", "no:cacheprovider", "--hypothesis-seed=0")
_MIN_LIMIT_S = 60
_LIMIT_FACTOR = 5
_MAX_IDLE_FACTOR = 20
"""Tests that wait for what never comes need no CPU; even on a busy machine none needs so much more time than CPU."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A flip."""

    file: str
    """Relative to the folder of the package."""
    line: int
    operator: tuple[int, int]
    """Which one of the file: where its expression begins, and its number in it."""
    old: str
    new: str
    text: str
    """The whole file with the flip."""

    def __str__(self) -> str:
        return f"tuisim/{self.file}:{self.line}: {self.old} → {self.new}"

    @property
    def room(self) -> str:
        """The room that it is in."""
        return next(room for room in ROOMS if self.file.startswith(f"{room}/"))


def find_mutants(file: str, text: str) -> Iterator[Mutant]:
    """Yield each flip of a file, in an order that depends on its text only."""
    tree = ast.parse(text)
    starts = [0]
    for row in text.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(row))
    # The places of what is in an f-string are not those in the file.
    texts = (node for node in ast.walk(tree) if isinstance(node, ast.JoinedStr))
    inside = {id(part) for node in texts for part in ast.walk(node)}
    for node in ast.walk(tree):
        if not isinstance(node, ast.expr) or id(node) in inside:
            continue
        old = ast.unparse(node)
        begin = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
        for number in _flip_operators(node):
            new = ast.unparse(node)
            # The lines after it keep their numbers.
            rows = "\n" * ((node.end_lineno or 0) - node.lineno)
            source = text.encode()
            whole = source[:begin] + f"({new}{rows})".encode() + source[end:]
            yield Mutant(file, node.lineno, (begin, number), old, new, whole.decode())


def _flip_operators(node: ast.expr) -> Iterator[int]:
    """Flip each operator of an expression in each way, yield its number, and put it back afterwards."""
    if isinstance(node, ast.Compare):
        for index, comparison in enumerate(node.ops):
            for flipped in FLIPS[type(comparison)]:
                node.ops[index] = flipped()
                yield index
            node.ops[index] = comparison
    elif isinstance(node, ast.BinOp | ast.BoolOp | ast.UnaryOp):
        operator = node.op
        for flipped in FLIPS.get(type(operator), ()):
            node.op = flipped()
            yield 0
        node.op = operator


def draw_mutants(places: Sequence[str], seed: int, count: int) -> list[Mutant]:
    """Draw operators in files and folders of the package, and a flip of each; a place may end with `:LINE`."""
    operators: list[list[Mutant]] = []
    for place in places:
        name, _, line = place.removeprefix("tuisim/").partition(":")
        path = ROOT / "tuisim" / name
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            found = find_mutants(file.relative_to(ROOT / "tuisim").as_posix(), file.read_text())
            here = [mutant for mutant in found if line in ("", str(mutant.line))]
            operators += [list(flips) for _, flips in groupby(here, lambda one: one.operator)]
    random = Random(seed)
    drawn = random.sample(operators, min(count, len(operators)))
    return [random.choice(flips) for flips in drawn]


def find_tests(file: str, root: Path = ROOT) -> list[str]:
    """Return the files of tests that a module has by its path, and the one that tests it with its caller."""
    path = Path(file)
    folder = root / "tests" / path.parent
    names = [f"test_{path.stem}.py", f"test_{path.stem}_*.py"]
    tests = [str(test.relative_to(root)) for name in names for test in sorted(folder.glob(name))]
    return [*tests, *(f"tests/{test}" for test in [TESTED_BESIDE.get(file)] if test)]


def find_failure(tests: Sequence[str], root: Path, limit_cpu_s: int | None) -> str:
    """Run tests in a copy; return the first that fails, or that the time was over; otherwise nothing."""
    # Of CPU: others on the machine make no test fail.
    limit = (
        [] if limit_cpu_s is None else ["sh", "-c", f'ulimit -S -t {limit_cpu_s}; exec "$@"', ""]
    )
    child = subprocess.Popen(
        [*limit, root / ".venv/bin/python", "-m", "pytest", *_PYTEST, *tests],
        cwd=root,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    try:
        output, _ = child.communicate(timeout=limit_cpu_s and limit_cpu_s * _MAX_IDLE_FACTOR)
    except subprocess.TimeoutExpired:
        return "waits for ever"
    finally:
        # Also what it has started.
        with suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGKILL)
        child.wait()
    if child.returncode == -signal.SIGXCPU:
        return "CPU limit"
    # 5: it has no quick test.
    if child.returncode in (0, 5):
        return ""
    failed = [row for row in output.splitlines() if row.startswith(("FAILED", "ERROR"))]
    return (failed or output.splitlines() or ["no output"])[-1]


def copy_checkout(folder: Path) -> None:
    """Copy this checkout, with an environment of its own that imports the copy, also in the children of runs."""
    shutil.copytree(ROOT, folder, symlinks=True, ignore=shutil.ignore_patterns(*_SKIPPED))
    venv.create(folder / ".venv", symlinks=True)
    packages = [path for path in sys.path if path.endswith("-packages")]
    (site,) = (folder / ".venv/lib").glob("python*/site-packages")
    (site / "copy.pth").write_text("\n".join([str(folder), *packages]))


class Copies:
    """Copies of this checkout, each for one mutant at a time."""

    def __init__(self, folder: Path, count: int) -> None:
        self._free: SimpleQueue[Path] = SimpleQueue()
        self._limits_cpu_s: dict[str, int] = {}
        for number in range(count):
            copy = folder / str(number)
            copy_checkout(copy)
            self._free.put(copy)

    def measure(self, tests: str) -> None:
        """Run tests without a flip, which sets their limit; nothing else may run in this process.

        Args:
            tests: A room, or the programs.

        Raises:
            RuntimeError: one fails.
        """
        copy = self._free.get()
        before = os.times()
        failure = find_failure(TESTS[tests], copy, None)
        after = os.times()
        self._free.put(copy)
        if failure:
            raise RuntimeError(f"tests of {tests} fail without a flip: {failure}")
        cpu_s = (after.children_user + after.children_system) - (
            before.children_user + before.children_system
        )
        self._limits_cpu_s[tests] = max(_MIN_LIMIT_S, ceil(_LIMIT_FACTOR * cpu_s))
        print(f"tests of {tests}: {cpu_s:.0f} s of CPU", flush=True)

    def try_mutant(self, mutant: Mutant) -> str:
        """Return what finds a mutant, or nothing if it survives."""
        copy = self._free.get()
        path = copy / "tuisim" / mutant.file
        original = path.read_text()
        path.write_text(mutant.text)
        own = find_tests(mutant.file, copy)
        room = mutant.room
        others = [*TESTS[room], *(f"--ignore={test}" for test in own)]
        try:
            return (
                (own and find_failure(own, copy, self._limits_cpu_s[room]))
                or find_failure(others, copy, self._limits_cpu_s[room])
                or find_failure(TESTS["programs"], copy, self._limits_cpu_s["programs"])
            )
        finally:
            path.write_text(original)
            self._free.put(copy)


def main(words: Sequence[str]) -> int:
    """Try mutants; print each one, and a table; return 1 if one survives."""
    parser = argparse.ArgumentParser(prog="python -m tests.proof mutants", description=__doc__)
    parser.add_argument(
        "places",
        nargs="*",
        metavar="PLACE",
        default=ROOMS,
        help="a folder, file or FILE:LINE of tuisim (default: ten rooms)",
    )
    parser.add_argument("--count", type=int, default=60, metavar="N", help="at most (default: 60)")
    parser.add_argument("--seed", type=int, metavar="N", help="of the draw (default: a fresh one)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="mutants at a time")
    arguments = parser.parse_args(words)
    seed = arguments.seed if arguments.seed is not None else int.from_bytes(os.urandom(4))
    mutants = draw_mutants(arguments.places, seed, arguments.count)
    print(f"seed {seed}: {len(mutants)} mutants", flush=True)
    drawn = Counter(mutant.room for mutant in mutants)
    survivors = []
    with (
        TemporaryDirectory(prefix="tuisim-mutants-") as folder,
        ThreadPoolExecutor(arguments.jobs) as pool,
    ):
        copies = Copies(Path(folder), arguments.jobs)
        for tests in ["programs", *drawn]:
            copies.measure(tests)
        for mutant, failure in zip(mutants, pool.map(copies.try_mutant, mutants), strict=True):
            print(f"{mutant}\n  {failure or 'SURVIVES'}", flush=True)
            if not failure:
                survivors.append(mutant)
    left = Counter(mutant.room for mutant in survivors)
    print(f"{'room':<12} {'mutants':>8} {'found':>8}")
    for room in drawn:
        print(f"{room:<12} {drawn[room]:>8} {drawn[room] - left[room]:>8}")
    for mutant in survivors:
        print(mutant)
    print(f"{len(mutants) - len(survivors)} of {len(mutants)} found (seed {seed})")
    return int(bool(survivors))
