"""Questions that people ask find the passage that answers them."""

from __future__ import annotations

import pytest

from tuisim.guide.catalogue import load_pages
from tuisim.guide.search import load_questions, search
from tuisim.guide.tables import build_markdown


def test_each_expected_answer_is_text_of_its_page() -> None:
    for name, answers in load_questions().items():
        text = build_markdown(load_pages()[name])
        assert [key for key in answers if key not in text] == [], name


@pytest.mark.slow_cases("*-all")
@pytest.mark.parametrize("count", [1, None], ids=["first", "all"])
@pytest.mark.parametrize("name", load_questions())
def test_each_question_finds_its_answer_among_the_first_two(name: str, count: int | None) -> None:
    missed = [
        (key, ask, [one.name for one in search(ask)[:2]])
        for key, asks in load_questions()[name].items()
        for ask in asks[:count]
        if not any(one.name == name and key in one.passage for one in search(ask)[:2])
    ]
    assert missed == []


def test_no_test_question_has_two_expected_answers() -> None:
    asks = [
        ask for answers in load_questions().values() for asks in answers.values() for ask in asks
    ]
    assert len(asks) == len({*asks})
