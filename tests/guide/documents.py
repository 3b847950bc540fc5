"""README and the pages of the guide as documents, and what stands in them as code."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tuisim.guide.catalogue import load_pages
from tuisim.guide.tables import build_markdown

_FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_NAME = re.compile(r"# ([\w-]+\.\w+)\n")
NARROW_PAGE_COLUMNS = 74
"""The columns of a page in a terminal of 80 columns."""


@dataclass(frozen=True)
class Block:
    """A block of code."""

    kind: str
    """What stands behind the opening fence, such as `sh`."""
    code: str

    @property
    def file(self) -> str:
        """The name of the file that the block is, from its first line; empty if it has none."""
        found = _NAME.match(self.code)
        return found[1] if found else ""

    def commands(self) -> Iterator[list[str]]:
        """The words of each command."""
        for line in self.code.replace("\\\n", " ").splitlines():
            if words := shlex.split(line, comments=True):
                yield words


DOCUMENTS = {"README": (ROOT / "README.md").read_text(encoding="utf-8")} | {
    name: build_markdown(page) for name, page in load_pages().items()
}
"""The texts by name."""


def blocks(name: str) -> list[Block]:
    """The blocks of a document, in their order."""
    return [Block(kind, code) for kind, code in _FENCE.findall(DOCUMENTS[name])]


def commands_in_text(name: str) -> list[str]:
    """What stands in a document between backticks and begins with the command."""
    text = _FENCE.sub("", DOCUMENTS[name])
    return list(re.findall(r"`(tuisim(?: [^`\n]+)?)`", text.replace("\\|", "|")))


def program(name: str, where: Path) -> None:
    """Copy an example."""
    (where / name).write_text(
        (ROOT / "programs" / name).read_text(encoding="utf-8"), encoding="utf-8"
    )
