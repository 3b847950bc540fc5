"""A run folder as data: the contents of `run.json`, the run that it describes, and the mat of the run."""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError, TuisimError, shortened
from tuisim.base.folders import remove_tree
from tuisim.base.regular_file import read_regular
from tuisim.base.source import Program
from tuisim.engine.core.field import Field
from tuisim.engine.core.plugged import PLUGGED_DIAMETER_MM, PluggedPart, plug_parts
from tuisim.engine.core.profile import NS_PER_S, compute_due_ns
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.tree import dump_run, restore
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.mats import background
from tuisim.engine.protocol import End, Ended, RunState, SetNoise, Unended, UserAction
from tuisim.engine.runs.side_files import MAX_BYTES, is_held, read_actions, read_stop_tick
from tuisim.engine.runs.views import OutputView, TelemetryView, TickRecord, open_views

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.core.commands.calls import SimulationCommand

    Array = np.ndarray[Any, Any]

RUN_FILE = "run.json"
RUN_FORMAT = 3
_PROGRAM_KEYS = (
    "name",
    "path",
    "text",
    "sha256",
    "prelude",
    "arguments",
    "python_path",
    "working_directory",
    "module_folder",
    "shown_ports",
)
"""Fields of the program that `run.json` contains, in this order."""

_ACTION_COUNTS = 1 << 16
"""The telemetry counts user actions in 16 bits."""


_Kind = TypeVar("_Kind")
MAX_INTEGER = (1 << 63) - 1
"""Largest integer that the catalogue can store."""
_ANY_END = Ended(End.FINISHED, 0, 0)
_TOLD = frozenset({End.FINISHED, End.RAISED, End.TIME_LIMIT, End.DEADLOCK})
"""Ends that a program's process reports after it has written both recordings."""


@dataclass(frozen=True, slots=True)
class StoredRun:
    """A run that is read from its folder, whether it is over or still running.

    The views `telemetry` and `output` also return what a running run records later.
    """

    folder: Path
    id: str
    number: int
    """Number in the catalogue; 0 if the folder is not listed."""
    created: str
    """Time at which the run was created, as text in ISO 8601, UTC."""
    live: bool
    program: Program
    spec: RunSpec
    """The spec with all parts that were plugged in."""
    first_spec: RunSpec
    """The spec as the run began."""
    plugged: tuple[PluggedPart, ...]
    field: Mapping[str, Any] | None
    """Files of the prepared mat, as written by the host."""
    options: Mapping[str, Any]
    tags: tuple[str, ...]
    end: Ended | None
    """How the run ended; None while it runs, and if it was interrupted."""
    actions: tuple[UserAction, ...]
    notes: tuple[str, ...]
    """Incomplete parts that were ignored, one sentence each."""
    telemetry: TelemetryView
    output: OutputView

    def __repr__(self) -> str:
        number = f" {self.number}" if self.number else ""
        what = f"{self.program.name} under {self.spec.profile.name}"
        summary = f": {self.end.summary}" if self.end and self.end.error else ""
        return f"<run{number} of {what}: {self.state.value} after {format_end(self.time_s)} s{summary}>"

    @property
    def state(self) -> RunState:
        """How the run ended. If its end was not recorded, whether it is still running or was interrupted."""
        if self.end is not None:
            return self.end.end
        return find_state_without_end(self.folder)

    @property
    def time_s(self) -> float:
        """Simulated seconds up to the run's end; without an end, up to its newest tick."""
        if self.end is not None:
            return self.end.time_ns / NS_PER_S
        last = self.telemetry.last()
        return compute_due_ns(last.tick, self.spec.profile.tick_hz) / NS_PER_S if last else 0.0

    def read_commands(self) -> tuple[SimulationCommand, ...]:
        """Return the commands that the program gave to motors, gyro and pen.

        Raises:
            LogError: they are not recorded, or damaged.
        """
        from tuisim.engine.runs.command_records import read_commands

        return tuple(read_commands(self.folder).unpack())

    def read_command_rows(self) -> Array:
        """Return the same commands as rows of `COMMAND_FIELDS`; none if they are not recorded, or damaged."""
        from tuisim.engine.runs.command_records import MAX_COMMANDS, read_command_rows

        return read_command_rows(self.folder, 0, MAX_COMMANDS)

    def read_stop_tick(self) -> int | None:
        """Return the last tick before the user's stop reached the program; None if it is not recorded.

        Raises:
            LogError: its file is damaged.
        """
        return read_stop_tick(self.folder)

    def find_noise(self, record: TickRecord) -> NoiseSpec:
        """Return the noise settings at the tick of a telemetry record."""
        return find_noise(self.spec, self.actions, record)

    def open_mat(self) -> Field:
        """Return the mat of a run, which is prepared again if it is no longer cached.

        Raises:
            LogError: the mat no longer exists, or its image has changed.
        """
        files = self.find_mat_files()
        try:
            return files.open_field(has_floor=self.spec.world.is_open)
        except ConfigError as error:
            raise _build_mat_error(self, error) from error

    def find_mat_files(self) -> FieldFiles:
        """Return the files of the mat that `open_mat` opens; if necessary, they are prepared again.

        Raises:
            LogError: the mat no longer exists, or its image has changed.
        """
        try:
            made_on = None if self.field is None else FieldFiles.from_plain(self.field)
            diameters = {sensor.diameter_mm for sensor in self.spec.robot.color_sensors}
            if made_on is not None and made_on.is_for(diameters) and made_on.are_sound:
                return made_on
            files = field_files(self.spec)
            # The names of the mat's files depend on the contents of its image: another name means another image.
            if made_on is not None and files.pixels.name != made_on.pixels.name:
                name = self.spec.world.background
                raise LogError(
                    f"the mat {name} has changed since the run", file=str(background(name).image)
                )
        except ConfigError as error:
            raise _build_mat_error(self, error) from error
        # In a damaged `run.json` there may be file names that the system refuses.
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError, OSError) as error:
            raise LogError(
                f"the mat of the run is not named: {error}", file=str(self.folder)
            ) from error
        return files


