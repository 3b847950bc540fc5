"""Imported early in the child: start-up creates only permanent objects, so garbage collection would waste time.

The collector is enabled again right before the program's first line.
"""

from __future__ import annotations

import gc

gc.disable()
