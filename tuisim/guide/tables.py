"""The reference tables: where a page says `<!-- table: NAME -->`, the table is made from the code when it is read.

To add a table: write a function that returns a `Table`, and add a line to `TABLES`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from importlib import import_module
from typing import cast

from tuisim.base.data_class import dataclass
from tuisim.guide.catalogue import Page

TABLES: Mapping[str, str] = {
    "keys": "app.guide.key_tables:app_keys",
    "editor-keys": "app.guide.key_tables:editor_keys",
    "analyser-keys": "app.guide.key_tables:analyser_keys",
    "panels": "app.guide.key_tables:panels",
    "commands": "guide.command_tables:commands",
    "command-options": "guide.command_tables:command_options",
    "options": "guide.code_tables:options",
    "settings": "guide.code_tables:settings",
    "profile-rules": "guide.code_tables:profile_rules",
    "drift": "guide.code_tables:drift",
    "breakpoints": "guide.code_tables:breakpoints",
    "columns": "guide.code_tables:columns",
    "samples": "guide.code_tables:samples",
    "telemetry": "guide.code_tables:telemetry",
    "formats": "guide.code_tables:formats",
    "pybricks-motors": "guide.pybricks_tables:motors",
    "pybricks-drive-bases": "guide.pybricks_tables:drive_bases",
}
"""MODULE:FUNCTION by name, imported on use: some load the app."""

_MARK = re.compile(r"^<!-- table: ([\w-]+) -->$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Table:
    """A table of Markdown cells."""

    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    def markdown(self) -> str:
        """Return the table as Markdown."""
        lines = [self.columns, ("---",) * len(self.columns), *self.rows]
        return "\n".join(
            "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines
        )


def code(text: str) -> str:
    """Return a text as a cell in the type of code."""
    return f"`{text}`" if text else ""


@cache
def table(name: str) -> Table:
    """Make a table.

    Args:
        name: One of `TABLES`.
    """
    module, _, function = TABLES[name].partition(":")
    return cast("Callable[[], Table]", getattr(import_module(f"tuisim.{module}"), function))()


def markdown_of(page: Page) -> str:
    """Return the whole page with its title and its tables."""
    made = _MARK.sub(lambda found: table(found[1]).markdown(), page.source)
    return f"# {page.title}\n\n{made}"
