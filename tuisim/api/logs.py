"""`read_log`, which refuses a misspelt keyword as the other calls do."""

from __future__ import annotations

from tuisim.api.keywords import check_keywords
from tuisim.logs import frames

read_log = check_keywords(frames.read_log)
