"""Imported early in the child: a start-up makes only things that stay, so looking for garbage is lost time.

The collector is switched on again right before the program's own first line.
"""

from __future__ import annotations

import gc

gc.disable()
