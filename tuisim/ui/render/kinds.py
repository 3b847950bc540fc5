"""What drawings are made of."""

from __future__ import annotations

from typing import TypeAlias

from rich.style import Style

from tuisim.robotpaint import Rgb as Rgb

Run: TypeAlias = tuple[str, Style]
"""A piece of a line in one style."""

Line: TypeAlias = list[Run]
"""A line of text."""
