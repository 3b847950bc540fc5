"""An enemy between two honest programs, in each of the five hosts: it harms its own run only."""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from tests.hosts import HOSTS, Hosted, Stored, hosted, isolated
from tests.proof.commands import check_said
from tests.proof.kind import FaultError, Kind, home, in_time
from tests.tasks.marks.attackers import DISK, FILES, MEMORY, OWN_RUN, PROC, PROCESSES, SECRET
from tuisim.base.faults import report_file
from tuisim.base.folders import remove_tree
from tuisim.cli import EXIT_OUR_MISTAKE
from tuisim.engine.protocol import EVENTS, End
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import ACTIONS_FILE, SIDE_FILES, STOP_FILE
from tuisim.engine.runs.store import RunStore

HONEST = """\
tank_drive.on_for_rotations(50, 50, 1)
print('A:', colorLeft.reflected_light_intensity_pc)
"""
"""Both print another line at their ends."""
_BEFORE = OWN_RUN + "import json, mmap, random, signal, struct\nprint('B: 1')\n"
_DRIVE = "tank_drive.on_for_rotations(50, 50, 1)"
_ENDS = ("", "libc._exit(0)", "os.kill(os.getpid(), signal.SIGKILL)", _DRIVE, "1 / 0")
_PIPES = """
for link in links:
    if os.path.exists(link) and stat.S_ISFIFO(os.stat(link).st_mode):
        try: os.write(int(os.path.basename(link)), SENT)
        except OSError: pass
"""
_FILES = (
    "telemetry.bin",
    "output.bin",
    "run.json",
    "lock",
    *SIDE_FILES,
)
_READ = ("telemetry.bin", "output.bin", ACTIONS_FILE, STOP_FILE)
"""What the host reads of each run at its end."""
_PLACED = (
    "os.mkfifo(name)",
    "os.mkdir(name)",
    "os.symlink('/dev/zero', name)",
    "os.symlink('/dev/null', name)",
    "os.symlink(name, name)",
    "os.symlink('/nowhere', name)",
    "os.symlink('run.json', name)",
    "os.symlink('FIELD/secret.txt', name)",
    "open(name, 'wb').truncate(1 << 36)",
    "open(name, 'wb').write(os.urandom(999))",
    "open(name, 'w').write('null')",
    "__import__('socket').socket(1).bind(name)",
    "os.link(run + '/output.bin', name)",
    "pass",
)
"""What comes in place of a file."""
_DAY = len("20260102")
_TICK_NS = 10_000_000
"""Of the profile that `hosted` uses."""
_LARGE = 1 << 24
_FAR = 1e9
_NUMBERS: tuple[Any, ...] = (
    0,
    -1,
    1,
    10**9,
    -(10**9),
    1 << 52,
    1 << 63,
    10**40,
    0.5,
    1e300,
    None,
    "x",
    True,
    [],
    {},
)


def _event(random: Random) -> str:
    """Return an event as the child could send it, with odd values."""
    kind = random.choice(list(EVENTS.values()))
    fields: dict[str, Any] = {name: random.choice(_NUMBERS) for name in kind.__dataclass_fields__}
    if "end" in fields:
        fields |= {"end": random.choice(list(End)).value, "tick": random.choice((0, 0, *_NUMBERS))}
        fields |= {
            "time_ns": random.choice((0, 0, *_NUMBERS)),
            "summary": "x" * random.choice((0, 9, 10**5)),
        }
        fields = {
            name: value
            for name, value in fields.items()
            if name in ("end", "tick", "time_ns") or random.random() < 0.4
        }
    return json.dumps({"kind": kind.kind, **fields})


def _bytes(random: Random) -> str:
    sent = random.choice(
        (b"hello\n", b"\n" * 9, b"{}\n", b"\xff\0", b"x" * 70_000, random.randbytes(300))
    )
    return _PIPES.replace("SENT", repr(sent))


def _events(random: Random) -> str:
    sent = "".join(f"{_event(random)}\n" for _ in range(random.choice((1, 1, 2, 9))))
    return _PIPES.replace("SENT", repr(sent.encode()))


