"""The search finds the page that answers a question."""

from __future__ import annotations

import pytest

from tests.guide.questions import QUESTIONS
from tuisim.guide.search import search


@pytest.mark.parametrize(("question", "page"), QUESTIONS.items())
def test_the_right_page_is_first(question: str, page: str) -> None:
    assert search(question)[0].name == page


@pytest.mark.parametrize(
    ("question", "page"),
    [
        pytest.param("Wheel DIAMETER?", "world-files", id="signs and capitals"),
        pytest.param("noteb", "notebooks", id="a word that is not complete"),
        pytest.param("debugging", "stepping", id="another form of a word"),
    ],
)
def test_words_need_not_be_exact(question: str, page: str) -> None:
    assert search(question)[0].name == page


@pytest.mark.parametrize(
    ("question", "section"),
    [
        ("run faster than real time", "Faster or slower than real time"),
        ("black outside the mat", "Light and colour"),
    ],
)
def test_the_section_that_answers_is_named(question: str, section: str) -> None:
    assert search(question)[0].heading == section


@pytest.mark.parametrize("question", ["", "how do I", "xyzzy", "%&"])
def test_nothing_is_found_where_nothing_is_asked(question: str) -> None:
    assert search(question) == []
