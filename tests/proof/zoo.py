"""Hostile and odd programs, headless and live: how they end, that they can be stopped, and that nothing is left."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from random import Random

from tests.proof import zoo_oddities as odd
from tests.proof import zoo_programs as plain
from tests.proof.kind import FaultError, Kind
from tests.proof.zoo_programs import ENDINGS, Ending, Piece
from tests.running import PATIENCE_S, as_python
from tuisim.base.source import Program
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

FAMILIES: Mapping[str, Mapping[str, Piece]] = {
    "threads": plain.THREADS,
    "processes": plain.PROCESSES,
    "signals": plain.SIGNALS,
    "at-exit": plain.AT_EXIT,
    "descriptors": plain.DESCRIPTORS,
    "outputs": plain.OUTPUTS,
    "memory": plain.MEMORY,
    "recursion": plain.RECURSION,
    "stuck": plain.STUCK,
    "time": odd.TIME,
    "imports": odd.IMPORTS,
    "traces": odd.TRACES,
    "places": odd.PLACES,
    "encodings": odd.ENCODINGS,
    "library": odd.LIBRARY,
}
WAYS = ("headless", "twice", "stopped", "stopped-soon", "stopped-paused", "killed")
LIKE_PYTHON = ("threads", "at-exit", "outputs", "recursion", "encodings")
"""Families that do no harm without the simulation, where Python itself shows what must come of them."""
STOP_WITHIN_S = 0.5
TRIES = 3
"""A stop is late if it is so each time: what the machine does meanwhile is not the program's."""
LIMIT_S, STALL_S = 5.0, 0.4
_SUBREAPER = 36


def _names(random: Random) -> Iterator[str]:
    own = [
        (f"{family}.{name}", way)
        for family, pieces in FAMILIES.items()
        for name in pieces
        for way in WAYS
    ]
    drawn = [f"{name}+{random.choice(list(ENDINGS))}+{way}" for name, way in own]
    drawn += [
        f"{family}.{name}+{ending}+like-python"
        for family in LIKE_PYTHON
        for name, piece in FAMILIES[family].items()
        for ending, how in ENDINGS.items()
        if piece.end is None and piece.alike and how.end is not End.TIME_LIMIT
    ]
    yield from random.sample(drawn, len(drawn))
    while True:
        name, way = random.choice(own)
        yield f"{name}+{random.choice(list(ENDINGS))}+{way}"


def _parts(case: str) -> tuple[Piece, Ending, str]:
    name, ending, way = case.split("+")
    family, _, variant = name.partition(".")
    return FAMILIES[family][variant], ENDINGS[ending], way


def _text(piece: Piece, ending: Ending) -> str:
    return f"print('A: 1')\n{piece.text}\nprint('B: 2')\n{ending.text}\n"


def _start(piece: Piece, ending: Ending, folder: Path, options: RunOptions) -> RunHandle:
    program = Program("program.py", _text(piece, ending), working_directory=str(folder))
    return start_run(program, build_run_spec(Settings({"background": "Empty_Map"})), options)


def _options(piece: Piece, live: bool = False, paused: bool = False) -> RunOptions:
    stall_s = STALL_S if piece.end is End.STALLED and not live else 60.0
    return RunOptions(
        live=live,
        speed=0.0,
        hold_at=(0, 1) if paused else None,
        time_limit_s=LIMIT_S if not live else 0.0,
        stall_limit_s=stall_s,
    )


def _over(run: RunHandle) -> Ended:
    ended = run.wait(PATIENCE_S)
    if ended is None:
        raise FaultError("it does not end")
    return ended


def _is_not_python(ended: Ended) -> bool:
    """Whether no line of the program was run, because it cannot be compiled."""
    return ended.summary.startswith("SyntaxError")