def _ends(random: Random) -> str:
    """Announce an end that could be one, and end in another way."""
    tick = random.choice((0, 0, 1, 5, 500))
    fields: dict[str, Any] = {"kind": "ended", "end": random.choice(list(End)).value, "tick": tick}
    fields |= {"time_ns": tick * _TICK_NS + random.choice((0, 0, 0, 1, _TICK_NS, -1))}
    for name in random.sample(("exit_code", "error_line", "summary"), random.choice((0, 1))):
        fields[name] = "x" if name == "summary" else random.choice((0, 1, 1 << 63, -(10**20)))
    sent = _PIPES.replace("SENT", repr(f"{json.dumps(fields)}\n".encode()))
    return "\n".join(
        (
            random.choice(("", _DRIVE)),
            sent,
            random.choice(("libc._exit(0)", "os.kill(os.getpid(), 9)")),
        )
    )


def _recording(random: Random) -> str:
    """Write somewhere into the recordings, or truncate them."""
    lines = [f"data = {random.choice((random.randbytes(64), bytes(64), b'%c' % 255 * 16))!r}"]
    for _ in range(random.randint(1, 4)):
        name = random.choice(_FILES[:2])
        at = random.choice((0, 8, 16, 24, 64, 72, 128, random.randrange(4000)))
        do = random.choice(
            (
                "f.seek(AT); f.write(data)",
                "f.seek(16); f.write(struct.pack('<Q', AT))",
                "f.truncate(AT)",
            )
        )
        lines.append(f"with open(run + '/{name}', 'r+b') as f: {do.replace('AT', str(at))}")
    return "\n".join(lines)


def _places(random: Random) -> str:
    lines = []
    for name in random.sample(_FILES, random.randint(1, 4)):
        lines += [
            f"name = run + '/{name}'",
            "if os.path.lexists(name): os.unlink(name)",
            random.choice(_PLACED),
        ]
    return "\n".join(lines)


def _folder(random: Random) -> str:
    whole = "import shutil\nshutil.rmtree(run)"
    deep = "os.chdir(run)\nfor _ in range(1100):\n    os.mkdir('d' * 20)\n    os.chdir('d' * 20)"
    beside = f"name = run + '/x'\n{random.choice(_PLACED)}"
    return random.choice(
        (
            whole,
            deep,
            beside,
            f"os.rename(run, run + '.moved'){random.choice(('', chr(10) + 'os.mkdir(run)'))}",
        )
    )


def _caches(random: Random) -> str:
    """Overwrite the prepared mat, which is mapped, with something of its size; or replace it."""
    lines = ["mapped = {line.split()[-1] for line in open('/proc/self/maps')}"]
    lines += ["mats = [name for name in mapped if name.endswith(('.sums', '.rgb'))]", "assert mats"]
    do = random.choice(
        ("f.write(bytes(size))", "f.seek(size // 2); f.write(bytes(64))", "f.truncate(size // 2)")
    )
    return "\n".join(
        (
            *lines,
            "for name in mats:",
            "    size = os.path.getsize(name)",
            "    os.chmod(name, 0o600)",
            f"    with open(name, 'r+b') as f: {do}",
        )
    )


def _forged(random: Random) -> str:
    """Change `run.json` into that of another run, which is as sound."""
    changes = {
        "another text": "data['program']['text'] = 'print(1)'",
        "another name": "data['program'] |= {'name': 'ada.py', 'path': '/ada.py'}",
        "another start": "data['spec']['world']['start']['x_mm'] = 2000.0",
        "another seed": "data['spec']['seed'] = 12345",
        "another mat": "data['field'] = None; data['spec']['world']['background'] = 'Grey_bands'",
        "another id": "data |= {'id': '20200101T000000-abcdef', 'number': 1}",
        "another day": "data['created'] = '2020-01-01T00:00:00.000Z'",
        "an end": "data['end'] = {'end': 'finished', 'tick': 7, 'time_ns': 70_000_000}",
        "answers": "data['options']['answers'] = ['yes']",
    }
    lines = [changes[name] for name in random.sample(list(changes), random.randint(1, 3))]
    load = "with open(run + '/run.json') as f: data = json.load(f)"
    store = (
        random.choice(("name = run + '/run.json'", "name = run + '/x'")),
        "with open(name, 'w') as f: json.dump(data, f)",
    )
    return "\n".join((load, *lines, *store, "os.replace(name, run + '/run.json')"))


