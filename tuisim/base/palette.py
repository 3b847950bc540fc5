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
"""The colour of headings and of the focus."""
GREEN = "#87d7af"
"""The colour of good results."""
YELLOW = "#ffd75f"
"""The colour of the selection and of warnings."""
LINK = "#87afff"
