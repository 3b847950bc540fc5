"""The drawing scripts are no package: they are imported by their own names, as when they run."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "backgrounds"))
