"""The run store: one folder for each run, and the catalogue that lists them."""

from __future__ import annotations

import os
import reprlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, field, replace
from datetime import UTC, datetime
from operator import index
from pathlib import Path
from typing import Any

from tuisim.base.atomic import make_private_folder, private
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder, remove_tree
from tuisim.base.regular_file import of_the_machine, open_regular
from tuisim.base.source import Program
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.core.profile import NS_PER_S, compute_due_ns
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import RUN_STATES, End, Ended, Unended
from tuisim.engine.runs.catalogue import HOME_HINT, Catalogue, RunInfo, lock_home
from tuisim.engine.runs.records import OUTPUT_FILE, TELEMETRY_FILE
from tuisim.engine.runs.run_folder import (
    MAX_INTEGER,
    RUN_FILE,
    StoredRun,
    build_run_data,
    find_state_without_end,
    read_run,
    read_run_file,
    write_run_file,
)
from tuisim.engine.runs.side_files import MAX_BYTES, SIDE_FILES, hold, is_held
from tuisim.engine.runs.views import OutputView, TelemetryView

RUNS_FOLDER = "runs"
_REMOVED = ".removed"
"""End of the name of a folder that is about to be deleted."""
LAST = "last"
_MAY_CHANGE = (None, Unended.INTERRUPTED, Unended.DAMAGED)
"""Ends in the catalogue that are not final: a run file that seemed damaged may only have been unreadable for a
moment."""
_COUNT_AT_ONCE_BYTES = 1 << 20
"""Largest output in bytes whose samples are counted at the end of the run; a longer one delays the end, so it waits."""

_COUNT_A_LISTING_BYTES = 8 << 20
"""Bytes of output in which samples are counted on each listing; the rest waits for the next listing."""


@dataclass(frozen=True, slots=True)
class NewRun:
    """A run whose folder has just been created, with its lock."""

    id: str
    number: int
    folder: Path
    lock_fd: int = -1
    """The lock of the folder, see `side_files.hold`, which the process of the run inherits; -1 if it is over."""
    data: dict[str, Any] = field(default_factory=dict)
    """The contents of the run's `run.json`."""


