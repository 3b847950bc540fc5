"""Programs that print numbers as no sensor gives them: whatever reads them tells of them, and goes on."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

from tests.hosts import MAGIC
from tests.proof.commands import check_said
from tests.proof.kind import FaultError, Kind, in_time
from tests.proof.security_app import check_shown
from tuisim.base.faults import report_file

ODD = (
    *("0", "-0.0", "1", "1e155", "-1e155", "1e308", "-1e308", "1.7976931348623157e308", "1e300"),
    *("5e-324", "2.2e-308", "1e-200", "nan", "inf", "-inf", "1e400", "9" * 400, "0.1", "86.3"),
)
_READ = (
    "run p.py",
    *("log summary last", "log bands last", "log plot last", "log plot last --out plot.svg"),
    *("log report last", "log export last --out log.csv", "log summary log.csv", "runs show last"),
    *("log calc last --expression A*A+B", "log events last --at 5", "goals check goals.toml last"),
)
_GOALS = """\
title = "Numbers"
background = "Empty_Map"
[[goal]]
name = "a"
log = { name = "A", levels = [1, 1e15, -1e15, 5e-324], within = 1 }
"""


def odd_program(random: Random) -> str:
    """Return a program that prints odd numbers."""
    lines = ["print('A: 0')", "print('B: 1')"]
    lines += [
        f"print('{random.choice('AB')}: {random.choice(ODD)}')"
        for _ in range(random.choice((2, 2, 3, 9)))
    ]
    if random.random() < 0.3:
        lines += ["x = 1.0", "for _ in range(1100):", "    print('A:', x)", "    x = x * -2"]
    return "\n".join(lines)


def _read_log(text: str, random: Random) -> None:
    for words in _READ:
        check_said(words.split(), codes=(0, 1))


def _run_batch(text: str, random: Random) -> None:
    for suffix in ("csv", "parquet"):
        words = f"batch p.py --seeds 0..2 --jobs 1 --out rows.{suffix}"
        check_said(words.split(), codes=(0, 1))
        if not Path(f"rows.{suffix}").is_file():
            raise FaultError(f"rows.{suffix} is not written\n{text}")


def _open_app(text: str, random: Random) -> None:
    check_shown("p.py", text, random)


WAYS = {"log": _read_log, "batch": _run_batch, "app": _open_app}


def _names(random: Random) -> Iterator[str]:
    while True:
        yield from (f"{way}:{random.getrandbits(32)}" for way in WAYS)


def _check(case: str, folder: Path) -> None:
    way, seed = case.split(":")
    random = Random(seed)
    text = f"# {MAGIC}\n{odd_program(random)}\n"
    Path("p.py").write_text(text)
    Path("goals.toml").write_text(_GOALS)
    with in_time():
        WAYS[way](text, random)
    if report_file().exists():
        raise FaultError(f"a mistake of ours: {report_file().read_text()[-2000:]}\n{text}")


NUMBERS = Kind("odd numbers in logs, batches and charts", _names, _check)
