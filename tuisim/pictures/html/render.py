"""Pages of HTML that need nothing else, made from the templates beside this module."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from tuisim.base.data_class import dataclass
from tuisim.pictures.charts.files import replace_invalid

_TEMPLATES = Path(__file__).parent / "templates"


@dataclass(frozen=True, slots=True)
class Table:
    """A table of texts with column headings on a page; a table without rows is not shown."""

    heads: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: int
    """Columns from this index on are right-aligned."""


def render_page(template: str, **values: Any) -> str:
    """Return an HTML page, filled in from a template.

    Args:
        template: The name of a file in `templates`.
        values: The values in the template, by name. Every text is escaped, and characters that are invalid in HTML
            become U+FFFD.
    """
    return replace_invalid(_load_templates().get_template(template).render(values))


@cache
def _load_templates() -> Environment:
    return Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
