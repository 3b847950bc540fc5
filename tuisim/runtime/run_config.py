"""The run's configuration, read from its folder."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path

from tuisim.config.mat_cache import FieldFiles
from tuisim.core.spec import RunSpec
from tuisim.core.tree import from_plain
from tuisim.protocol import UserAction
from tuisim.runtime import wallclock


@dataclass(frozen=True, slots=True)
class RunConfig:
    """The part of `run.json` that the child needs."""

    folder: Path
    """The run folder."""
    spec: RunSpec
    field: FieldFiles
    name: str
    path: str
    text: str
    prelude: str
    arguments: tuple[str, ...]
    python_path: tuple[str, ...]
    module_folder: str
    live: bool
    speed: float
    start_paused: bool
    time_limit_s: float
    stall_limit_s: float
    answers: tuple[str, ...]
    asks_user: bool
    time_waits: bool
    replies: bool
    actions: tuple[UserAction, ...]
    breaks: tuple[str, ...]
    trace_from_tick: int | None
    hold_at: tuple[int, int] | None

    @property
    def own_folder(self) -> str:
        """Folder of the program's own modules: that of its file, or the configured one, or the working directory."""
        return self.module_folder or os.path.dirname(wallclock.absolute(self.path or self.name))

    @property
    def debugged(self) -> bool:
        """Whether the debugger is needed from the first line on."""
        return bool(self.breaks) or self.trace_from_tick is not None or self.hold_at is not None


def read_config(folder: Path) -> RunConfig:
    """Read `run.json`.

    Raises:
        OSError, ValueError, KeyError, TypeError: the host has not prepared the folder.
    """
    data = json.loads((folder / "run.json").read_text("utf-8"))
    program, options = data["program"], data["options"]
    return RunConfig(
        folder=folder,
        spec=from_plain(data["spec"]),
        field=FieldFiles.from_plain(data["field"]),
        name=program["name"],
        path=program["path"],
        text=program["text"],
        prelude=program["prelude"],
        arguments=tuple(program["arguments"]),
        python_path=tuple(program["python_path"]),
        module_folder=program["module_folder"],
        live=options["live"],
        speed=options["speed"],
        start_paused=options["start_paused"],
        time_limit_s=options["time_limit_s"],
        stall_limit_s=options["stall_limit_s"],
        answers=tuple(options["answers"]),
        asks_user=options["asks_user"],
        time_waits=options["time_waits"],
        replies=options["replies"],
        actions=tuple(UserAction.from_plain(row) for row in options["actions"]),
        breaks=tuple(options["breaks"]),
        trace_from_tick=options["trace_from_tick"],
        hold_at=None if options["hold_at"] is None else (int(options["hold_at"][0]), int(options["hold_at"][1])),
    )
