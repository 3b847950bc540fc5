"""The folder of all that is the user's own: runs, notes, drafts, mats."""

from __future__ import annotations

import os
from pathlib import Path


def home_folder() -> Path:
    """Return where runs are kept: `TUISIM_HOME`, or the user's data folder."""
    home = os.environ.get("TUISIM_HOME")
    if home:
        return Path(home)
    import platformdirs

    return platformdirs.user_data_path("tuisim")
