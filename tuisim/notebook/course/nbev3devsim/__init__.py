"""The extension that `%load_ext nbev3devsim` loads, unless the old simulator is installed."""

from tuisim import load_ipython_extension

__all__ = ["load_ipython_extension"]
