"""A robot lab in the terminal: ev3dev2 programs on a simulated LEGO EV3 robot, in virtual time.

The public names load their modules when they are first used, so that `import tuisim` is cheap.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell

    from tuisim.api.face import Robot, World, experiment, simulate
    from tuisim.api.lab import Lab
    from tuisim.api.logs import read_log
    from tuisim.api.marks import mark
    from tuisim.api.run import load_run, runs

__version__ = "1.0.0"
__all__ = [
    "Lab",
    "Robot",
    "World",
    "__version__",
    "experiment",
    "load_ipython_extension",
    "load_run",
    "mark",
    "read_log",
    "runs",
    "simulate",
]

_HOMES = {
    "Lab": "tuisim.api.lab",
    "Robot": "tuisim.api.face",
    "World": "tuisim.api.face",
    "experiment": "tuisim.api.face",
    "load_run": "tuisim.api.run",
    "mark": "tuisim.api.marks",
    "read_log": "tuisim.api.logs",
    "runs": "tuisim.api.run",
    "simulate": "tuisim.api.face",
}


if not TYPE_CHECKING:  # With `__getattr__`, mypy would accept a misspelt name.

    def __getattr__(name: str) -> Any:
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(import_module(_HOMES[name]), name)


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Add the magics, `roboSim` and `eds` to a notebook; `%load_ext tuisim` calls this function."""
    from tuisim.notebook.kernel import tell_old_simulator
    from tuisim.notebook.magics import install

    tell_old_simulator()
    install(shell)


def __dir__() -> list[str]:
    return __all__
