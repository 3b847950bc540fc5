"""The rooms of the package in their order, their doors, and the contracts of imports that follow from both."""

from __future__ import annotations

import ast
import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import Any

from tests.sources import ROOT, Source

ROOMS = (
    "__main__",
    "cli",
    "commands",
    "env",
    "notebook | app | api",
    "web",
    "guide",
    "batch",
    "tasks",
    "analysis",
    "pictures",
    "logs",
    "programs",
    "settings",
    "engine",
    "base | terminal",
)
"""Each imports what is below it; what is side by side does not know each other."""
PARTS_OF_ENGINE = (
    "runtime",
    "shim",
    "runs",
    "mats",
    "mat_cache | obstacles",
    "mat_image | files",
    "protocol | breakpoints | brick_home",
    "core",
)
"""The same inside the engine."""
CHILD = ("engine.runtime", "engine.shim")
"""What runs in the process of a program."""
ONLY_IN_PARENT = (
    "terminal",
    *(f"engine.runs.{name}" for name in ("handle", "recorded_run", "replay_debugger")),
    "engine.runs.child.process",
)
PURE = (
    *("engine.core", "engine.protocol", "engine.breakpoints"),
    *(f"base.{name}" for name in ("atomic", "data_class", "errors", "regular_file", "source")),
)
"""What has only Python's own library."""
LIBRARIES = (
    *("numpy", "pandas", "pyarrow", "PIL", "plotext", "textual", "platformdirs", "msgspec"),
    "ev3dev2",
)
STARTS_APP = (
    "commands.app -> tuisim.app.**",
    "commands.app -> tuisim.terminal.probe",
    "commands.system.user_config -> tuisim.app.actions.keys",
    "commands.system.doctor -> tuisim.terminal.*",
)
"""The commands that start the app, and the one that asks the terminal what the app would ask."""
OPEN = ("__main__", "api", "base", "cli", "commands", "engine", "env", "notebook")
"""Rooms without a door: others may import any of their modules."""


def list_rooms(but: Collection[str] = ()) -> list[str]:
    return [name for row in ROOMS for name in row.split(" | ") if name not in but]


def _forbidden(
    name: str, sources: Iterable[str], modules: Iterable[str], **more: object
) -> dict[str, object]:
    """Return a contract that some modules of the package do not import others."""
    return {
        "name": name,
        "type": "forbidden",
        "source_modules": _in_package(sources),
        "forbidden_modules": list(modules),
        **more,
    }


def _in_package(names: Iterable[str]) -> list[str]:
    return [f"tuisim.{name}" for name in names]


def _contracts() -> list[dict[str, object]]:
    inside = sorted((ROOT / "tuisim" / "app").iterdir())
    parts_of_app = [path.stem for path in inside if path.suffix in ("", ".py")]
    return [
        {
            "name": "Rooms import what is below them",
            "type": "layers",
            "containers": ["tuisim"],
            "layers": ROOMS,
            "exhaustive": True,
        },
        {
            "name": "Parts of the engine import what is below them",
            "type": "layers",
            "containers": ["tuisim.engine"],
            "layers": PARTS_OF_ENGINE,
            "exhaustive": True,
        },
        _forbidden(
            "The parent side does not import the child side",
            [*list_rooms(but=("engine", "base", "terminal")), "engine.runs"],
            _in_package(CHILD),
        ),
        _forbidden(
            "The child side does not import the parent side", CHILD, _in_package(ONLY_IN_PARENT)
        ),
        _forbidden(
            "Headless code does not import the app",
            list_rooms(but=("__main__", "cli", "app", "terminal")),
            ["tuisim.app", "textual"],
            ignore_imports=_in_package(STARTS_APP),
        ),
        _forbidden(
            "Arrow is reached through the logs",
            list_rooms(but=("logs",)),
            ["pyarrow"],
            allow_indirect_imports=True,
        ),
        _forbidden(
            "The parts of the app do not import the app that is made of them",
            (f"app.{name}" for name in parts_of_app if name[0] != "_" and name != "app"),
            ["tuisim.app.app"],
        ),
        _forbidden("Drawing knows no Textual", ["app.render", "pictures.scene"], ["textual"]),
        _forbidden("The simulation is pure: standard library only", PURE, LIBRARIES),
    ]


def write_contracts() -> str:
    """Return the contracts as a file for import-linter."""
    head = {"root_packages": ["tuisim"], "include_external_packages": True}
    tables: list[tuple[str, Mapping[str, Any]]] = [("[tool.importlinter]", head)]
    tables += [("[[tool.importlinter.contracts]]", contract) for contract in _contracts()]
    lines = []
    for heading, table in tables:
        lines += [heading, *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    return "\n".join([*lines, ""])


@cache
def door_of(room: str) -> tuple[str, ...]:
    """The modules of a room that others may import, from its `__all__`."""
    return tuple(import_module(f"tuisim.{room}").__all__)


def entered(source: Source) -> Iterator[tuple[str, str]]:
    """Yield each room with a door that a file enters from outside, and the module there."""
    own = source.path.relative_to(ROOT / "tuisim").parts[0].removesuffix(".py")
    for node in source.nodes:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tuisim."):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                _, room, *path = (inner if _is_module(inner) else str(node.module)).split(".")
                if room != own and room not in OPEN:
                    yield room, ".".join(path)


def _is_module(name: str) -> bool:
    path = ROOT.joinpath(*name.split("."))
    return path.with_suffix(".py").is_file() or path.is_dir()