def _check_end(piece: Piece, ending: Ending, run: RunHandle, ended: Ended) -> None:
    lines = [row.text for row in run.output.read_all_rows() if row.stream == Stream.STDOUT]
    if (not lines or lines[0] != "A: 1") and not _is_not_python(ended):
        raise FaultError(f"what was printed first is lost: {lines[:3]}; {ended}")
    if piece.breaks:
        return
    wanted = (piece.end, None) if piece.end else (ending.end, ending.code)
    if ended.end != wanted[0] or (ended.end == End.FINISHED and ended.exit_code != wanted[1]):
        raise FaultError(f"it ends with {ended}, not {wanted}; {lines[-3:]}")
    if piece.end is None and not piece.loses and "B: 2" not in lines:
        raise FaultError(f"what was printed last is lost: {lines[-3:]}; {ended}")
    if "tuisim" in ended.summary + ended.error:
        raise FaultError(f"it tells of tuisim: {ended}")


def _check_store(run: RunHandle, ended: Ended) -> None:
    """Check that what is stored can be read, and says how it ended."""
    listed = {one.id: one.end for one in RunStore().runs()}
    stored = run.stored()
    if (listed.get(run.run_id), stored.state) != (ended.end, ended.end):
        raise FaultError(f"stored as {stored.state}, listed as {listed}, not {ended.end}")
    if stored.telemetry.last() is None and ended.tick > 0:
        raise FaultError("no telemetry is stored")
    sum(len(row.text) for row in stored.output.rows())


def _bits(run: RunHandle) -> tuple[bytes, ...]:
    """Return what is recorded."""
    return tuple((run.folder / name).read_bytes() for name in ("telemetry.bin", "output.bin"))


def _waited_ns(pid: int) -> int:
    """Return how long the threads of a process were ready to run while others ran: that of the one it was longest."""
    found = [0]
    # It may be over at any moment.
    with suppress(OSError):
        for file in Path(f"/proc/{pid}/task").glob("*/schedstat"):
            with suppress(OSError, IndexError):
                found.append(int(file.read_text().split()[1]))
    return max(found)


def _stopped(run: RunHandle) -> tuple[Ended, float]:
    """Stop a run; return how it ended, and how long that took on a machine of its own."""
    pids = (os.getpid(), run._process.pid)
    before = [_waited_ns(pid) for pid in pids]
    latest = list(before)
    start_s = time.monotonic()
    run.stop()
    while run.ended is None:
        latest = [max(last, _waited_ns(pid)) for last, pid in zip(latest, pids, strict=True)]
        run.wait(0.02)
        if time.monotonic() - start_s > PATIENCE_S:
            raise FaultError("it does not stop")
    others_s = sum(now - then for now, then in zip(latest, before, strict=True)) / 1e9
    return run.ended, time.monotonic() - start_s - others_s


def _until_it_prints(run: RunHandle) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while run.ended is None and not run.output.read_new_rows():
        if time.monotonic() > give_up:
            raise FaultError("it prints nothing")
        run.wait_for_event(0.01)
        run.pump()


def _check_stopped(piece: Piece, ending: Ending, folder: Path, way: str) -> None:
    for _ in range(TRIES):
        run = _start(
            piece, ending, folder, _options(piece, live=True, paused=way == "stopped-paused")
        )
        try:
            if way == "stopped":
                _until_it_prints(run)
            elif way == "stopped-paused":
                _until_paused(run)
            ended, took_s = _stopped(run)
        finally:
            run.close()
        _check_store(run, ended)
        if ended.end != End.STOPPED and way == "stopped-paused" and not _is_not_python(ended):
            raise FaultError(f"a stop ends it with {ended}")
        if ended.end not in (End.STOPPED, piece.end, ending.end) and not piece.breaks:
            raise FaultError(f"a stop ends it with {ended}")
        if took_s <= STOP_WITHIN_S:
            return
    raise FaultError(f"the stop takes {took_s:.2f} s: {ended}")


def _until_paused(run: RunHandle) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while not run.paused:
        if run.ended is not None and _is_not_python(run.ended):
            return
        if run.ended is not None or time.monotonic() > give_up:
            raise FaultError(f"it does not pause: {run.ended}")
        run.wait_for_event(0.01)
        run.pump()


