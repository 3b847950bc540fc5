"""The extension of the Jupyter kernel `RoboLab (tuisim)`: the magics, under the names of the old simulator, too.

`tuisim kernel install` adds the kernel. It is IPython's own, started with `--ext tuisim.notebook.kernel`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

OLD_NAMES = Path(__file__).with_name("course")
"""Folder with the modules that a course's cells import. Only this kernel adds it to `sys.path`."""


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Provide the modules and magics of a course, so that its cells run unchanged."""
    from tuisim.notebook.magics import install

    # First, so that these modules win over the old simulator where that is installed.
    sys.path.insert(0, str(OLD_NAMES))
    install(shell)
