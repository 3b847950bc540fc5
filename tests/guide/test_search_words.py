"""Words of questions: what says nothing is left out, forms of a word are one, and some words mean the same."""

from __future__ import annotations

import pytest

from tuisim.guide.search import find_stems, split_words


def test_a_search_keeps_the_not_of_a_negated_question() -> None:
    assert [*split_words("why doesn't it move")] == ["not", "move"]
    assert [*split_words("it doesnt move and I dont know")] == ["not", "move", "know"]
    assert [*split_words("different current")] == ["different", "current"]
    assert [*split_words("It cannot find the colours, can't it?")] == ["not", "find", "colours"]


@pytest.mark.parametrize("question", ["", "how do I", "What's that?"])
def test_a_search_leaves_out_filler_words(question: str) -> None:
    assert find_stems([question]) == [frozenset()]


def test_a_search_treats_forms_of_a_word_as_one() -> None:
    assert len({*find_stems(["turning", "Turns", "turned", "turn"])}) == 1


def test_a_search_treats_synonyms_as_the_same_word() -> None:
    graph, chart, wall = find_stems(["graph", "chart", "wall"])
    assert graph & chart == {"=chart"}
    assert not graph & wall


def test_a_search_keeps_words_joined_by_an_arrow_together() -> None:
    assert [*split_words("what is in→out")] == ["in→out"]