def format_end(time_s: float) -> str:
    """Return as text the time in s at which a run ended, rounded down, because no later tick was reached."""
    return f"{int(time_s * 100 + 1e-6) / 100:.2f}"


def find_state_without_end(folder: Path) -> Unended:
    """Return whether the run in a folder without a stored end is running or was interrupted."""
    return Unended.RUNNING if is_held(folder) else Unended.INTERRUPTED


def restore_program(program: Program, folder: Path) -> Program:
    """Return a stored run's program, changed so that it loads its own modules from their copies in the run folder.

    Args:
        program: The program.
        folder: The folder of the run.
    """
    return replace(program, modules_from=folder)


def find_noise(spec: RunSpec, actions: Sequence[UserAction], record: TickRecord) -> NoiseSpec:
    """Return the noise settings at the tick of a record: those of the spec, as changed by the user's actions.

    Args:
        spec: The run, as it began.
        actions: The user's actions, in the order of their ticks.
        record: The record.
    """
    # The record counts the actions modulo 65536; their ticks resolve the ambiguity.
    due = bisect_right(actions, record.tick, key=lambda action: action.tick)
    offset = (record.actions - due + _ACTION_COUNTS // 2) % _ACTION_COUNTS - _ACTION_COUNTS // 2
    for action in reversed(actions[: max(0, due + offset)]):
        if isinstance(action.command, SetNoise):
            return NoiseSpec(int(action.command.light), int(action.command.motor))
    return spec.world.noise


def build_run_data(
    run_id: str,
    number: int,
    created: str,
    program: Program,
    spec: RunSpec,
    field: Mapping[str, Any] | None,
    options: Mapping[str, Any] | None,
    live: bool,
) -> dict[str, Any]:
    """Return the contents of the `run.json` of a run that is about to start, as data for JSON.

    Args:
        run_id: The id of the run.
        number: Its number in the catalogue.
        created: When the run was created, as text.
        program: The program.
        spec: The specification of the run.
        field: The files of the prepared mat as data for JSON; None if there are none.
        options: The run options as data for JSON; None for no options.
        live: Whether the run is paced by the wall clock.
    """
    return {
        "format": RUN_FORMAT,
        "id": run_id,
        "number": number,
        "created": created,
        "live": live,
        "program": {name: getattr(program, name) for name in _PROGRAM_KEYS},
        "spec": dump_run(spec),
        "plugged": [],
        "field": None if field is None else dict(field),
        "options": dict(options or {}),
        "tags": [],
        "end": None,
    }


def write_run_file(folder: Path, data: Mapping[str, Any]) -> None:
    """Write `run.json` to a run folder, or replace it.

    Raises:
        LogError: it cannot be written.
    """
    path = folder / RUN_FILE
    if path.is_dir() and not path.is_symlink():
        # A folder with the name of this file can only be made by the program: remove it.
        remove_tree(path)
    try:
        with replacing(path, owner_only=True, follow_links=False) as handle:
            handle.write(json.dumps(data, indent=1).encode() + b"\n")
    except OSError as error:
        raise LogError(f"cannot write: {error.strerror or error}", file=str(path)) from error


def read_run_file(folder: Path) -> dict[str, Any]:
    """Return the contents of the `run.json` of a run folder.

    Raises:
        LogError: it is missing, damaged or of another version.
    """
    path = folder / RUN_FILE
    try:
        data = json.loads(read_regular(path, MAX_BYTES))
    except FileNotFoundError as error:
        raise LogError(f"no run here: {RUN_FILE} is missing", file=str(folder)) from error
    except (OSError, ValueError, RecursionError) as error:
        raise LogError(f"cannot be read: {error}", file=str(path)) from error
    if not isinstance(data, dict) or "format" not in data:
        raise LogError("not a run", file=str(path))
    if data["format"] != RUN_FORMAT:
        stored_format = shortened(str(data["format"]))
        raise LogError(
            f"stored by another version of tuisim: format {stored_format}, this one reads {RUN_FORMAT}",
            "run its program again",
            file=str(path),
        )
    return data


def _check_type(value: Any, kind: type[_Kind], name: str) -> _Kind:
    if not isinstance(value, kind) or (isinstance(value, int) and abs(value) > MAX_INTEGER):
        raise TypeError(f"{name} is {value!r}")
    return value


def _restore_spec(plain: Mapping[str, Any]) -> RunSpec:
    """Return the spec in the contents of a `run.json`.

    Raises:
        ValueError: one of its numbers is out of range.
    """
    spec = restore(plain)
    if not 1 <= spec.profile.tick_hz <= NS_PER_S:
        raise ValueError(f"the tick rate cannot be {spec.profile.tick_hz}")
    # The seed is not checked, because it may be any whole number.
    parts = [plain[name] for name in ("robot", "world", "profile")]
    while parts:
        part = parts.pop()
        if isinstance(part, dict | list):
            parts += part.values() if isinstance(part, dict) else part
        elif isinstance(part, int | float) and not abs(part) <= MAX_INTEGER:
            raise ValueError(f"{part} is out of range")
    return spec


def add_plugged(spec: RunSpec, parts: Sequence[PluggedPart]) -> RunSpec:
    """Return a run's spec with plugged-in parts added to its robot."""
    return replace(spec, robot=plug_parts(spec.robot, parts)) if parts else spec


def _parse_program(plain: Mapping[str, Any]) -> Program:
    """Return the program in the contents of a `run.json`."""
    texts = ("name", "path", "text", "prelude", "working_directory", "module_folder")
    fields: dict[str, Any] = {key: _check_type(plain[key], str, key) for key in texts}
    lists = ["arguments", "python_path"]
    lists += ["shown_ports"] if plain["shown_ports"] is not None else []
    for key in lists:
        fields[key] = tuple(
            _check_type(word, str, key) for word in _check_type(plain[key], list, key)
        )
    return Program(**fields)


def _check_options(data: Mapping[str, Any]) -> None:
    options = _check_type(data["options"], dict, "options")
    for answer in _check_type(options.get("answers", []), list, "answers"):
        _check_type(answer, str, "an answer")


def _parse_end(data: Mapping[str, Any]) -> Ended:
    kinds = {field.name: type(getattr(_ANY_END, field.name)) for field in fields(Ended)}
    known = {**data, "end": End(data["end"])}
    return Ended(
        **{name: _check_type(value, kinds.get(name, object), name) for name, value in known.items()}
    )


def read_run(folder: Path) -> StoredRun:
    """Return the run in a folder.

    Raises:
        LogError: there is no run in the folder, or it is damaged.
    """
    data = read_run_file(folder)
    try:
        program = _parse_program(data["program"])
        spec = _restore_spec(data["spec"])
        plugged = map(PluggedPart.from_plain, _check_type(data["plugged"], list, "plugged"))
        end = None if data["end"] is None else _parse_end(data["end"])
        _check_options(data)
        return open_run(folder, data, program, spec, tuple(plugged), end)
    except LogError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError, TuisimError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise LogError(f"damaged: {shortened(what)}", file=str(folder / RUN_FILE)) from error


def open_run(
    folder: Path,
    data: Mapping[str, Any],
    program: Program,
    first_spec: RunSpec,
    plugged: tuple[PluggedPart, ...],
    end: Ended | None,
) -> StoredRun:
    """Return the run in a folder, of which the parts are known that `run.json` contains.

    Args:
        folder: The run folder.
        data: The contents of its `run.json`.
        program: The program in it.
        first_spec: The spec in it.
        plugged: The parts in it that were plugged in.
        end: The end in it; None if there is none.

    Raises:
        LogError: a recording cannot be read.
        TypeError: one of the other contents is damaged.
    """
    # If one recording of a falsified run is damaged, the other one, the program and the world can still be read.
    is_falsified = end is not None and end.end is End.FALSIFIED
    telemetry, output = open_views(folder, is_falsified)
    try:
        actions, cut = read_actions(folder)
    except LogError as error:
        actions = ()
        cut = f"{error.message}: the user's actions are ignored"
    lost = [_read_recording(view, end) for view in (telemetry, output)]
    # The recording of a run that has ended does not change any more.
    telemetry.holds = output.holds = end is not None
    return StoredRun(
        folder=folder,
        id=_check_type(data["id"], str, "id"),
        number=int(data["number"]),
        created=_check_type(data["created"], str, "created"),
        live=bool(data["live"]),
        program=program,
        spec=add_plugged(first_spec, plugged),
        first_spec=first_spec,
        plugged=plugged,
        field=_check_type(data["field"] or {}, dict, "field") or None,
        options=data["options"],
        tags=tuple(_check_type(tag, str, "a tag") for tag in data["tags"]),
        end=end,
        actions=actions,
        notes=tuple(filter(None, (*lost, cut))),
        telemetry=telemetry,
        output=output,
    )


def _read_recording(view: TelemetryView | OutputView, end: Ended | None) -> str:
    """Read a recording once, and return a text that says what is damaged or missing in it; empty if nothing is.

    Args:
        view: The recording. After this call it does not read more of its file by itself.
        end: The end of the run, which tells whether records are missing; None if it has not ended.
    """
    view.hold()
    if note := view.note:
        return note
    if end is None or end.end not in _TOLD:
        return ""
    if view.is_missing:
        return f"{view.name} is missing"
    if isinstance(view, TelemetryView) and view.count <= end.tick:
        return f"{view.name} has {view.count} of {end.tick + 1} records"
    return ""


def field_files(spec: RunSpec) -> FieldFiles:
    """Return the files of a run's mat, prepared for its robot's sensors; files that are not cached are prepared now.

    Raises:
        BackgroundError: the mat does not exist, or its image cannot be read.
    """
    image = background(spec.world.background).image
    return FieldFiles.prepare(image, find_diameters(spec), fit=spec.world.background_fit)


def find_diameters(spec: RunSpec) -> frozenset[int]:
    """Return the diameters in mm of the discs of the mat that a run's colour sensors see.

    Sensors that may be plugged in during the run are included.
    """
    sensors = spec.robot.color_sensors
    return frozenset({PLUGGED_DIAMETER_MM, *(sensor.diameter_mm for sensor in sensors)})


def _build_mat_error(run: StoredRun, error: ConfigError) -> LogError:
    return LogError(f"the mat of the run: {error.message}", error.hint, file=str(run.folder))
