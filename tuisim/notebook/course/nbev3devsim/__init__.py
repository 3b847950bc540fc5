"""The extension that `%load_ext nbev3devsim` loads in the kernel `RoboLab (tuisim)`."""

from tuisim import load_ipython_extension

__all__ = ["load_ipython_extension"]
