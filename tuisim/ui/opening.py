"""What to run when the user opens a program or lays out a mat in the app."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.core.spec import RunSpec
from tuisim.host import Program

_OF_THE_MAT = frozenset({"background", "background_fit", "obstacles", "x_mm", "y_mm", "heading_deg"})


def _kept(spec: RunSpec) -> dict[str, Any]:
    """The settings that stay as they are when the world changes."""
    from tuisim.config import settings_from

    return {key: value for key, value in settings_from(spec).items() if key not in _OF_THE_MAT}


def with_mat(spec: RunSpec, name: str) -> RunSpec:
    """Return a run on another mat, with its start pose, its obstacles and its sensor places.

    Raises:
        BackgroundError: there is no such mat.
    """
    from tuisim.config import build_run_spec
    from tuisim.switches import settings_of

    return build_run_spec(settings_of(_kept(spec), {"background": name}))


def open_program(path: str, spec: RunSpec) -> tuple[Program, RunSpec]:
    """Read a program; its magic line's switches apply, what it leaves open stays as in `spec`.

    Raises:
        ConfigError: the file cannot be read, or its magic line is wrong.
    """
    from tuisim.config import build_run_spec
    from tuisim.programfile import read_program
    from tuisim.switches import settings_of

    file = read_program(Path(path).expanduser())
    program = Program(name=file.name, text=file.text, prelude=file.prelude, path=file.path)
    mat = {"background": spec.world.background, "background_fit": spec.world.background_fit}
    if "background" not in file.switches and not {"x_mm", "y_mm", "heading_deg"} & file.switches.keys():
        given = {key: value for key, value in file.switches.items() if key != "autorun"}
        asked = build_run_spec(settings_of(_kept(spec), mat, given))
        return program, replace(asked, world=replace(asked.world, start=spec.world.start))
    return program, build_run_spec(settings_of(_kept(spec), mat, file.switches))