class RunStore:
    """All runs in one home folder, which several processes may use at the same time.

    Args:
        home: The folder, by default `home_folder()`. It is created with the first run.
    """

    def __init__(self, home: Path | None = None) -> None:
        self.home = (home_folder() if home is None else home).absolute()
        self._runs = self.home / RUNS_FOLDER
        self._catalogue = Catalogue(self.home, self._scan)

    def folder(self, run_id: str) -> Path:
        """Return the path of a run's folder in the home folder, whether it exists or not."""
        return self._runs / run_id

    # Writing

    def create_run(
        self,
        program: Program,
        spec: RunSpec,
        field: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        live: bool = False,
    ) -> NewRun:
        """Create the folder of a run that is about to start, with its `run.json`, list the run, and return it.

        Args:
            program: The program.
            spec: The specification of the run.
            field: The files of the prepared mat as JSON data; None if there are none.
            options: The run options as JSON data.
            live: Whether the run is paced by the wall clock.

        Raises:
            LogError: the home folder cannot be written.
        """
        now = datetime.now(UTC)
        created = now.isoformat(timespec="milliseconds")
        run_id, folder, lock_fd = self._create_folder(now)
        info = RunInfo(
            0, run_id, created, program.name, spec.world.background, spec.profile.name, spec.seed
        )
        try:
            number = self._catalogue.add(info)
            data = build_run_data(run_id, number, created, program, spec, field, options, live)
            write_run_file(folder, data)
        # Any exception, such as KeyboardInterrupt, ends up here, because nobody else closes the lock.
        except BaseException:
            os.close(lock_fd)
            remove_tree(folder)
            raise
        return NewRun(run_id, number, folder, lock_fd, data)

    def add_folder(self, folder: Path, tags: Sequence[str] = ()) -> NewRun:
        """Move the folder of a finished run into the store, list the run, and return it with its new folder.

        Args:
            folder: The folder.
            tags: Further tags for the run, each a single word.

        Raises:
            LogError: there is no run in the folder, or the home folder cannot be written.
        """
        data = read_run_file(folder)
        data["tags"] += tags
        run_id, place, lock_fd = self._create_folder(datetime.now(UTC))
        try:
            info = _build_info(run_id, data)
            _copy_files(folder, place)
            number = self._catalogue.add(info)
            write_run_file(place, {**data, "id": run_id, "number": number})
        except OSError as error:
            remove_tree(place)
            raise LogError(
                f"cannot be stored: {error.strerror or error}", HOME_HINT, file=str(place)
            ) from error
        # Any exception, such as KeyboardInterrupt, ends up here, because an incomplete run must not be listed.
        except BaseException:
            remove_tree(place)
            raise
        finally:
            os.close(lock_fd)
        remove_tree(folder)
        return NewRun(run_id, number, place)

    def finish(self, run: NewRun, end: Ended) -> None:
        """Record how a run ended.

        The whole `run.json` is written again, from what is known of the run's start, because the program could have
        changed the file. Only the tags are read from it.

        Raises:
            LogError: the run does not exist, or cannot be written.
        """
        folder = self._find_folder(run.id)
        with lock_home(self.home):
            write_run_file(folder, {**run.data, "tags": _read_tags(folder), "end": asdict(end)})
        output = OutputView(folder, end.end is End.FALSIFIED)
        samples = output.count_rows()[1] if output.length <= _COUNT_AT_ONCE_BYTES else None
        # If the catalogue cannot be written now, it will be updated later.
        with suppress(LogError):
            self._catalogue.update(
                run.id,
                end=end.end,
                ticks=end.tick,
                time_s=end.time_ns / NS_PER_S,
                samples=samples,
                summary=end.summary,
            )

    def note_plugged(self, run: NewRun, parts: Sequence[PluggedPart]) -> None:
        """Record which parts have been plugged in so far.

        Raises:
            LogError: the run cannot be written.
        """
        run.data["plugged"] = [part.to_plain() for part in parts]
        with lock_home(self.home):
            write_run_file(run.folder, {**run.data, "tags": _read_tags(run.folder)})

    def forget(self, run_id: str) -> None:
        """Delete the folder and the row of a run that could not be started."""
        remove_tree(self.folder(run_id))
        with suppress(LogError):
            self._catalogue.remove([run_id])

    def tag(self, run_id: str, tags: Iterable[str]) -> None:
        """Replace the tags of a run.

        Raises:
            LogError: the run does not exist, a tag is not a single word, or the run cannot be written.
        """
        words = list(tags)
        for word in words:
            if word.split() != [word]:
                raise LogError(f"{word!r} is not a tag", "a tag is one word without blanks")
        folder = self._find_folder(run_id)
        with lock_home(self.home):
            write_run_file(folder, {**read_run_file(folder), "tags": words})
        self._catalogue.update(run_id, tags=" ".join(words))

    def remove(self, run_id: str) -> None:
        """Delete a run with all its data.

        Raises:
            LogError: the run does not exist, is still running, or cannot be deleted.
        """
        folder = self._find_folder(run_id)
        if not _has_end(folder) and find_state_without_end(folder) is Unended.RUNNING:
            raise LogError(f"run {run_id} is still running", "stop it first")
        try:
            _delete(folder)
        except FileNotFoundError as error:
            # Another process has deleted the run in the meantime.
            raise LogError(f"no run {run_id!r}", file=str(self._runs)) from error
        except OSError as error:
            raise LogError(
                f"cannot be removed: {error.strerror or error}", file=str(folder)
            ) from error
        # The run is gone. If the catalogue cannot be written now, it will be updated later.
        with suppress(LogError):
            self._catalogue.remove([run_id])

    # Reading

    def runs(self) -> list[RunInfo]:
        """Return the catalogue rows of all runs, oldest first, each with its `end`.

        Raises:
            LogError: the home folder cannot be used.
        """
        rows = []
        left = _COUNT_A_LISTING_BYTES
        changes: list[tuple[str, dict[str, Any]]] = []
        for row in self._update_rows():
            known, change, counted = self._complete(row, left)
            if not change and row.end in _MAY_CHANGE and not self.folder(row.id).is_dir():
                # Another process has deleted the run since it was listed.
                continue
            rows.append(known)
            left -= counted
            if change:
                changes.append((row.id, change))
        if changes:
            # If the changes cannot be stored, they are computed again the next time.
            with suppress(LogError):
                self._catalogue.update_all(changes)
        return rows

    def _update_rows(self) -> list[RunInfo]:
        """Return the catalogue rows of all runs, after adding those of new folders and removing old ones."""
        try:
            there = {entry.name for entry in os.scandir(self._runs) if entry.is_dir()}
        except FileNotFoundError:
            return []
        except OSError as error:
            raise LogError(
                f"cannot be read: {error.strerror or error}", HOME_HINT, file=str(self._runs)
            ) from error
        rows = self._catalogue.rows()
        listed = {row.id for row in rows}
        gone = {row.id for row in rows if row.id not in there and not self.folder(row.id).is_dir()}
        strangers = [self.folder(name) for name in sorted(there - listed)]
        new_rows = list(filter(None, map(self._read_info, strangers)))
        for folder in strangers:
            _remove_unfinished(folder)
        if gone or new_rows:
            try:
                self._catalogue.remove(gone)
                for info in new_rows:
                    self._catalogue.add(info)
                rows = self._catalogue.rows()
            except LogError:
                # If the catalogue cannot be written, the result is still right, because it follows from the folders.
                rows = [row for row in rows if row.id not in gone] + new_rows
        return rows

    def find(self, text: str) -> RunInfo:
        """Return the catalogue row of the run that a text names: an id or its start, a number, or `last`.

        Raises:
            LogError: no run matches, or more than one.
        """
        rows = self._update_rows()
        if not rows:
            raise LogError(f"no run {text!r}: no runs are stored yet", file=str(self.home))
        return self._complete(_match(text, rows), _COUNT_A_LISTING_BYTES)[0]

    def load_run(self, run: str | Path) -> StoredRun:
        """Return a run by its folder (a path, or a string with a slash) or by anything that `find` accepts.

        Raises:
            LogError: the run does not exist, or is damaged.
        """
        if isinstance(run, Path) or os.sep in run:
            return read_run(Path(run))
        if run.strip(".") and os.path.isdir(self.folder(run)):
            return read_run(self.folder(run))
        info = self.find(run)
        try:
            return replace(read_run(self.folder(info.id)), number=info.number)
        except LogError as error:
            if os.path.lexists(self.folder(info.id) / RUN_FILE):
                raise
            # Another process has deleted the run since it was found.
            raise LogError(f"no run {run!r}", file=str(self.home)) from error

    # Internals

    def _find_folder(self, run_id: str) -> Path:
        """Return the folder of a run.

        Raises:
            LogError: it does not exist.
        """
        folder = self.folder(run_id)
        if not os.path.isdir(folder):
            raise LogError(f"no run {run_id!r}", file=str(self._runs))
        return folder

    def _create_folder(self, now: datetime) -> tuple[str, Path, int]:
        """Create the folder of a new run, and lock it.

        Without the lock, other processes would take the run for an interrupted one, and could remove it.

        Returns:
            The id of the run, its folder, and the descriptor of the lock.
        """
        while True:
            run_id = f"{now:%Y%m%dT%H%M%S}-{os.urandom(3).hex()}"
            folder = self.folder(run_id)
            try:
                make_private_folder(self._runs)
                folder.mkdir(0o700)
                lock_fd = hold(folder)
            except FileExistsError:
                continue
            except OSError as error:
                remove_tree(folder)
                what = error.strerror or str(error)
                raise LogError(
                    f"runs cannot be stored here: {what}", HOME_HINT, file=str(self.home)
                ) from error
            return run_id, folder, lock_fd

    def _scan(self) -> Iterator[RunInfo]:
        return filter(None, map(self._read_info, sorted(self._runs.glob("*"))))

    def _read_info(self, folder: Path) -> RunInfo | None:
        """Return the catalogue row of the run in a folder; None if there is no run in it (yet)."""
        # The folder's name is the id: a copied run is another run.
        run_id = folder.name
        if run_id.startswith(".") or not os.path.lexists(folder / RUN_FILE):
            return None
        try:
            return _build_info(run_id, read_run_file(folder))
        except LogError as error:
            if not os.path.lexists(folder / RUN_FILE):
                # Another process has just deleted the run.
                return None
            # The message does not need the path of the file, because the number of the run says where it is.
            summary = error.message.removeprefix(f"{error.file}: ")
        except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
            summary = f"{RUN_FILE} is damaged: {error!r}"
        return RunInfo(0, run_id, "", "", "", "", 0, Unended.DAMAGED, summary=summary)

    def _complete(self, info: RunInfo, most_bytes: int) -> tuple[RunInfo, dict[str, Any], int]:
        """Return a run's catalogue row, completed with data that is read from its folder.

        Args:
            info: The catalogue row.
            most_bytes: Maximum number of bytes of output to read.

        Returns:
            The completed row; those of its columns, by name, that cannot change any more and may be stored in the
                catalogue; and the number of bytes read.
        """
        is_open = info.end in _MAY_CHANGE
        if not is_open and info.samples is not None:
            return info, {}, 0
        folder = self.folder(info.id)
        known = info
        if is_open:
            # `run.json` is written before the catalogue, so it may have an end that the catalogue does not have yet.
            stored = self._read_info(folder)
            state = find_state_without_end(folder)
            if stored is not None and stored.end is Unended.DAMAGED:
                known = replace(info, end=Unended.DAMAGED, summary=stored.summary)
            elif stored is not None and stored.end:
                known = replace(stored, number=info.number)
            elif info.end is state is Unended.INTERRUPTED:
                return info, {}, 0
            else:
                row = (stored if info.end is Unended.DAMAGED else None) or info
                known = replace(row, number=info.number, end=state)
        counted = 0
        try:
            output = OutputView(folder)
            if output.length <= most_bytes:
                known = replace(known, samples=output.count_rows()[1])
                counted = output.length
            if known.end in (Unended.RUNNING, Unended.INTERRUPTED):
                known = _add_last_record(known, folder)
        except LogError as error:
            return replace(known, summary=known.summary or str(error)), {}, counted
        # If this machine cannot find out whether the lock is held, the run may be running.
        if known.end in (Unended.RUNNING, Unended.DAMAGED) or (
            known.end is Unended.INTERRUPTED and is_held(folder) is not False
        ):
            return known, {}, counted
        names = ["end", "ticks", "time_s", "samples", "summary"]
        if info.end is Unended.DAMAGED:
            names += ("created", "program", "background", "profile", "seed", "tags")
        return known, {name: getattr(known, name) for name in names}, counted


