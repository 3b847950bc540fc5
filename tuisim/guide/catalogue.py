"""The pages of the guide, in their order.

To add a page: write `pages/NAME.md`, and add its name to `CONTENTS`. A page begins with TOML between two lines `+++`:
`about`, a sentence for the contents, and `words`, further words by which the search finds it.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from enum import StrEnum
from functools import cache
from pathlib import Path

from tuisim.base.data_class import dataclass

_HEADING = re.compile(r"^## (.+)$", re.MULTILINE)

_PAGES = Path(__file__).resolve().parent / "pages"
_PARTS = re.compile(
    r"\A\+\+\+\n(?P<head>.*?)\n\+\+\+\n\n# (?P<title>[^\n]+)\n(?P<text>.*)\Z", re.DOTALL
)
LINK = re.compile(r"\[([^\[\]]+)\]\(([\w-]+)\.md\)")
"""Matches a link to another page in Markdown; the groups are the link's text and the page's name."""


class GuidePart(StrEnum):
    """The parts of the guide, by the purpose of their pages."""

    TUTORIAL = "Tutorials"
    HOW_TO = "How to …"
    REFERENCE = "Reference"
    EXPLANATION = "Explanations"
    PROJECT = "The project"


CONTENTS: Mapping[GuidePart, tuple[str, ...]] = {
    GuidePart.TUTORIAL: ("first-steps", "measuring-bands"),
    GuidePart.HOW_TO: (
        "writing-programs",
        "real-programs",
        "pybricks",
        "lessons",
        "stepping",
        "going-back",
        "analysing-logs",
        "exporting-data",
        "pictures-and-movies",
        "notebooks",
        "in-a-browser",
        "working-over-ssh",
        "own-mats",
        "marking",
        "experiments",
        "python",
        "when-it-goes-wrong",
    ),
    GuidePart.REFERENCE: (
        "keys",
        "commands",
        "options",
        "settings",
        "breakpoints",
        "profile-rules",
        "data-columns",
        "world-files",
        "goal-files",
        "the-brick",
        "device-files",
        "library-differences",
        "ev3dev2-and-pybricks",
    ),
    GuidePart.EXPLANATION: (
        "virtual-time",
        "how-sensors-see",
        "motion-and-drift",
        "the-real-robot",
        "other-simulators",
    ),
    GuidePart.PROJECT: ("contributing", "architecture", "security", "licences"),
}
"""The names of all pages of the guide in their order, by part."""


@dataclass(frozen=True, slots=True)
class Page:
    """A page of the guide."""

    name: str
    part: GuidePart
    title: str
    about: str
    """A sentence that says what the page is about, for the guide's table of contents."""
    words: str
    """Further words by which the search finds the page, separated by blanks."""
    source: str
    """The page's Markdown below its title, with marks in place of the tables that are made from the code."""

    def list_headings(self) -> list[str]:
        """Return the headings of the sections of a page, as readers see them."""
        return [heading.replace("`", "") for heading in _HEADING.findall(self.source)]

    def list_links(self) -> list[str]:
        """Return the names of the pages that a page links to, in the order of the links."""
        return list(dict.fromkeys(link[2] for link in LINK.finditer(self.source)))


@cache
def load_pages() -> Mapping[str, Page]:
    """Return all pages of the guide by name, in their order."""
    return {name: _read_page(name, part) for part, names in CONTENTS.items() for name in names}


def _read_page(name: str, part: GuidePart) -> Page:
    match = _PARTS.match((_PAGES / f"{name}.md").read_text(encoding="utf-8"))
    assert match is not None, name
    head = tomllib.loads(match["head"])
    return Page(name, part, match["title"], head["about"], head["words"], match["text"].strip("\n"))
