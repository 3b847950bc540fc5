"""`tuisim kernel`: the Jupyter kernel in which the notebooks of a course run as they are."""

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
    """What there is to do."""

    LIST = "list"
    INSTALL = "install"
    REMOVE = "remove"


@dataclass(frozen=True, slots=True)
class InstalledKernel:
    """One of our kernels, as Jupyter finds it."""

    name: str
    display_name: str
    python: str
    """The interpreter that runs it."""
    folder: str


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim kernel`."""
    parser.usage = (
        "tuisim kernel [list] [--json]\n"
        "       tuisim kernel install [--user|--sys-prefix|--prefix P] [--name N]\n"
        "       tuisim kernel remove [--user|--sys-prefix|--prefix P] [--name N]"
    )
    parser.description = (
        f"Add the kernel {DISPLAY_NAME!r} to Jupyter: every magic is there, and the modules that a course's cells\n"
        "import mean tuisim, so that no cell needs to be changed."
    )
    parser.add_argument("action", nargs="?", default=Action.LIST, metavar="|".join(Action), help="what to do")
    place = parser.add_mutually_exclusive_group()
    place.add_argument("--user", action="store_true", help="for this user (unless said otherwise)")
    place.add_argument("--sys-prefix", action="store_true", help="for the Python environment that tuisim is in")
    place.add_argument("--prefix", metavar="P", help="in P/share/jupyter/kernels")
    parser.add_argument("--name", metavar="N", help=f"how Jupyter calls the kernel ({KERNEL_NAME})")
    parser.add_argument("--json", action="store_true", help="as JSON")


def execute(arguments: Namespace) -> int:
    """Do what `action` says.

    Raises:
        ConfigError: no such action, ipykernel is missing, or a kernel cannot be written or found.
    """
    if arguments.action not in tuple(Action):
        raise ConfigError(f"no such action {arguments.action!r}", nearest(arguments.action, Action), key="kernel")
    action, name = Action(arguments.action), arguments.name
    if arguments.json and action is not Action.LIST:
        raise ConfigError("only the list can be JSON", "leave it out", key="--json")
    if name is not None and not _VALID_NAME.fullmatch(name):
        raise ConfigError(f"may have small letters, digits and . _ - only, got {name!r}", key="--name")
    manager = _manager()
    place = _place(manager, arguments)
    looked = manager.kernel_dirs if place is None else [place]
    match action:
        case Action.LIST:
            _list([kernel for kernel in _kernels(looked) if name in (None, kernel.name)], as_json=arguments.json)
        case Action.INSTALL:
            _install(manager, Path(place or manager.user_kernel_dir), name or KERNEL_NAME)
        case Action.REMOVE:
            _remove(looked, name or KERNEL_NAME)
        case _:
            assert_never(action)
    return 0


def _manager() -> KernelSpecManager:
    """What knows Jupyter's folders.

    Raises:
        ConfigError: ipykernel is not installed.
    """
    try:
        # Without it there would be nothing to start.
        import ipykernel  # noqa: F401
        from jupyter_client.kernelspec import KernelSpecManager
    except ModuleNotFoundError as error:
        hint = "pip install 'tuisim[notebook]'"
        raise ConfigError(f"the kernel needs {error.name}, which is not installed", hint) from None
    return KernelSpecManager()


def _place(manager: KernelSpecManager, arguments: Namespace) -> str | None:
    """The folder of kernels that the switches mean, None if they say nothing."""
    prefix = sys.prefix if arguments.sys_prefix else arguments.prefix
    if prefix is not None:
        return str(Path(os.path.abspath(os.path.expanduser(prefix)), "share", "jupyter", "kernels"))
    return str(manager.user_kernel_dir) if arguments.user else None


def _kernels(folders: Sequence[str]) -> Iterator[InstalledKernel]:
    """Yield those of our kernels that are in folders of kernels."""
    for folder in dict.fromkeys(folders):
        for file in sorted(Path(folder).glob(f"*/{_SPEC_FILE}")):
            spec = _read(file)
            if spec is not None:
                yield InstalledKernel(file.parent.name, spec["display_name"], spec["argv"][0], str(file.parent))


def _read(file: Path) -> dict[str, Any] | None:
    """Return what describes one of our kernels, None if a file is not ours."""
    try:
        spec = json.loads(file.read_bytes())
        ours = EXTENSION in spec["argv"] and isinstance(spec["display_name"], str)
    # Others write into these folders too, whatever they like.
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return dict(spec) if ours else None


def _list(kernels: Sequence[InstalledKernel], *, as_json: bool) -> None:
    if as_json:
        echo_json([asdict(kernel) for kernel in kernels])
    elif not kernels:
        echo("no kernel of tuisim is installed; `tuisim kernel install` adds one")
    else:
        rows = [
            (k.name, k.display_name, k.python + ("" if Path(k.python).exists() else " (is gone)"), k.folder)
            for k in kernels
        ]
        echo_lines(table(("NAME", "KERNEL", "PYTHON", "FOLDER"), rows))


def _install(manager: KernelSpecManager, place: Path, name: str) -> None:
    from ipykernel.kernelspec import get_kernel_dict

    folder = place / name
    file = folder / _SPEC_FILE
    if file.exists() and _read(file) is None:
        raise ConfigError(f"{name!r} is another kernel already, in {folder}", "choose another name", key="--name")
    # As ipykernel installs its own: the debugger cannot look into frozen modules.
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
        echo(f"Jupyter looks there with JUPYTER_PATH={place.parent}, or if it is installed below {place.parents[2]}")


def _remove(places: Sequence[str], name: str) -> None:
    found = [kernel for kernel in _kernels(places) if kernel.name == name]
    if not found:
        hint = "see `tuisim kernel list`" if len(places) > 1 else f"looked in {places[0]}"
        raise ConfigError(f"no kernel {name!r} of tuisim is installed", hint, key="--name")
    # The one that Jupyter starts; another one of that name, in a place that comes later, is next.
    folder = Path(found[0].folder)
    try:
        folder.unlink() if folder.is_symlink() else shutil.rmtree(folder)
    except OSError as error:
        raise ConfigError(f"cannot be removed: {error.strerror or error}", file=str(folder)) from None
    echo(f"kernel {name!r} removed from {folder}")
