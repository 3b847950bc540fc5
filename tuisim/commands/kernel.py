"""`tuisim kernel`: installs, lists and removes the Jupyter kernel that runs a course's notebooks unchanged."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

from tuisim.atomic import replacing
from tuisim.commands.echo import echo, echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.options import SwitchParser, nearest
from tuisim.errors import ConfigError

if TYPE_CHECKING:
    from jupyter_client.kernelspec import KernelSpecManager

KERNEL_NAME = "tuisim"
DISPLAY_NAME = "RoboLab (tuisim)"
EXTENSION = "tuisim.notebook.kernel"

_SPEC_FILE = "kernel.json"
_VALID_NAME = re.compile(r"[a-z0-9_-][a-z0-9._-]*")


class Action(StrEnum):
    """The actions of `tuisim kernel`."""

    LIST = "list"
    INSTALL = "install"
    REMOVE = "remove"


@dataclass(frozen=True, slots=True)
class InstalledKernel:
    """An installed tuisim kernel."""

    name: str
    display_name: str
    python: str
    """The path of its interpreter."""
    folder: str


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim kernel`."""
    parser.usage = (
        "tuisim kernel [list] [--json]\n"
        "       tuisim kernel install [--user|--sys-prefix|--prefix P] [--name N]\n"
        "       tuisim kernel remove [--user|--sys-prefix|--prefix P] [--name N]"
    )
    parser.description = (
        f"Install the kernel {DISPLAY_NAME!r} in Jupyter. It has every magic and the modules that a course's cells\n"
        "import, so notebooks run unchanged."
    )
    parser.add_argument("action", nargs="?", default=Action.LIST, metavar="|".join(Action), help="what to do")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--user", action="store_true", help="for this user (the default)")
    where.add_argument("--sys-prefix", action="store_true", help="in the Python environment of tuisim")
    where.add_argument("--prefix", metavar="P", help="in P/share/jupyter/kernels")
    parser.add_argument("--name", metavar="N", help=f"name of the kernel in Jupyter ({KERNEL_NAME})")
    parser.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: Namespace) -> int:
    """Run the action.

    Raises:
        ConfigError: no such action, ipykernel is missing, or a kernel cannot be written or found.
    """
    if arguments.action not in tuple(Action):
        raise ConfigError(f"no such action {arguments.action!r}", nearest(arguments.action, Action), key="kernel")
    action, name = Action(arguments.action), arguments.name
    if arguments.json and action is not Action.LIST:
        raise ConfigError("is for `list` only", "leave it out", key="--json")
    if name is not None and not _VALID_NAME.fullmatch(name):
        raise ConfigError(f"may contain only lower-case letters, digits and . _ -, got {name!r}", key="--name")
    manager = _manager()
    folder = _folder_of(manager, arguments)
    folders = manager.kernel_dirs if folder is None else [folder]
    match action:
        case Action.LIST:
            _list([kernel for kernel in _kernels(folders) if name in (None, kernel.name)], as_json=arguments.json)
        case Action.INSTALL:
            _install(manager, Path(folder or manager.user_kernel_dir), name or KERNEL_NAME)
        case Action.REMOVE:
            _remove(folders, name or KERNEL_NAME)
        case _:
            assert_never(action)
    return 0


def _manager() -> KernelSpecManager:
    """Return Jupyter's manager of kernel folders.

    Raises:
        ConfigError: ipykernel is not installed.
    """
    try:
        # The kernel itself.
        import ipykernel  # noqa: F401
        from jupyter_client.kernelspec import KernelSpecManager
    except ModuleNotFoundError as error:
        hint = "pip install 'tuisim[notebook]'"
        raise ConfigError(f"the kernel needs {error.name}, which is not installed", hint) from None
    return KernelSpecManager()


def _folder_of(manager: KernelSpecManager, arguments: Namespace) -> str | None:
    """Return the kernel folder chosen by the switches, None if none is chosen."""
    prefix = sys.prefix if arguments.sys_prefix else arguments.prefix
    if prefix is not None:
        return str(Path(os.path.abspath(os.path.expanduser(prefix)), "share", "jupyter", "kernels"))
    return str(manager.user_kernel_dir) if arguments.user else None


def _kernels(folders: Sequence[str]) -> Iterator[InstalledKernel]:
    """Yield the tuisim kernels in these kernel folders."""
    for folder in dict.fromkeys(folders):
        for file in sorted(Path(folder).glob(f"*/{_SPEC_FILE}")):
            spec = _read(file)
            if spec is not None:
                yield InstalledKernel(file.parent.name, spec["display_name"], spec["argv"][0], str(file.parent))


def _read(file: Path) -> dict[str, Any] | None:
    """Return the kernel spec in a file, None if it is not a tuisim kernel's."""
    try:
        spec = json.loads(file.read_bytes())
        ours = EXTENSION in spec["argv"] and isinstance(spec["display_name"], str)
    # Other programs write here, so the file may hold anything.
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return dict(spec) if ours else None


def _list(kernels: Sequence[InstalledKernel], *, as_json: bool) -> None:
    if as_json:
        echo_json([asdict(kernel) for kernel in kernels])
    elif not kernels:
        echo("no tuisim kernel is installed; `tuisim kernel install` adds one")
    else:
        rows = [
            (k.name, k.display_name, k.python + ("" if Path(k.python).exists() else " (missing)"), k.folder)
            for k in kernels
        ]
        echo_lines(table(("NAME", "KERNEL", "PYTHON", "FOLDER"), rows))


def _install(manager: KernelSpecManager, place: Path, name: str) -> None:
    from ipykernel.kernelspec import get_kernel_dict

    folder = place / name
    file = folder / _SPEC_FILE
    if file.exists() and _read(file) is None:
        raise ConfigError(f"{name!r} already names another kernel, in {folder}", "choose another name", key="--name")
    # As in ipykernel's own spec: the debugger cannot step into frozen modules.
    spec = get_kernel_dict(extra_arguments=["--ext", EXTENSION], python_arguments=["-Xfrozen_modules=off"])
    spec["display_name"] = DISPLAY_NAME
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with replacing(file) as content:
            content.write(json.dumps(spec, indent=1).encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(file)) from None
    echo(f"kernel {DISPLAY_NAME!r} installed in {folder}")
    if str(place) not in manager.kernel_dirs:
        echo(f"Jupyter finds it there with JUPYTER_PATH={place.parent}, or if installed below {place.parents[2]}")


def _remove(places: Sequence[str], name: str) -> None:
    found = [kernel for kernel in _kernels(places) if kernel.name == name]
    if not found:
        hint = "see `tuisim kernel list`" if len(places) > 1 else f"looked in {places[0]}"
        raise ConfigError(f"no tuisim kernel {name!r} is installed", hint, key="--name")
    # Only the first, which Jupyter starts; others of that name come later on its path.
    folder = Path(found[0].folder)
    try:
        folder.unlink() if folder.is_symlink() else shutil.rmtree(folder)
    except OSError as error:
        raise ConfigError(f"cannot be removed: {error.strerror or error}", file=str(folder)) from None
    echo(f"kernel {name!r} removed from {folder}")
