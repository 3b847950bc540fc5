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
    "keys": "app.guide.key_tables:list_app_keys",
    "editor-keys": "app.guide.key_tables:list_editor_keys",
    "analyser-keys": "app.guide.key_tables:list_analyser_keys",
    "panels": "app.guide.key_tables:list_panels",
    "commands": "guide.command_tables:list_commands",
    "command-options": "guide.command_tables:list_command_options",
    "options": "guide.code_tables:list_options",
    "settings": "guide.code_tables:list_settings",
    "profile-rules": "guide.code_tables:list_profile_rules",
    "drift": "guide.code_tables:list_drift_sizes",
    "breakpoints": "guide.code_tables:list_breakpoints",
    "columns": "guide.code_tables:list_columns",
    "samples": "guide.code_tables:list_sample_columns",
    "telemetry": "guide.code_tables:list_telemetry_columns",
    "formats": "guide.code_tables:list_formats",
    "pybricks-motors": "guide.pybricks_tables:list_motors",
    "pybricks-drive-bases": "guide.pybricks_tables:list_drive_bases",
}
"""The function that returns each table of the guide, as MODULE:FUNCTION, by the table's name; modules are imported on
use, as some load the app.
"""

_MARK = re.compile(r"^<!-- table: ([\w-]+) -->$", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Table:
    """A table of the guide, whose cells are Markdown."""

    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    def to_markdown(self) -> str:
        """Return the table as Markdown."""
        lines = [self.columns, ("---",) * len(self.columns), *self.rows]
        return "\n".join(
            "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines
        )


def code(text: str) -> str:
    """Return a text as a Markdown cell that shows it as code."""
    return f"`{text}`" if text else ""


@cache
def load_table(name: str) -> Table:
    """Return a table of the guide, which a function builds.

    Args:
        name: One of `TABLES`.
    """
    module, _, function = TABLES[name].partition(":")
    return cast("Callable[[], Table]", getattr(import_module(f"tuisim.{module}"), function))()


def build_markdown(page: Page) -> str:
    """Return a page of the guide as Markdown, with its title and its tables."""
    body = _MARK.sub(lambda mark: load_table(mark[1]).to_markdown(), page.source)
    return f"# {page.title}\n\n{body}"
