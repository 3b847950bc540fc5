"""The folder of the user's own data: runs, notes, drafts, mats."""

from __future__ import annotations

import os
from pathlib import Path


def home_folder() -> Path:
    """Return the folder of the user's own data: `TUISIM_HOME`, or the platform's user data folder."""
    home = os.environ.get("TUISIM_HOME")
    if home:
        return Path(home)
    import platformdirs

    return platformdirs.user_data_path("tuisim")