_FD = "descriptor "
_OWN = re.compile(
    r"/dev/null$|pipe:|/memfd:output |.*[.](rgb|sums)$"
    r"|.*/((telemetry|motors|readings|commands|output)[.]bin|lock|(stack|log)[.]txt)$"
)
"""What a program reaches of its own run: its recordings, its mat, and three pipes."""
_OWN_PIPES = 3
_OPEN = f"""
for number in sorted(map(int, os.listdir('/proc/self/fd'))):
    try: print('{_FD}' + os.readlink('/proc/self/fd/' + str(number)))
    except OSError: pass
"""


def _descriptors(random: Random) -> str:
    """Print what is open, by number."""
    return _OPEN


SORTS: Mapping[str, Callable[[Random], str]] = {
    "bytes": _bytes,
    "events": _events,
    "ends": _ends,
    "recording": _recording,
    "places": _places,
    "folder": _folder,
    "caches": _caches,
    "forged": _forged,
    "descriptors": _descriptors,
}


_FILES_AND_AN_END = {
    "many files, and an end": OWN_RUN
    + "for number in range(21000): os.close(os.open(str(number), os.O_CREAT | os.O_WRONLY))\nlibc.usleep(1500000)"
}
LIMITED: Mapping[str, str] = {**DISK, **MEMORY, **PROCESSES, **PROC, **FILES, **_FILES_AND_AN_END}
"""Attacks for isolated programs, which a limit ends."""
LIMITED_ENDS: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys((*PROC, *FILES, "memory in files without a name"), ("raised",)),
    **dict.fromkeys(_FILES_AND_AN_END, ("output_limit",)),
}
"""How some of them end."""
_ISOLATED = "isolated"


def _names(random: Random) -> Iterator[str]:
    return _drawn_cases([f"{host}:{sort}" for host in HOSTS for sort in SORTS], random)


def _limited_names(random: Random) -> Iterator[str]:
    return _drawn_cases([f"{_ISOLATED}:{name}" for name in LIMITED], random)


def _drawn_cases(cases: Sequence[str], random: Random) -> Iterator[str]:
    while True:
        for case in random.sample(cases, len(cases)):
            yield f"{case}:{random.getrandbits(32)}"


def _class(eve: str) -> dict[str, str]:
    honest = {name: f"{HONEST}# {name}" for name in ("ada", "zoe")}
    return {"ada": honest["ada"], "eve": eve, "zoe": honest["zoe"]} if eve else honest


@cache
def _wanted(host: str) -> Mapping[str, Stored]:
    """Return what comes of the honest ones alone."""
    with TemporaryDirectory(prefix="tuisim-proof-") as folder:
        return _hosted(host, _class(""), Path(folder, "place")).runs


def _hosted(host: str, programs: Mapping[str, str], place: Path) -> Hosted:
    return isolated(programs, place) if host == _ISOLATED else hosted(host, programs, place)


def _check(case: str, folder: Path) -> None:
    host, sort, seed = case.split(":")
    text = LIMITED[sort] if host == _ISOLATED else _drawn(sort, Random(seed))
    (folder / "secret.txt").write_text(SECRET)
    text = text.replace("FIELD", str(folder))
    wanted = _wanted(host)
    try:
        with in_time():
            found = _hosted(host, _class(text), folder / "place")
            _check_others(found, wanted, text)
            _check_secret(folder)
            if host == _ISOLATED:
                _check_limited(found, sort, text)
            with home(folder / "place" / "home"):
                # A marked run whose commands cannot be read is a row, and is not stored.
                is_dropped = host == "mark" and "/commands.bin'" in text
                _look_at_runs(text, is_moved=sort == "folder", is_dropped=is_dropped)
    finally:
        # What is nested too deep for whoever removes the folder of the case.
        remove_tree(folder / "place")


def _drawn(sort: str, random: Random) -> str:
    return "\n".join((_BEFORE, SORTS[sort](random), random.choice(_ENDS), "print('B: 2')"))


def _check_others(found: Hosted, wanted: Mapping[str, Stored], text: str) -> None:
    others = {name: run for name, run in found.runs.items() if name != "eve"}
    if others != wanted:
        raise FaultError(f"the others end with {others}, not {wanted}; {found.said[-500:]}\n{text}")
    if report_file().exists():
        raise FaultError(f"a mistake of ours: {report_file().read_text()[-2000:]}\n{text}")
    if found.code == EXIT_OUR_MISTAKE or "internal error" in found.said or "/tuisim/" in found.said:
        raise FaultError(f"exit code {found.code}: {found.said[-2000:]}\n{text}")


