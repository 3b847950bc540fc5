"""`tuisim kernel`: installs, lists and removes the Jupyter kernel that runs a course's notebooks unchanged."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from glob import escape, glob
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import user_path
from tuisim.commands.echo import AS_JSON, draw_table, echo, echo_json, echo_lines
from tuisim.settings.command_line import Group, command, option

if TYPE_CHECKING:
    from jupyter_client.kernelspec import KernelSpecManager

KERNEL_NAME = "tuisim"
DISPLAY_NAME = "RoboLab (tuisim)"
EXTENSION = "tuisim.notebook.kernel"

_SPEC_FILE = "kernel.json"
_VALID_NAME = re.compile(r"[a-z0-9_-][a-z0-9._-]*")


@dataclass(frozen=True, slots=True)
class InstalledKernel:
    """A tuisim kernel that is installed in Jupyter: its names, its Python, and its folder."""

    name: str
    display_name: str
    python: str
    """The path of the Python interpreter that runs the kernel."""
    folder: str


_WHERE = (
    option("--user", is_flag=True, help="In the user's kernel folder (the default for install)."),
    option("--sys-prefix", is_flag=True, help="In the Python environment of tuisim."),
    option("--prefix", metavar="P", help="In P/share/jupyter/kernels."),
    option("--name", metavar="N", help=f"Name of the kernel in Jupyter ({KERNEL_NAME})."),
)


@command(*_WHERE, AS_JSON, name="list")
def list_kernels(as_json: bool, **where: Any) -> int:
    """List the tuisim kernels that Jupyter finds."""
    manager, folder, name = _place(**where)
    folders = manager.kernel_dirs if folder is None else [folder]
    _list(
        [kernel for kernel in _iterate_kernels(folders) if name in (None, kernel.name)],
        as_json=as_json,
    )
    return 0


@command(*_WHERE)
def install(**where: Any) -> int:
    """Add the kernel to Jupyter."""
    manager, folder, name = _place(**where)
    _install(manager, Path(folder or manager.user_kernel_dir), name or KERNEL_NAME)
    return 0


@command(*_WHERE)
def remove(**where: Any) -> int:
    """Remove a tuisim kernel from Jupyter."""
    manager, folder, name = _place(**where)
    _remove(manager.kernel_dirs if folder is None else [folder], name or KERNEL_NAME)
    return 0


kernel = Group.of(
    "kernel",
    (list_kernels, install, remove),
    default="list",
    help=f"""Install the kernel {DISPLAY_NAME!r} in Jupyter.

    It provides all the magics and the modules that a course's cells import, so notebooks run unchanged.
    """,
)


def _place(
    user: bool, sys_prefix: bool, prefix: str | None, name: str | None
) -> tuple[KernelSpecManager, str | None, str | None]:
    """Return where a kernel is to be installed: Jupyter's manager of kernels, the chosen folder, and the chosen name.

    Folder and name are None if the user has chosen none.
    """
    options = {"--user": user, "--sys-prefix": sys_prefix, "--prefix": prefix is not None}
    places = [flag for flag, is_given in options.items() if is_given]
    if len(places) > 1:
        raise ConfigError(f"name one of {' and '.join(places)}", key="kernel")
    if name is not None and not _VALID_NAME.fullmatch(name):
        raise ConfigError(
            f"may contain only lower-case letters, digits and . _ -, got {name!r}", key="--name"
        )
    manager = _build_manager()
    where = sys.prefix if sys_prefix else prefix
    if where is not None:
        return (
            manager,
            str(Path(os.path.abspath(user_path(where)), "share", "jupyter", "kernels")),
            name,
        )
    return manager, str(manager.user_kernel_dir) if user else None, name


def _build_manager() -> KernelSpecManager:
    try:
        # The import only checks that ipykernel is there, which the installed kernel needs.
        import ipykernel  # noqa: F401
        from jupyter_client.kernelspec import KernelSpecManager
    except ModuleNotFoundError as error:
        hint = "pip install 'tuisim[notebook]'"
        raise ConfigError(f"the kernel needs {error.name}, which is not installed", hint) from None
    return KernelSpecManager()


def _iterate_kernels(folders: Sequence[str]) -> Iterator[InstalledKernel]:
    for folder in dict.fromkeys(folders):
        for file in map(Path, sorted(glob(f"{escape(folder)}/*/{_SPEC_FILE}"))):
            spec = _read(file)
            if spec is not None:
                yield InstalledKernel(
                    file.parent.name, spec["display_name"], spec["argv"][0], str(file.parent)
                )


def _read(file: Path) -> dict[str, Any] | None:
    """Return the kernel spec in a JSON file; None if the file cannot be read, or the kernel is not one of tuisim."""
    try:
        spec = json.loads(file.read_bytes())
        ours = EXTENSION in spec["argv"] and isinstance(spec["display_name"], str)
    # Other programs write files here, too, so the contents may be of any form.
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
            (
                k.name,
                k.display_name,
                k.python + ("" if os.path.exists(k.python) else " (missing)"),
                k.folder,
            )
            for k in kernels
        ]
        echo_lines(draw_table(("NAME", "KERNEL", "PYTHON", "FOLDER"), rows))


def _install(manager: KernelSpecManager, place: Path, name: str) -> None:
    from ipykernel.kernelspec import get_kernel_dict

    folder = place / name
    file = folder / _SPEC_FILE
    if os.path.exists(file) and _read(file) is None:
        raise ConfigError(
            f"{name!r} is already the name of another kernel, in {folder}",
            "choose another name",
            key="--name",
        )
    # Frozen modules are off, as in ipykernel's own spec, since the debugger cannot step into them.
    spec = get_kernel_dict(
        extra_arguments=["--ext", EXTENSION], python_arguments=["-Xfrozen_modules=off"]
    )
    spec["display_name"] = DISPLAY_NAME
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with replacing(file) as content:
            content.write(json.dumps(spec, indent=1).encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(file)) from None
    echo(f"kernel {DISPLAY_NAME!r} installed in {folder}")
    if str(place) not in manager.kernel_dirs:
        echo(
            f"Jupyter finds it there with JUPYTER_PATH={place.parent}, or if installed below {place.parents[2]}"
        )


def _remove(places: Sequence[str], name: str) -> None:
    kernels = [kernel for kernel in _iterate_kernels(places) if kernel.name == name]
    if not kernels:
        hint = "see `tuisim kernel list`" if len(places) > 1 else f"looked in {places[0]}"
        raise ConfigError(f"no tuisim kernel {name!r} is installed", hint, key="--name")
    # Only the first kernel of a name is removed, which is the one that Jupyter starts.
    folder = Path(kernels[0].folder)
    try:
        folder.unlink() if folder.is_symlink() else shutil.rmtree(folder)
    except OSError as error:
        raise ConfigError(
            f"cannot be removed: {error.strerror or error}", file=str(folder)
        ) from None
    echo(f"kernel {name!r} removed from {folder}")