def _check_run(piece: Piece, ending: Ending, folder: Path, way: str) -> None:
    options = _options(piece)
    run = _start(piece, ending, folder, options)
    try:
        if way == "killed":
            _until_it_prints(run)
            run.kill()
            ended = _over(run)
            if ended.end not in (End.STOPPED, piece.end, ending.end) and not piece.breaks:
                raise FaultError(f"a kill ends it with {ended}")
        else:
            ended = _over(run)
            _check_end(piece, ending, run, ended)
    finally:
        run.close()
    _check_store(run, ended)
    if way == "twice" and piece.exact and not piece.breaks:
        _check_again(piece, ending, folder, run)


def _check_again(piece: Piece, ending: Ending, folder: Path, first: RunHandle) -> None:
    shutil.rmtree(folder)
    folder.mkdir()
    second = _start(piece, ending, folder, _options(piece))
    try:
        _over(second)
    finally:
        second.close()
    if _bits(first) != _bits(second):
        raise FaultError("the second run records other bits")


_ERROR = re.compile(r"(?:\w+\.)*\w+(?:Error|Exception)\b.*")


def _errors(text: str) -> list[str]:
    """Return the lines that name an error: what else a traceback shows is not the same."""
    return [line for line in text.split("\n") if _ERROR.fullmatch(line)]


def _check_like_python(piece: Piece, ending: Ending, folder: Path) -> None:
    """Check that output, errors and exit code are those of Python itself."""
    run = _start(piece, ending, folder, _options(piece))
    try:
        ended = _over(run)
    finally:
        run.close()
    rows = {
        stream: [row.text for row in run.output.read_all_rows() if row.stream == stream]
        for stream in Stream
    }
    shutil.rmtree(folder)
    folder.mkdir()
    python = as_python(_text(piece, ending), folder)
    wanted = python.stdout.split("\n"), sorted(_errors(python.stderr)), python.exit_code
    found = (
        rows[Stream.STDOUT],
        sorted(_errors("\n".join(rows[Stream.STDERR]))),
        ended.exit_code & 0xFF,
    )
    for what, one, other in zip(("stdout", "errors", "exit code"), found, wanted, strict=True):
        if one != other:
            raise FaultError(
                f"{what}: {str(one)[-300:]}, of Python itself: {str(other)[-300:]}; {ended}"
            )


def _descendants() -> dict[int, int]:
    """Return all processes below this one that are not over, with the session of each."""
    parents: dict[int, tuple[int, int]] = {}
    for name in os.listdir("/proc"):
        try:
            words = (
                Path("/proc", name, "stat").read_text().rpartition(")")[2].split()
                if name.isdigit()
                else []
            )
        except OSError:
            continue
        if words and words[0] not in "ZX":
            parents[int(name)] = int(words[1]), int(words[3])
    found = {os.getpid()}
    while more := {pid for pid, (parent, _) in parents.items() if parent in found} - found:
        found |= more
    return {pid: parents[pid][1] for pid in found - {os.getpid()}}


def _check_left(before: dict[int, int]) -> None:
    """Check that a case has left no process."""
    give_up = time.monotonic() + PATIENCE_S
    while left := _descendants().keys() - before.keys():
        if time.monotonic() > give_up:
            raise FaultError(f"processes are left: {[_command(pid) for pid in left]}")
        time.sleep(0.01)


def _command(pid: int) -> str:
    try:
        return (
            Path(f"/proc/{pid}/cmdline")
            .read_bytes()
            .replace(b"\0", b" ")
            .decode("utf-8", "replace")[:200]
        )
    except OSError:
        return "over"


def _check(case: str, folder: Path) -> None:
    piece, ending, way = _parts(case)
    # What a program leaves becomes a child of this process, and is found.
    ctypes.CDLL(None).prctl(_SUBREAPER, 1)
    process.start_warm_process()
    before = _descendants()
    place = folder / "place"
    place.mkdir()
    if way == "like-python":
        _check_like_python(piece, ending, place)
    elif way.startswith("stopped"):
        _check_stopped(piece, ending, place, way)
    else:
        _check_run(piece, ending, place, way)
    _check_left(before)


ZOO = Kind("hostile and odd programs, headless, live, stopped and killed", _names, _check)
