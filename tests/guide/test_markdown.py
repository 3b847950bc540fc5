"""Tables of Markdown in a given width."""

from __future__ import annotations

import pytest

from tuisim.guide.catalogue import load_pages
from tuisim.guide.markdown import render_markdown
from tuisim.guide.text import draw_page

TABLE = """
| to | ev3dev2 | Pybricks |
| --- | --- | --- |
| ask the gyro | `gyro = GyroSensor(INPUT_4); gyro.angle` | `gyro = GyroSensor(Port.S4)` |
"""


def _texts(width: int) -> list[str]:
    return ["".join(part for part, _ in line).rstrip() for line in render_markdown(TABLE, width)]


def test_a_guides_table_cell_breaks_between_words() -> None:
    texts = _texts(66)
    assert max(map(len, texts)) <= 66
    words = " ".join(texts).split()
    assert {"GyroSensor(INPUT_4);", "gyro.angle", "GyroSensor(Port.S4)"} <= {*words}
    assert any(
        text.split()[:3] == ["ask", "the", "gyro"] and len(text.split()) > 3 for text in texts
    )


def test_a_table_too_narrow_for_its_words_is_drawn_as_lists() -> None:
    assert [text for text in _texts(46) if text] == [
        "ask the gyro",
        "  ev3dev2: gyro = GyroSensor(INPUT_4);",
        "  gyro.angle",
        "  Pybricks: gyro = GyroSensor(Port.S4)",
    ]


@pytest.mark.parametrize("width", [36, 76, 118])
def test_no_text_of_a_guides_page_is_cut(width: int) -> None:
    page = load_pages()["ev3dev2-and-pybricks"]
    texts = ["".join(part for part, _ in line) for line in draw_page(page, width)]
    assert not [text for text in texts if "…" in text and "…" not in page.source]
    assert 'Leds().set_color("LEFT",' in "\n".join(texts)
