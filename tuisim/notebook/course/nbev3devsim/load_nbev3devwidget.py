"""The simulator and its log, as the first cell of a course's notebook imports them, and the progress bar `tqdma`."""

from typing import Any

from tuisim.notebook import eds, roboSim

__all__ = ["eds", "roboSim"]


def __getattr__(name: str) -> Any:
    # The bar is imported only by cells that use it, as this takes long.
    if name == "tqdma":
        from tuisim.notebook.progress_bar import SoundedBar

        return SoundedBar
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