def load_run(run: str | Path | int) -> StoredRun:
    """Return a stored run by its number, its id or the start of it, the path of its folder, or `last`.

    Raises:
        LogError: the run does not exist, or is damaged.
    """
    if not isinstance(run, str | Path):
        hint = "its number, its id, `last`, or the path of its folder"
        try:
            # `index` also accepts an integer of NumPy, such as a cell of a frame.
            number = index(run)
        except TypeError:
            raise LogError(f"this names no run: {reprlib.repr(run)}", hint) from None
        if abs(number) > MAX_INTEGER:
            raise LogError("no run has a number as large as this", hint)
        run = str(number)
    return RunStore().load_run(run)


def count_bytes(folder: Path) -> int:
    """Return the total size of a run's files in bytes; files that are deleted during the call are ignored.

    Raises:
        LogError: the folder cannot be read.
    """
    total_bytes = 0
    try:
        with suppress(FileNotFoundError), os.scandir(folder) as entries:
            for entry in entries:
                with suppress(FileNotFoundError):
                    total_bytes += entry.stat().st_size
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(folder)) from error
    return total_bytes


def _match(text: str, rows: Sequence[RunInfo]) -> RunInfo:
    """Return the one row that a text names: by its id or the start of it, by its number, or as `last`.

    Raises:
        LogError: no row matches, or more than one.
    """
    if text == LAST:
        return rows[-1]
    tests = (
        lambda row: row.id == text,
        lambda row: str(row.number) == text,
        lambda row: row.id.startswith(text),
    )
    for matches in tests:
        matching = [row for row in rows if text and matches(row)]
        if len(matching) == 1:
            return matching[0]
        if matching:
            some = ", ".join(row.id for row in matching[:3])
            raise LogError(
                f"{text!r} is the start of {len(matching)} runs: {some}{' …' if len(matching) > 3 else ''}"
            )
    raise LogError(
        f"no run {text!r}", f"a number from {rows[0].number} to {rows[-1].number}, an id, or {LAST}"
    )


