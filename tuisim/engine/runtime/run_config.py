"""The run's configuration, read from its folder."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import programs_folder
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.tree import put_all, restore
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.runs.run_options import RunOptions
from tuisim.engine.runtime import wallclock


@dataclass(frozen=True, slots=True)
class RunConfig:
    """The part of a run's `run.json` that its child process needs."""

    folder: Path
    """The run folder."""
    program: Program
    spec: RunSpec
    field: FieldFiles
    options: RunOptions

    @property
    def own_folder(self) -> str:
        """Folder of the program's own modules: the configured one, or else the folder of the program's file."""
        program = self.program
        return program.module_folder or os.path.dirname(wallclock.absolute(program.file))

    @property
    def starts_in_own_folder(self) -> bool:
        """Whether the program starts in its own folder, not in the user's working directory.

        It depends on the profile. An example never starts in its own folder, because the files that it writes are for
        the user.
        """
        program = self.program
        if not self.spec.profile.starts_in_own_folder or not (
            program.path or program.module_folder
        ):
            return False
        try:
            return Path(self.own_folder) != programs_folder()
        except ConfigError:
            # An isolated process does not see the examples.
            return True

    @property
    def debugged(self) -> bool:
        """Whether the debugger is needed from the program's first line on."""
        options = self.options
        return (
            bool(options.breaks)
            or options.trace_from_tick is not None
            or options.hold_at is not None
        )


def read_config(folder: Path) -> RunConfig:
    """Return the configuration in the `run.json` of a run folder.

    Raises:
        OSError, ValueError, KeyError, TypeError: the host has not prepared the folder.
    """
    return parse_config(folder, json.loads((folder / "run.json").read_text("utf-8")))


def parse_config(folder: Path, data: Mapping[str, Any]) -> RunConfig:
    """Return the configuration in the contents of a `run.json`.

    Raises:
        ValueError, KeyError, TypeError: the contents are not valid.
    """
    return RunConfig(
        folder=folder,
        program=_parse_program(data["program"]),
        spec=restore(data["spec"]),
        field=FieldFiles.from_plain(data["field"]),
        options=RunOptions.from_plain(data["options"]),
    )


def derive_config(last: RunConfig, folder: Path, changes: Mapping[str, Any]) -> RunConfig:
    """Return the configuration of another run of the same robot in the same world.

    Args:
        last: The configuration of the run before.
        folder: The run folder.
        changes: What is different, as the host sends it; see `tuisim.engine.runs.child.warm.Template`.
    """
    values = {path: of(changes[name]) for name, (path, of) in _VALUES.items() if name in changes}
    return replace(
        last,
        folder=folder,
        program=_parse_program(changes["program"]) if "program" in changes else last.program,
        spec=put_all(last.spec, values) if values else last.spec,
        options=RunOptions.from_plain(changes["options"]) if "options" in changes else last.options,
    )


_VALUES: dict[str, tuple[str, Callable[[Any], object]]] = {
    "seed": ("seed", int),
    "noise": ("world.noise", lambda plain: NoiseSpec(**plain)),
    "start": ("world.start", lambda plain: Pose(**plain)),
}
"""Values of a spec in which runs may differ, by their names in `changes`: path, and function that builds them."""


def _parse_program(plain: Mapping[str, Any]) -> Program:
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in plain.items()
    }
    # It follows from the text.
    del values["sha256"]
    return Program(**values)
