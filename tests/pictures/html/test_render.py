"""Pages from templates: no text of a program becomes HTML, and no value is forgotten."""

from __future__ import annotations

from typing import Any

import pytest
from jinja2 import UndefinedError

from tests.analysis.test_report import Page
from tuisim.pictures.html.render import Table, render_page

EVIL = "<script>alert('1')</script> &amp; \x1b[31m \ud83d"
SHOWN = "<script>alert('1')</script> &amp; \ufffd[31m \ufffd"
VALUES: dict[str, Any] = {
    "title": EVIL,
    "remark": EVIL,
    "facts": [(EVIL, EVIL)],
    "errors": [EVIL],
    "goals": Table((EVIL, "points"), [(EVIL, EVIL)], 1),
    "reasons": [EVIL],
    "pictures": [],
    "movies": [],
    "chart": {"svg": "<svg></svg>", "is_shaded": True, "not_drawn": EVIL},
    "bands": {"words": [EVIL], "table": Table((EVIL,), [], 1), "glossary": [EVIL], "more": 1234},
    "statistics": {"table": Table((EVIL,), [], 1), "more": 0},
    "notes": Table((EVIL,), [(EVIL,)], 1),
    "reading_notes": [EVIL],
    "programs": [(EVIL, [EVIL, ""])],
}


def test_each_text_in_an_html_report_is_escaped_and_shown_whole() -> None:
    page = Page(render_page("report.html", **VALUES))
    assert "script" not in page.tags
    assert page.section["Facts"] == [SHOWN] * 3
    assert page.section["Goals"] == [SHOWN, "points", SHOWN, SHOWN]
    assert page.section["Where it went wrong"] == [SHOWN]
    assert page.section["Chart"][-1] == f"Not drawn: {SHOWN}"
    assert page.section["Bands"] == [SHOWN, SHOWN, "and 1,234 more"]
    assert page.section[f"Program {SHOWN}"] == ["1", SHOWN, "2"]


def test_an_html_reports_section_without_content_is_left_out() -> None:
    assert not {"World", "Statistics"} & {*Page(render_page("report.html", **VALUES)).section}


def test_rendering_an_html_report_without_one_of_its_values_raises() -> None:
    without = {name: value for name, value in VALUES.items() if name != "facts"}
    with pytest.raises(UndefinedError, match="facts"):
        render_page("report.html", **without)