def _check_limited(found: Hosted, sort: str, text: str) -> None:
    """Check that a limit has ended an isolated program."""
    eve = found.runs["eve"]
    if eve.end not in LIMITED_ENDS.get(sort, ("raised", "output_limit", "finished", "crashed")):
        raise FaultError(f"no limit has ended it: {eve}\n{text}")
    if "GiB" in found.said.replace("or 1 GiB", ""):
        raise FaultError(f"it got too much: {found.said}\n{text}")


def _check_secret(folder: Path) -> None:
    """Check that what a link leads to was neither changed nor copied."""
    if (folder / "secret.txt").read_text() != SECRET:
        raise FaultError("a file behind a link was changed")
    for place, _, names in os.walk(folder / "place" / "home"):
        for path in (os.path.join(place, name) for name in names):
            # False of a path that is too long, as of any other that nobody can read.
            is_plain = os.path.isfile(path) and not os.path.islink(path)
            if (
                is_plain
                and os.path.getsize(path) < _LARGE
                and SECRET.encode() in Path(path).read_bytes()
            ):
                raise FaultError(f"what a link leads to was copied into {path}")


def _look_at_runs(text: str, is_moved: bool, is_dropped: bool) -> None:
    check_said(["runs"])
    runs = [(info, RunStore().load_run(info.id)) for info in RunStore().runs()]
    texts = [run.program.text for _, run in runs]
    for info, run in runs:
        if not is_moved:
            _check_started(info, run, runs[0][1])
        if run.state != End.FALSIFIED:
            _check_recording(run)
            _check_descriptors(run)
        for words in (["runs", "show"], ["log", "summary"], ["runs", "rm"]):
            check_said([*words, info.id])
    is_missing = is_moved or is_dropped
    if not is_missing and not any(one.endswith(f"{text}\n") for one in texts):
        raise FaultError(f"what is stored is not what was started\n{text}")


def _check_started(info: RunInfo, run: StoredRun, other: StoredRun) -> None:
    """Check that what is stored of a run, apart from its recording, is what its host has started."""
    pairs = {
        "id": (run.id, run.folder.name),
        "number": (run.number, info.number),
        "day": (run.created.replace("-", "")[:_DAY], run.id[:_DAY]),
        "name": (run.program.name, info.program),
        "seed": (run.spec.seed, info.seed),
        "spec": (replace(run.spec, seed=0), replace(other.spec, seed=0)),
        "mat": (run.field, other.field),
        "options": (run.options, other.options),
    }
    if changed := {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}:
        raise FaultError(f"what is stored is not what was started: {changed}")


def _check_descriptors(run: StoredRun) -> None:
    """Check that a program that has printed what it can reach reaches nothing of others."""
    found = [row.text.removeprefix(_FD) for row in run.output.rows() if row.text.startswith(_FD)]
    pipes = sum(name.startswith("pipe:") for name in found)
    others = [name for name in found if not _OWN.match(name)]
    if others or pipes > _OWN_PIPES:
        raise FaultError(f"a program has descriptors of others: {others}, {pipes} pipes of {found}")


def _is_regular(path: Path) -> bool:
    return stat.S_ISREG(path.lstat().st_mode)


def _check_recording(run: StoredRun) -> None:
    """Check that a run that is not falsified has what only the simulation writes."""
    odd = [
        path.name
        for path in map(run.folder.joinpath, _READ)
        if os.path.lexists(path) and not _is_regular(path)
    ]
    if odd:
        raise FaultError(f"a run that is {run.state} has something else in place of {odd}")
    records = run.telemetry.array()
    sizes = [
        np.abs(records[name]).max(initial=0.0)
        for name in ("x_mm", "y_mm", "heading_deg", "left_position_deg")
    ]
    if records["tick"].tolist() != list(range(len(records))) or not max(sizes) < _FAR:
        raise FaultError(f"a run that is {run.state} holds other records: {records[:3]}")
    if run.state == End.FINISHED and run.end is not None and run.end.tick != len(records) - 1:
        raise FaultError(f"a run of {len(records)} ticks ends at {run.end}")


ENEMIES = Kind("an enemy between honest programs, in each of the five hosts", _names, _check)
LIMITS = Kind("isolated programs that want more than they may have", _limited_names, _check)
