"""The guide as static HTML: a file for each page, and one with the contents; nothing is loaded from elsewhere."""

from __future__ import annotations

import re
from html import escape
from pathlib import Path

from markdown_it import MarkdownIt

from tuisim import palette
from tuisim.atomic import replacing
from tuisim.errors import ExportError
from tuisim.guide.catalogue import CONTENTS, Page, pages
from tuisim.guide.tables import markdown_of

_STYLE = """\
body { margin: 0 auto; max-width: 75rem; display: flex; gap: 2rem; padding: 1rem; line-height: 1.5;
       font-family: system-ui, sans-serif; color: var(--ink); background: var(--paper); }
nav { flex: 0 0 15rem; font-size: .9rem; } nav ul { list-style: none; padding: 0; }
nav [aria-current] { font-weight: bold; } main { flex: 1; min-width: 0; }
code, pre { font-family: ui-monospace, monospace; background: var(--area); border-radius: 3px; }
code { padding: 0 .2em; }
pre { padding: .7em; overflow-x: auto; } pre code { padding: 0; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
td, th { border: 1px solid var(--rule); padding: .2em .5em; text-align: left; vertical-align: top; }
a { color: var(--link); }
@media (max-width: 50rem) { body { flex-direction: column; } }
"""
_PAGE_LINK = re.compile(r'href="([\w-]+)\.md"')
INDEX = "index.html"


def write_html(folder: Path, version: str) -> list[Path]:
    """Write the guide into a folder, which is made if it does not exist; return the files.

    Args:
        folder: Where to write.
        version: The version of tuisim that the pages describe.

    Raises:
        ExportError: a file cannot be written.
    """
    texts = {INDEX: _document("The guide of tuisim", _index_body(), "", version)}
    texts |= {
        f"{name}.html": _document(page.title, _body(page), name, version)
        for name, page in pages().items()
    }
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            with replacing(folder / name) as file:
                file.write(text.encode())
            written.append(folder / name)
    except OSError as error:
        raise ExportError(
            f"cannot write {folder}: {error.strerror or error}", "name another folder"
        ) from error
    return written


def _body(page: Page) -> str:
    rendered: str = (
        MarkdownIt("commonmark", {"html": False})
        .enable("table")
        .render(markdown_of(page, for_others=True))
    )
    return _PAGE_LINK.sub(r'href="\1.html"', rendered)


def _index_body() -> str:
    parts = ["<h1>The guide of tuisim</h1>"]
    for part, names in CONTENTS.items():
        rows = "".join(
            f"<li>{_link(pages()[name])}: {_inline(pages()[name].about)}</li>\n" for name in names
        )
        parts.append(f"<h2>{part}</h2>\n<ul>\n{rows}</ul>")
    return "\n".join(parts)


def _inline(text: str) -> str:
    rendered: str = MarkdownIt("commonmark").renderInline(text)
    return rendered


def _link(page: Page, current: str = "") -> str:
    mark = ' aria-current="page"' if page.name == current else ""
    return f'<a href="{page.name}.html"{mark}>{escape(page.title)}</a>'


def _document(title: str, body: str, current: str, version: str) -> str:
    parts = "\n".join(
        f"<p>{part}</p>\n<ul>\n{''.join(f'<li>{_link(pages()[name], current)}</li>' for name in names)}\n</ul>"
        for part, names in CONTENTS.items()
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)} – tuisim</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<style>\n{palette.PAGE}{_STYLE}</style>\n</head>\n"
        f'<body>\n<nav>\n<p><a href="{INDEX}">tuisim {version}</a></p>\n{parts}\n</nav>\n'
        f"<main>\n{body}\n</main>\n</body>\n</html>\n"
    )