def _build_info(run_id: str, data: Mapping[str, Any]) -> RunInfo:
    """Return the catalogue row for the contents of a `run.json`.

    Raises:
        KeyError, TypeError, ValueError: the contents are invalid.
    """
    spec = data["spec"]
    end = data["end"]
    info = RunInfo(
        int(data["number"]),
        run_id,
        str(data["created"]),
        str(data["program"]["name"]),
        str(spec["world"]["background"]),
        str(spec["profile"]["name"]),
        int(spec["seed"]),
        tags=" ".join(data["tags"]),
    )
    if end is None:
        return info
    ticks = int(end["tick"])
    time_s = int(end["time_ns"]) / NS_PER_S
    if ticks > MAX_INTEGER:
        raise ValueError(f"tick is {ticks}")
    return replace(
        info, end=RUN_STATES[end["end"]], ticks=ticks, time_s=time_s, summary=str(end["summary"])
    )


def _copy_files(folder: Path, place: Path) -> None:
    """Copy the files that every run records, except `run.json` and the lock, from a run folder to another folder.

    Links and other files are left out: a link would be followed with the rights of this process, which the program may
    not have had.

    Args:
        folder: The run folder.
        place: The folder that gets the copies.
    """
    import shutil

    for name in (TELEMETRY_FILE, OUTPUT_FILE, *SIDE_FILES):
        try:
            source = open_regular(folder / name)
        except OSError as error:
            if of_the_machine(error):
                raise
            continue
        with source, open(place / name, "xb", opener=private) as target:
            status = os.fstat(source.fileno())
            # A file with holes may seem to be of any size, and its copy would take that size on the disk.
            if status.st_size <= 512 * status.st_blocks + MAX_BYTES:
                shutil.copyfileobj(source, target)


