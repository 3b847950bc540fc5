"""The colours that the app shares with charts as text, and with texts of tasks; `app/design.py` has the others."""

from __future__ import annotations

BLACK = "#101010"
FIELD = "#1c2733"
HERE = "#263545"
LINE = "#44505e"
SOFT = "#9fb0c3"
LABEL = "#a8a8a8"
INK = "#d8dee6"
WHITE = "#ffffff"
BLUE = "#5fafff"
"""For headings and what has the focus."""
GREEN = "#87d7af"
"""For good results."""
YELLOW = "#ffd75f"
"""For what is chosen, and for what the user should notice."""
LINK = "#87afff"
