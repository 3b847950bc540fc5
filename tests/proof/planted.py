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
        "engine/runs/run_folder.py",
        "replacing(path, owner_only=True, follow_links=False)",
        "replacing(path, owner_only=True)",
        "enemies",
        ("run:places:324",),
        "symbolic links",
    ),
    Planted(
        "a file of a run may be a link to any other",
        "base/regular_file.py",
        "0 if follow_links else os.O_NOFOLLOW",
        "0",
        "enemies",
        ("batch:places:604", "mark:places:604"),
        "was copied into",
    ),
    Planted(
        "a pipe or a device is read as a file",
        "base/regular_file.py",
        "if not stat.S_ISREG(os.fstat(descriptor).st_mode):",
        "if stat.S_ISDIR(os.fstat(descriptor).st_mode):",
        "enemies",
        ("run:places:41",),
        "something else in place of",
    ),
    Planted(
        "a program that is a link is marked",
        "tasks/marks/students.py",
        "    if path.is_symlink():\n        return Student",
        "    if False:\n        return Student",
        "class",
        ("links:0",),
        "not refused",
    ),
    Planted(
        "a link that leads out of a student's folder is no reason to refuse it",
        "tasks/marks/students.py",
        "if not _resolve_links(path).is_relative_to(own):",
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
        "engine/runs/child/events.py",
        "            self.falsified = str(error)\n            return None",
        "            raise",
        "enemies",
        ("run:bytes:0",),
        "the others end with",
    ),
    Planted(
        "an event may have any number",
        "engine/runs/child/events.py",
        "if not _is_sound(asdict(event)):",
        "if False:",
        "enemies",
        ("run:ends:91",),
        "error_line is",
    ),
    Planted(
        "an end is believed that the recording does not have",
        "engine/runs/handle.py",
        "if is_whole and end is not None and end.tick != ticks - 1:",
        "if False:",
        "enemies",
        ("batch:ends:35",),
        "ticks ends at",
    ),
    Planted(
        "records are not checked",
        "engine/runs/views.py",
        "        if are_all(part, begin, end):\n            return end",
        "        return end",
        "enemies",
        ("run:recording:3", "batch:recording:3"),
        "other records",
    ),
    Planted(
        "run.json is taken from the run folder, not from what was started",
        "engine/runs/store.py",
        '{**run.data, "tags": _read_tags(folder), "end"',
        '{**read_run_file(run.folder), "tags": _read_tags(folder), "end"',
        "enemies",
        ("notebook:forged:0",),
        "is not what was started",
    ),
    Planted(
        "a program inherits the host's end of a pipe",
        "engine/runs/child/process.py",
        "inherited = [command_read, event_write, lifeline_read, lock_fd]",
        "inherited = [command_read, event_write, lifeline_read, lock_fd, command_fd]",
        "enemies",
        ("app:descriptors:0",),
        "descriptors of others",
    ),
    Planted(
        "a mat in the cache is trusted although it was written to",
        "engine/mat_cache.py",
        "if _checksum(stream.fileno()) != checksum:",
        "if False:",
        "enemies",
        ("run:caches:4",),
        "the others end with",
    ),
    Planted(
        "an isolated program may write to what it reads",
        "engine/runs/child/isolation.py",
        '"--ro-bind-try"',
        '"--bind-try"',
        "limits",
        ("isolated:its mat:0",),
        "no limit has ended it",
    ),
    Planted(
        "an isolated program may have any number of files",
        "engine/runs/handle.py",
        "        if self._quota is not None and not self._exceeded:",
        "        if False:",
        "limits",
        ("isolated:many files, and an end:0",),
        "no limit has ended it",
    ),
    Planted(
        "squares of huge numbers overflow",
        "logs/magnitude.py",
        "return math.ldexp(1.0, exponent - min(max(exponent, -_MAX_EXPONENT), _MAX_EXPONENT))",
        "return 1.0",
        "numbers",
        ("batch:1623277279",),
        "the report of what went wrong",
    ),
    Planted(
        "a span of an axis overflows",
        "pictures/charts/axes.py",
        "return np.where(np.isfinite(numbers), numbers.clip(-MAX_DRAWN, MAX_DRAWN), numbers)",
        "return numbers",
        "numbers",
        ("app:3",),
        "OverflowError",
    ),
    Planted(
        "what cannot be copied ends the marking",
        "tasks/marks/runs.py",
        "except Exception as error:  # Any error concerns this run only; the others go on.\n            uncopied",
        "except ZeroDivisionError as error:\n            uncopied",
        "class",
        ("faults:1",),
        "internal error",
    ),
    Planted(
        "what cannot be judged ends the marking",
        "tasks/marks/runs.py",
        "except Exception as error:  # Any error concerns this run only; the others go on.\n                outcome",
        "except ZeroDivisionError as error:\n                outcome",
        "class",
        ("faults:12",),
        "internal error",
    ),
    Planted(
        "what cannot be read ends the marking",
        "tasks/marks/students.py",
        "except Exception as error:",
        "except ZeroDivisionError as error:",
        "class",
        ("faults:15",),
        "internal error",
    ),
    Planted(
        "a file name that is not UTF-8 ends the marking",
        "tasks/marks/students.py",
        'return printable(os.fsencode(name).decode("utf-8", "backslashreplace"))',
        "return name",
        "class",
        ("delivered:2",),
        "marks.csv",
    ),
    Planted(
        "an isolated program may have semaphores",
        "engine/runs/child/isolation.py",
        "29, 68, 64, 248",
        "29, 68, 248",
        "limits",
        ("isolated:semaphores:0",),
        "it got too much",
    ),
    Planted(
        "an isolated program may send descriptors",
        "engine/runs/child/isolation.py",
        "250, 46, 307, 319",
        "250, 307, 319",
        "limits",
        ("isolated:files on their way:0",),
        "it got too much",
    ),
    Planted(
        "an isolated program may have files in memory",
        "engine/runs/child/isolation.py",
        "307, 319, 278",
        "307, 278",
        "limits",
        ("isolated:memory in files without a name:0",),
        "no limit has ended it",
    ),
    Planted(
        "an isolated program may give pages to a pipe",
        "engine/runs/child/isolation.py",
        "319, 278)",
        "319)",
        "limits",
        ("isolated:pages in pipes:0",),
        "it got too much",
    ),
    Planted(
        "an isolated program may have any number of sockets",
        "engine/runs/child/isolation.py",
        "if self._count_sockets() - self._sockets > _MAX_SOCKETS:",
        "if False:",
        "limits",
        ("isolated:connections that nobody accepts:0",),
        "it got too much",
    ),
    Planted(
        "an isolated program may enlarge the buffers of sockets",
        "engine/runs/child/isolation.py",
        "_pack_instruction(_EQUAL, machine.setsockopt, 0, 7)",
        "_pack_instruction(_EQUAL, _X32, 0, 7)",
        "limits",
        ("isolated:sockets with large buffers:0",),
        "it got too much",
    ),
    Planted(
        "a connection that asks for nothing stays",
        "web/gate.py",
        "loop.call_later(STRANGER_S,",
        "loop.call_later(1e6,",
        "security",
        ("web:silent",),
        "TimeoutError",
    ),
    Planted(
        "connections that ask for nothing keep visitors out",
        "web/gate.py",
        "if len(self._strangers) > MAX_STRANGERS:",
        "if False:",
        "security",
        ("web:connections",),
        "Too many open files",
    ),
    Planted(
        "a lack of descriptors is told each time",
        "web/gate.py",
        "elif self._clock() >= self._told_s + _TOLD_EVERY_S:",
        "else:",
        "security",
        ("web:descriptors",),
        "the server's terminal gets",
    ),
    Planted(
        "files that are brought are held in memory",
        "web/uploads.py",
        "with TemporaryFile(dir=folder) as file:",
        'with __import__("io").BytesIO() as file:',
        "security",
        ("web:uploads",),
        "uploads take",
    ),
    Planted(
        "a file that is cut off is a traceback",
        "web/server.py",
        "except (ConnectionError, ClientError):",
        "except ZeroDivisionError:",
        "security",
        ("web:uploads",),
        "the server's terminal gets",
    ),
    Planted(
        "the length of a name is counted in characters",
        "web/uploads.py",
        'len(name.encode("utf-8", "replace"))',
        "len(name)",
        "security",
        ("web:uploads",),
        "a name that is too long",
    ),
    Planted(
        "pieces of files that nobody has asked for are held",
        "web/server.py",
        "if answer is not None and not answer.done() and len(chunk) <= _MAX_PIECE_BYTES:",
        "if not self._asked.setdefault(f'{len(self._asked)}', chunk):",
        "security",
        ("web:unasked",),
        "what an app sends unasked",
    ),
    Planted(
        "what a killed command has left stays",
        "engine/runs/temporary.py",
        "for place in (parent, default, _MEMORY):",
        "for place in ():",
        "crashes",
        ("mark:rename:2",),
        "what was killed has left",
    ),
    Planted(
        "names of Moodle are names of students",
        "tasks/marks/hand_ins.py",
        "(match := _MOODLE.fullmatch(path.name))",
        "(match := None)",
        "class",
        ("delivered:13",),
        "too many values",
    ),
    Planted(
        "names of Canvas are names of students",
        "tasks/marks/hand_ins.py",
        "elif (match := _CANVAS.fullmatch(path.name)) and os.path.isfile(path):",
        "elif match := None:",
        "class",
        ("delivered:4",),
        "too many values",
    ),
    Planted(
        "what a Mac adds is handed in",
        "tasks/marks/files.py",
        '"__MACOSX", "._*", ',
        "",
        "class",
        ("delivered:8",),
        "too many values",
    ),
    Planted(
        "a folder that is alone is not entered",
        "tasks/marks/students.py",
        "        path = path / names[0]\n    return path",
        "        break\n    return path",
        "class",
        ("delivered:10",),
        "an honest one has",
    ),
    Planted(
        "a zip is no folder",
        "tasks/marks/students.py",
        "unpacked = search.unpack(path) if is_packed else path",
        "unpacked = path",
        "class",
        ("delivered:0",),
        "an honest one has",
    ),
    Planted(
        "a zip may lead out of its folder",
        "tasks/marks/files.py",
        'if inside.is_absolute() or ".." in inside.parts:',
        "if False:",
        "class",
        ("zips:15",),
        "not refused",
    ),
    Planted(
        "what is unpacked goes where the name of its zip leads",
        "tasks/marks/students.py",
        'return place / (name if name.strip(".") else "files")',
        "return place / name",
        "class",
        ("others:0",),
        "the others have the rows",
    ),
    Planted(
        "of two numbers in the name of a hand-in, the second is the student's",
        "tasks/marks/hand_ins.py",
        " and len(_MOODLE_NUMBER.findall(path.name)) == 1:",
        ":",
        "class",
        ("others:2",),
        "the others have the rows",
    ),
    Planted(
        "a zip may have links",
        "tasks/marks/files.py",
        "if mode not in (0, stat.S_IFREG, stat.S_IFDIR):",
        "if False:",
        "class",
        ("zips:2",),
        "not refused",
    ),
    Planted(
        "copies have the modes of what was handed in",
        "tasks/marks/files.py",
        "            copy.truncate(size)\n",
        "            copy.truncate(size)\n            os.fchmod(copy.fileno(), os.fstat(file.fileno()).st_mode)\n",
        "class",
        ("delivered:6",),
        "an honest one has",
    ),
    Planted(
        "copies have no holes",
        "tasks/marks/files.py",
        "start, stop = _find_data(file, place, size)",
        "start, stop = place, size",
        "class",
        ("delivered:1",),
        "an honest one has",
    ),
    Planted(
        "a package is a candidate",
        "tasks/marks/students.py",
        "names = [name for name in programs if name != _PACKAGE]",
        "names = programs",
        "class",
        ("delivered:60",),
        "an honest one has",
    ),
    Planted(
        "the recording of a program is judged, not the replay",
        "tasks/marks/runs.py",
        "is_replayed=True",
        "is_replayed=False",
        "class",
        ("forged:4",),
        "a forged run has",
    ),
    Planted(
        "the poses of a recording are trusted",
        "engine/runs/replay.py",
        "if parted > last_tick and run.actions == done:",
        "if run.actions == done:",
        "replays",
        ("pose:1",),
        "pose is not found",
    ),
    Planted(
        "the motors of a recording are trusted",
        "engine/runs/replay.py",
        "min(_find_parting(records, recorded), _find_motor_parting(run, ticks))",
        "_find_parting(records, recorded)",
        "replays",
        ("motors:1",),
        "motors is not found",
    ),
    Planted(
        "the actions of a recording are trusted",
        "engine/runs/replay.py",
        "done = tuple(action for action in actions if action.tick < last_tick)",
        "done = run.actions",
        "replays",
        ("actions:1",),
        "actions is not found",
    ),
    Planted(
        "a replay ignores when a command came",
        "engine/runs/replay.py",
        "        advance(tick)\n",
        "        advance(0)\n",
        "replays",
        ("honest:1",),
        "an honest run differs",
    ),
    Planted(
        "a replay has no actions of the user",
        "engine/runs/replay.py",
        "change_simulation(sim, script.popleft().command)",
        "script.popleft()",
        "replays",
        ("honest:11",),
        "an honest run differs",
    ),
    Planted(
        "a replay has no drift",
        "engine/runs/replay.py",
        "sim.restart(spec, ticks,",
        "sim.restart(replace(spec, world=replace(spec.world, drift=type(spec.world.drift)())), ticks,",
        "replays",
        ("honest:9",),
        "an honest run differs",
    ),
    Planted(
        "a replay has another seed",
        "engine/runs/replay.py",
        "sim.restart(spec, ticks,",
        "sim.restart(replace(spec, seed=0), ticks,",
        "replays",
        ("honest:4",),
        "an honest run differs",
    ),
    Planted(
        "a replay obeys no commands",
        "engine/runs/replay.py",
        "        give_command(sim, command)\n",
        "",
        "replays",
        ("honest:1",),
        "an honest run",
    ),
    Planted(
        "a replay takes any time",
        "engine/runs/replay.py",
        "if not number % _LOOK_EVERY and thread_time() > give_up_s:",
        "if False:",
        "replays",
        ("limit:1",),
        "a replay has no limit",
    ),
    Planted(
        "commands that are left out are not missed",
        "engine/runs/replay.py",
        "if commands.left_out:",
        "if False:",
        "replays",
        ("count:1",),
        "count is not found",
    ),
    Planted(
        "a command may come after the end",
        "engine/runs/replay.py",
        "if tick > last_tick:",
        "if False:",
        "replays",
        ("time:1",),
        "could not broadcast",
    ),
    Planted(
        "the time of commands may go back",
        "engine/runs/replay.py",
        "if time_ns < self._newest_ns:",
        "if False:",
        "replays",
        ("order:1",),
        "order is not found",
    ),
    Planted(
        "any number of commands costs no time",
        "engine/runs/replay.py",
        'if self._count > MAX_AN_INSTANT else ""',
        'if False else ""',
        "replays",
        ("many:1",),
        "many is not found",
    ),
    Planted(
        "a command may be one of other motors",
        "engine/runs/replay.py",
        "if self._sim.spec.profile.motor_law not in CALLS[call].laws:",
        "if False:",
        "replays",
        ("law:1",),
        "law",
    ),
    Planted(
        "a command may be for a part that is not there",
        "engine/runs/replay.py",
        "if part >= len(list_parts(self._sim, CALLS[call].target)):",
        "if False:",
        "replays",
        ("part:1",),
        "part",
    ),
    Planted(
        "a command may have any values",
        "engine/runs/replay.py",
        'return "has a value that is not allowed"',
        'return ""',
        "replays",
        ("value:1",),
        "value is not found",
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
