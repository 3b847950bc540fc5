"""Self-contained HTML pages: style, sections and tables."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.charts.files import clean

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2329; --soft: #5c6670; --paper: #fff; --rule: #d5dade; --area: #f4f6f8; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #d8dee6; --soft: #9aa6b2; --paper: #14191f; --rule: #38424d; --area: #1c242c; }
}
* { box-sizing: border-box; }
body { margin: 2rem auto; padding: 0 1rem; max-width: 62rem; color: var(--ink); background: var(--paper);
  font: 16px/1.45 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; border-bottom: 1px solid var(--rule); break-after: avoid; }
h3 { font-size: 1rem; margin: 1rem 0 .3rem; break-after: avoid; }
p { margin: .4rem 0; }
figcaption, .soft { color: var(--soft); font-size: .9rem; }
figure { margin: .5rem 0; break-inside: avoid; }
img, svg { display: block; max-width: 100%; height: auto; }
img { border: 1px solid var(--rule); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--rule); }
th { font-weight: 600; color: var(--soft); }
tr { break-inside: avoid; }
.number { text-align: right; white-space: nowrap; overflow-wrap: normal; }
.name { white-space: nowrap; overflow-wrap: normal; }
pre, .code { font: .85rem/1.4 ui-monospace, monospace; background: var(--area); }
pre { padding: .5rem; white-space: pre-wrap; }
.code { width: 100%; }
.code td { border: 0; padding: 0 .6rem; white-space: pre-wrap; }
.code .number { width: 1%; color: var(--soft); border-right: 1px solid var(--rule); user-select: none; }
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --paper: #fff; --rule: #bbb; --area: #fff; }
  body { margin: 0; padding: 0; max-width: none; font-size: 10pt; }
  .wide { overflow: visible; }
}
"""


def page(title: str, body: Sequence[str]) -> str:
    """Return a complete page; `body` is HTML, the title is text."""
    return "\n".join((
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{clean(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>",
        *body,
        "</body>\n</html>\n",
    ))  # fmt: skip


def section(title: str, *parts: str) -> str:
    """Return a section of a page without its empty parts; empty if all are."""
    filled = [part for part in parts if part]
    return "\n".join((f"<section>\n<h2>{clean(title)}</h2>", *filled, "</section>")) if filled else ""


def paragraph(text: str, *, soft: bool = False) -> str:
    """Return a text as a paragraph."""
    return f"<p{_class('soft' if soft else '')}>{clean(text)}</p>"


def _class(name: str) -> str:
    return f' class="{name}"' if name else ""


def table(heads: Sequence[str], rows: Sequence[Sequence[str]], numbers: int) -> str:
    """Return rows of text as a table, empty if there are none.

    Args:
        heads: The column headings.
        rows: The cells.
        numbers: Index of the first right-aligned column.
    """
    if not rows:
        return ""

    def line(kind: str, cells: Sequence[str]) -> str:
        classes = ("number" if at >= numbers else "name" if kind == "th" else "" for at in range(len(cells)))
        parts = zip(cells, classes, strict=True)
        return "".join(f"<{kind}{_class(name)}>{clean(cell)}</{kind}>" for cell, name in parts)

    lines = [f"<tr>{line('td', row)}</tr>" for row in rows]
    head = f"<thead><tr>{line('th', heads)}</tr></thead>"
    return "\n".join((f'<div class="wide"><table>\n{head}\n<tbody>', *lines, "</tbody></table></div>"))


def facts(rows: Sequence[Sequence[str]]) -> str:
    """Return a table whose first column holds the names of the rows."""
    lines = ("".join(f"<td>{clean(cell)}</td>" for cell in cells) for _, *cells in rows)
    heads = (f'<th class="name" scope="row">{clean(row[0])}</th>' for row in rows)
    return "\n".join((
        '<div class="wide"><table><tbody>',
        *(f"<tr>{head}{cells}</tr>" for head, cells in zip(heads, lines, strict=True)),
        "</tbody></table></div>",
    ))  # fmt: skip


def code(lines: Sequence[str]) -> str:
    """Return the lines of a program with their numbers."""
    rows = (f'<tr><td class="number">{at}</td><td>{clean(line) or " "}</td></tr>' for at, line in enumerate(lines, 1))
    return "\n".join(('<table class="code"><tbody>', *rows, "</tbody></table>"))
