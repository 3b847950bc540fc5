"""The Python API: `simulate` runs a program and returns its results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.config.build import build_run_spec
from tuisim.config.options import APP, OPTIONS, Option, settings_of
from tuisim.config.program_file import ProgramSource, program_of_text, read_program
from tuisim.errors import ConfigError, nearest
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.records import Stream
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore

if TYPE_CHECKING:
    import pandas as pd
    from PIL.Image import Image


@dataclass(frozen=True, slots=True)
class SimulatedRun:
    """A finished run."""

    stored: StoredRun
    """The run in the run store."""

    @property
    def state(self) -> str:
        """How it ended: finished, raised, stopped, time_limit …"""
        return self.stored.state.value

    @property
    def error(self) -> str:
        """The program's own traceback, empty if there is none."""
        return self.stored.end.error if self.stored.end else ""

    @property
    def time_s(self) -> float:
        """Its duration in simulated seconds."""
        return self.stored.time_s

    @property
    def output(self) -> str:
        """The program's output on stdout."""
        return "".join(row.text + "\n" for row in self.stored.output.rows() if row.stream == Stream.STDOUT)

    @property
    def samples(self) -> pd.DataFrame:
        """One row per printed `NAME: number`; columns as in `runs.frames.SAMPLE_COLUMNS`."""
        from tuisim.runs.frames import samples_frame

        return samples_frame([self.stored])

    @property
    def telemetry(self) -> pd.DataFrame:
        """One row per tick; times in s, lengths in mm, angles in degrees."""
        from tuisim.runs.frames import telemetry_frame

        return telemetry_frame(self.stored)

    def picture(self) -> Image:
        """Return the world at the end of the run, with the pen's trace, as a Pillow image."""
        from tuisim.charts.world_image import world_at_end

        return world_at_end(self.stored)


def _by_name() -> dict[str, Option]:
    """Return every option that affects a run, by its long names."""
    return {
        flag.lstrip("-").replace("-", "_"): option
        for option in OPTIONS
        if not option.panel and option.group != APP
        for flag in option.flags
        if flag.startswith("--")
    }


def choices_of(choices: Mapping[str, Any]) -> dict[str, Any]:
    """Convert keyword arguments to fields of `Settings`.

    Args:
        choices: Values by the long name of an option, such as `background` or `x`; None is ignored.

    Raises:
        ConfigError: there is no such option, or its value is wrong.
    """
    known, found = _by_name(), {}
    for name, value in choices.items():
        if name not in known:
            raise ConfigError(f"no such argument {name!r}", nearest(name, known))
        option = known[name]
        if value is None:
            continue
        if option.convert is None:
            if not isinstance(value, bool):
                raise ConfigError(f"must be True or False, got {value!r}", key=name)
            found[option.field] = option.value if value else not option.value
        else:
            text = ("on" if value else "off") if isinstance(value, bool) else str(value)
            found[option.field] = option.convert(text, name)
    return found


def _source(program: str | Path) -> ProgramSource:
    if isinstance(program, str) and "\n" in program:
        return program_of_text(program, None, "program")
    path = Path(program)
    if path.parent == Path() and not path.exists():
        from tuisim.config.folders import programs_folder

        for name in (path.name, f"{path.name}.py"):
            if (example := programs_folder() / name).is_file():
                return read_program(example)
    return read_program(path)


def simulate(
    program: str | Path,
    *,
    arguments: Sequence[str] = (),
    answers: tuple[str, ...] = (),
    timeout_s: float = 600.0,
    **choices: Any,
) -> SimulatedRun:
    """Run a program as fast as possible, block until it ends, and return its results.

    An exception in the program is not raised here: see `state` and `error`.

    Args:
        program: A file, the name of an example, or source text of several lines.
        arguments: The program's `sys.argv[1:]`.
        answers: The return values of successive `input()` calls.
        timeout_s: Limit in simulated seconds.
        choices: Switches by their long names: `background="Grey_bands", x=100, seed=7`.

    Raises:
        ConfigError: the program, its magic line or a choice is wrong; nothing was run.
        KeyboardInterrupt: ctrl-C; the run has been stopped, and its log is stored.
    """
    if not timeout_s > 0:
        raise ConfigError(f"must be above 0, got {timeout_s!r}", key="timeout_s")
    source = _source(program)
    settings = settings_of(source.options, choices_of(choices))
    prelude = settings.preload or source.program.prelude
    started = replace(source.program, prelude=prelude, arguments=tuple(arguments))
    store = RunStore()
    options = RunOptions(time_limit_s=timeout_s, answers=tuple(answers))
    handle = start_run(started, build_run_spec(settings), options, store)
    try:
        handle.wait()
    finally:
        handle.close()
    return SimulatedRun(handle.stored())
