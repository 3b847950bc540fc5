"""The modules that a course's cells import, and the extension of the Jupyter kernel `RoboLab (tuisim)`.

`tuisim kernel install` adds the kernel. It is IPython's own, started with `--ext tuisim.notebook.kernel`.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

OLD_NAMES = Path(__file__).with_name("course")
"""Folder with the modules that a course's cells import.

An installation puts it last on `sys.path`, so that the old simulator wins where that is installed; this kernel puts it
first.
"""


def find_old_simulator() -> Path | None:
    """Return the file of the old simulator nbev3devsim if a cell that imports this name would get it instead of tuisim.

    Otherwise the result is None.
    """
    # `find_spec` raises ValueError for a module without a spec, which a notebook may have put there.
    with suppress(ValueError):
        spec = find_spec("nbev3devsim")
        if spec is not None and spec.origin is not None:
            file = Path(spec.origin)
            return None if file.is_relative_to(OLD_NAMES) else file
    return None


def tell_old_simulator() -> None:
    """Print a warning if a cell's `import nbev3devsim` imports the old simulator instead of tuisim's."""
    if find_old_simulator() is not None:
        print(
            "tuisim: note: nbev3devsim is the old simulator here, and tuisim in the kernel RoboLab (tuisim)",
            file=sys.stderr,
        )


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Add the modules and magics of a course to IPython, so that the course's cells run unchanged."""
    from tuisim.notebook.magics import install

    # The folder goes to the front of the path, so that an installed old simulator is not imported.
    sys.path.insert(0, str(OLD_NAMES))
    install(shell)