def _delete(folder: Path) -> None:
    """Delete a run folder; if it is a symbolic link, delete only the link."""
    # The folder is renamed first, so that a partly deleted run does not look like a run.
    removed = folder.with_name(f".{folder.name}.{os.urandom(4).hex()}{_REMOVED}")
    os.replace(folder, removed)
    if removed.is_symlink():
        removed.unlink()
        return
    # Another process may find the folder, and delete the rest of it.
    with suppress(FileNotFoundError):
        remove_tree(removed, ignore_errors=False)


def _remove_unfinished(folder: Path) -> None:
    """Remove the folder of a run that a process was creating or deleting when it was killed."""
    is_removed = folder.name.startswith(".") and folder.name.endswith(_REMOVED)
    is_begun = os.path.lexists(folder / RUN_FILE)
    if not folder.is_symlink() and (is_removed or (not is_begun and is_held(folder) is False)):
        remove_tree(folder)


def _read_tags(folder: Path) -> list[str]:
    """Return the tags in the `run.json` of a run that is over; everything else in it may come from the program."""
    try:
        tags = read_run_file(folder).get("tags", ())
    except LogError:
        return []
    return (
        [tag for tag in tags if isinstance(tag, str) and tag.split() == [tag]]
        if isinstance(tags, list)
        else []
    )


def _has_end(folder: Path) -> bool:
    try:
        return read_run_file(folder)["end"] is not None
    except LogError:
        return False


def _add_last_record(info: RunInfo, folder: Path) -> RunInfo:
    last = TelemetryView(folder).last()
    if last is None:
        return replace(info, ticks=0, time_s=0.0)
    try:
        tick_hz = int(read_run_file(folder)["spec"]["profile"]["tick_hz"])
    except (LogError, KeyError, TypeError):
        return replace(info, ticks=last.tick)
    return replace(info, ticks=last.tick, time_s=compute_due_ns(last.tick, tick_hz) / NS_PER_S)
