"""The terminal kit: everything between an app of Textual and a terminal. It knows nothing of robots.

`__all__` names the modules that the rest of the project may import; each says what it is for. They are imported one by
one, so that what needs the names of options does not load Textual.
"""

__all__ = [
    "app",
    "cell_image",
    "cell_view",
    "cells",
    "pacer",
    "picture",
    "picture_mode",
    "picture_options",
    "pixels",
    "probe",
    "text_runs",
    "textual_internals",
]
