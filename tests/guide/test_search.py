"""The search finds the page that answers a question."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from pathlib import Path

import pytest

from tuisim.guide.catalogue import load_pages
from tuisim.guide.excerpt import draw_excerpt, flatten_passage
from tuisim.guide.search import SearchResult, search
from tuisim.guide.text import draw_page, find_passage_end, find_rows

STUDENTS = tomllib.loads((Path(__file__).parent / "questions.toml").read_text(encoding="utf-8"))
"""What students ask, with the pages that answer it."""


def names(question: str) -> list[str]:
    """The pages of the two answers found first."""
    return [one.name for one in search(question)[:2]]


def shown_of(
    one: SearchResult, width: int, most: int, asked: re.Pattern[str] | None = None
) -> list[str]:
    """What is shown of an answer."""
    return ["".join(text for text, _ in line) for line in draw_excerpt(one, width, most, asked)]


@pytest.mark.parametrize("written, least", [("first", 20), ("later", 48)])
def test_questions_in_words_find_their_page(written: str, least: int) -> None:
    asked = STUDENTS[written]
    assert all({*one["pages"]} <= {*load_pages()} for one in asked)
    assert sum(not {*one["pages"]}.isdisjoint(names(one["ask"])) for one in asked) >= least


@pytest.mark.parametrize(
    "question", ["wrong order", "reading with noise", "wall", "key", "sensor value"]
)
def test_a_passage_is_neither_a_fence_nor_a_rule(question: str) -> None:
    assert not [one for one in search(question) if one.passage.startswith(("```", "| ---"))]


@pytest.mark.parametrize("question", ["", "how do I", "xyzzy", "%&"])
def test_an_empty_search_of_the_guide_finds_nothing(question: str) -> None:
    assert search(question) == []


@pytest.mark.parametrize("width", [24, 33, 50])
def test_lines_shown_of_a_guides_answer_fit_the_width(width: int) -> None:
    for question in ("sensor", "motor", "wall", "noise"):
        for one in search(question):
            lines = [line for most in range(1, 6) for line in shown_of(one, width, most)]
            assert max(map(len, lines)) <= width


def test_a_mistyped_word_finds_the_page_of_the_right_one() -> None:
    assert search("brekpoint")[0].name == "breakpoints"
    assert not search("xyzz")


@pytest.mark.parametrize(
    "parts", [("gyro drift", "compare runs"), ("keyboard shortcuts", "own mat")]
)
def test_a_question_of_two_parts_finds_an_answer_to_each(parts: tuple[str, ...]) -> None:
    answers = search(" and ".join(parts))[:4]
    assert all(search(part)[0] in answers for part in parts)


@pytest.mark.parametrize("width, begins", [(36, "gyro"), (76, "gyro"), (118, " gyro  ")])
def test_a_found_row_of_a_table_is_located_on_the_page_at_each_width(
    width: int, begins: str
) -> None:
    found = next(
        one for one in search("gyro angle INPUT_4 Port.S4") if one.name == "ev3dev2-and-pybricks"
    )
    lines = draw_page(load_pages()[found.name], width)
    _, row = find_rows(lines, found.heading, found.passage)
    assert "".join(part for part, _ in lines[row]).startswith(begins)


@pytest.mark.parametrize("width", [36, 72, 118])
def test_a_found_row_is_not_taken_for_an_earlier_one_with_the_same_words(width: int) -> None:
    found = search("gyro drift")[0]
    lines = draw_page(load_pages()[found.name], width)
    _, row = find_rows(lines, found.heading, found.passage)
    end = find_passage_end(lines, row, found.passage)
    shown = "".join("".join(part for part, _ in line) for line in lines[row:end])
    assert shown.split()[0] == "gyro_dps"
    letters = Counter(re.findall(r"\w", flatten_passage(found.passage)))
    assert not letters - Counter(re.findall(r"\w", shown))


@pytest.mark.parametrize("width", [36, 76, 118])
@pytest.mark.parametrize("question", ["why does the sensor say White on grey", "threshold"])
def test_a_found_passage_ends_where_the_next_one_begins(question: str, width: int) -> None:
    first = search(question)[0]
    lines = draw_page(load_pages()[first.name], width)
    _, row = find_rows(lines, first.heading, first.passage)
    end = find_passage_end(lines, row, first.passage)
    shown = "".join("".join(part for part, _ in line) for line in lines[row:end])
    assert sorted(re.findall(r"\w", shown)) == sorted(
        re.findall(r"\w", flatten_passage(first.passage))
    )


def test_code_in_a_shown_answer_stands_on_lines_of_its_own() -> None:
    one = SearchResult(
        "writing-programs", "", "- **To wait**, write:\n\n      for n in x:\n          wait()\n"
    )
    assert shown_of(one, 40, 9) == ["To wait, write:", "for n in x:", "    wait()"]
    assert shown_of(one, 40, 2) == ["To wait, write:", "for n in x:"]
    assert shown_of(one, 9, 1) == ["To wait, …"]


def test_a_long_answer_is_shown_from_the_sentence_with_the_questions_words() -> None:
    one = SearchResult(
        "writing-programs", "", "First of all, it drives. The wheels turn. Then the robot beeps."
    )
    asked = re.compile("beep|robot")
    assert shown_of(one, 30, 1, asked) == ["… Then the robot beeps."]
    assert shown_of(one, 80, 1, asked) == [
        "First of all, it drives. The wheels turn. Then the robot beeps."
    ]


def test_an_answer_that_introduces_a_list_shows_the_lists_items() -> None:
    (first, *_) = search("the robot does not move")
    lines = shown_of(first, 100, 9)
    assert first.passage.endswith(":") and sum(line.startswith("• ") for line in lines) > 2
    assert lines[-1] == "…" and len(lines) == 9
    assert len(shown_of(first, 100, 2)) == 2


def test_of_a_long_code_block_the_lines_with_the_questions_words_are_shown() -> None:
    (first, *_) = search("explorer.toml left_port outD gyro = false ultrasonic = false")
    lines = shown_of(first, 90, 9, re.compile("left_port|outD|gyro"))
    assert 'left_port = "outD"  # the motor of the left wheel' in lines
    assert "gyro = false" in lines and lines[-1] == "…" and len(lines) == 9


def test_a_number_in_a_sentence_is_not_taken_for_a_list_item() -> None:
    one = SearchResult("keys", "", "- It grows - by\n  90. Then it stops.")
    assert shown_of(one, 60, 9) == ["It grows - by 90. Then it stops."]


def test_a_long_line_of_code_is_broken_and_a_command_has_its_prompt() -> None:
    one = SearchResult("keys", "", "    tank_drive.on_for_rotations(30, -30, 180 / 56 / 4)")
    assert shown_of(one, 44, 9) == ["tank_drive.on_for_rotations(30, -30, 180 /", "    56 / 4)"]
    (export, *_) = search("tuisim runs export last")
    assert "    $ tuisim runs export last" in export.passage


def test_code_alone_keeps_its_lines() -> None:
    one = SearchResult("world-files", "", "    # a.toml\n    x = 1\n    \n    y = 2")
    assert shown_of(one, 40, 9) == ["# a.toml", "x = 1", "y = 2"]


def test_answers_far_worse_than_the_best_one_are_left_out() -> None:
    assert len(search("How do I make the robot slower?")) < 6 < len(search("robot"))


def test_a_shown_row_of_a_table_names_its_columns() -> None:
    row = next(
        one
        for one in search("which formats can I export, csv or arrow")
        if "`.csv`" in one.passage[:9]
    )
    assert shown_of(row, 80, 1)[0].startswith(".csv · keeps: text · units, seed")
    key = next(one for one in search("zoom the world") if one.passage.startswith("| `v` |"))
    assert shown_of(key, 80, 1) == ["v · Zoom the world"]
    pair = SearchResult("a", "", "| `x` | does this |", "| key | does |")
    assert shown_of(pair, 80, 1) == ["x · does this"]


def test_what_follows_a_colon_belongs_to_the_same_passage_of_the_guide() -> None:
    found = next(one for one in search("export a stored run") if one.heading == "After the run")
    assert found.passage.endswith("tuisim log export last --out again.arrow")


def test_a_bar_in_a_cell_of_a_found_row_has_no_backslash() -> None:
    row = SearchResult("commands", "", r"| `tuisim log` | `--decimal .\|,` | Decimal sign |")
    assert "".join(part for line in draw_excerpt(row, 80, 4) for part, _ in line) == (
        "tuisim log · --decimal .|, · Decimal sign"
    )
