"""What `%load_ext nbev3devsim` means in the kernel `RoboLab (tuisim)`."""

from tuisim import load_ipython_extension

__all__ = ["load_ipython_extension"]
