"""Faults to plant in a copy of tuisim, one at a time: the proof must find them.

A fault that is not found says that a kind does not look where it seems to. Each is a change of a line or two, such as
an edit could make by mistake: a link that is followed, a check that is left out, a descriptor too many. They are in
the host's side only, which has to bear whatever a program does.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.conftest import ROOT
from tests.running import PATIENCE_S


@dataclass(frozen=True, slots=True)
class Planted:
    """A fault, and the cases that must show it."""

    about: str
    file: str
    """Relative to the folder of the package."""
    old: str
    """Occurs once in it."""
    new: str
    kind: str
    cases: tuple[str, ...]
    """Each of them shows the fault, and nothing without it."""
    shows: str
    """What they say then."""

    @property
    def is_isolated(self) -> bool:
        """Whether its cases need isolation."""
        return all(case.startswith("isolated:") for case in self.cases)


PLANTED: tuple[Planted, ...] = (
    Planted(
        "the end of a run is written through a link in place of run.json",
        "runs/run_folder.py",
        "replacing(path, owner_only=True, follow_links=False)",
        "replacing(path, owner_only=True)",
        "enemies",
        ("run:places:324",),
        "symbolic links",
    ),
    Planted(
        "a file of a run may be a link to any other",
        "regular_file.py",
        "0 if follow_links else os.O_NOFOLLOW",
        "0",
        "enemies",
        ("run:places:366",),
        "was copied into",
    ),
    Planted(
        "a pipe or a device is read as a file",
        "regular_file.py",
        "if not stat.S_ISREG(os.fstat(descriptor).st_mode):",
        "if stat.S_ISDIR(os.fstat(descriptor).st_mode):",
        "enemies",
        ("run:places:41",),
        "something else in place of",
    ),
    Planted(
        "a program that is a link is marked",
        "marks/students.py",
        "    if path.is_symlink():\n        return Student",
        "    if False:\n        return Student",
        "class",
        ("links:0",),
        "not refused",
    ),
    Planted(
        "a link that leads out of a student's folder is no reason to refuse it",
        "marks/students.py",
        "if not _real(path).is_relative_to(own):",
        "if False:",
        "class",
        ("links:1",),
        "not refused",
    ),
    Planted(
        "a formula in the sheet is written as it is",
        "logs/csv_cells.py",
        'return f"\'{text}" if _is_risky(text) and not _is_number(text) else text',
        "return text",
        "class",
        ("names:12",),
        "formulas in the sheet",
    ),
    Planted(
        "what is no event ends the host",
        "runs/child/events.py",
        "            self.falsified = str(error)\n            return None",
        "            raise",
        "enemies",
        ("run:bytes:0", "batch:bytes:0", "mark:bytes:0"),
        "the others end with",
    ),
    Planted(
        "an event may have any number",
        "runs/child/events.py",
        "if not _is_sound(asdict(event)):",
        "if False:",
        "enemies",
        ("run:ends:91",),
        "error_line is",
    ),
    Planted(
        "an end is believed that the recording does not have",
        "runs/handle.py",
        "if is_whole and end is not None and end.tick != ticks - 1:",
        "if False:",
        "enemies",
        ("batch:ends:35",),
        "ticks ends at",
    ),
    Planted(
        "records are not checked",
        "runs/views.py",
        "        if are_all(part, begin, end):\n            return end",
        "        return end",
        "enemies",
        ("mark:recording:3",),
        "other records",
    ),
    Planted(
        "run.json is taken from the run folder, not from what was started",
        "runs/store.py",
        '{**run.data, "tags": _tags_in(run.folder), "end"',
        '{**read_run_file(run.folder), "tags": _tags_in(run.folder), "end"',
        "enemies",
        ("notebook:forged:0",),
        "is not what was started",
    ),
    Planted(
        "a program inherits the host's end of a pipe",
        "runs/child/process.py",
        "inherited = [command_read, event_write, lifeline_read, lock_fd]",
        "inherited = [command_read, event_write, lifeline_read, lock_fd, command_fd]",
        "enemies",
        ("app:descriptors:0",),
        "descriptors of others",
    ),
    Planted(
        "a mat in the cache is trusted although it was written to",
        "config/mat_cache.py",
        "if _checksum(stream.fileno()) != checksum:",
        "if False:",
        "enemies",
        ("run:caches:4",),
        "the others end with",
    ),
    Planted(
        "an isolated program may write to what it reads",
        "runs/child/isolation.py",
        '"--ro-bind-try"',
        '"--bind-try"',
        "enemies",
        ("isolated:its mat:0",),
        "no limit has ended it",
    ),
    Planted(
        "an isolated program may have any number of files",
        "runs/handle.py",
        "        if self._quota is not None and not self._exceeded:",
        "        if False:",
        "enemies",
        ("isolated:many files, and an end:0",),
        "no limit has ended it",
    ),
)
_FAULTS = """\
import json, sys
from tests.proof.kind import fault_of
from tests.proof.kinds import KINDS
print(json.dumps([fault_of(KINDS[sys.argv[1]], case) for case in sys.argv[2:]]))
"""


def plant(fault: Planted, folder: Path) -> None:
    """Copy the package into an empty folder, with a fault, so that its tests can be run there."""
    # With the times of the files: their bytecode is as old.
    shutil.copytree(ROOT / "tuisim", folder / "tuisim")
    for name in ("tests", "backgrounds", "programs"):
        (folder / name).symlink_to(ROOT / name)
    path = folder / "tuisim" / fault.file
    path.write_text(path.read_text().replace(fault.old, fault.new))


def faults(kind: str, cases: Sequence[str], root: Path = ROOT) -> list[str]:
    """Return what cases show of the package in a folder, empty for each that shows nothing."""
    done = subprocess.run(
        [sys.executable, "-c", _FAULTS, kind, *cases],
        cwd=root,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S * len(cases),
        check=True,
    )
    return list(json.loads(done.stdout.splitlines()[-1]))


def missed(fault: Planted) -> list[str]:
    """Plant a fault; return the cases that do not show it, each with what it shows instead."""
    with TemporaryDirectory(prefix="tuisim-proof-") as folder:
        plant(fault, Path(folder))
        texts = faults(fault.kind, fault.cases, Path(folder))
    pairs = zip(fault.cases, texts, strict=True)
    return [
        f"{fault.kind} --case {case}: {text[-500:]}"
        for case, text in pairs
        if fault.shows not in text
    ]
