"""The page of a class: what it says of the class as a whole."""

from __future__ import annotations

import re
from dataclasses import replace

from tests.tasks.marks.test_copies import LINE, OTHER, RENAMED
from tests.tasks.marks.test_sheet import OUTCOMES, SHEET, STUDENTS
from tuisim.tasks.marks.copies import find_similar
from tuisim.tasks.marks.page import (
    build_page,
    compute_distribution,
    compute_goal_statistics,
    group_reasons,
)
from tuisim.tasks.marks.sheet import build_sheet


def test_goal_statistics_count_who_met_them_and_why_others_missed() -> None:
    place, wall = compute_goal_statistics(SHEET)
    assert (place.met, place.partly, wall.met, wall.partly) == (1, 1, 3, 0)
    assert (place.mean, wall.mean) == ((7 + 5.25) / 5, 9 / 5)
    assert place.reasons[0] == ("it stopped 40 mm away", 3)


def test_reasons_that_differ_only_in_measurements_are_one_with_ranges() -> None:
    reasons = [
        *("it was 405 mm left of x = 1430 mm", "it was 1,077.5 mm left of x = 1430 mm"),
        *("it was 17 mm right of x = 1430 mm", "“corner 1” was missed", "“corner 2” was missed"),
    ]
    assert group_reasons(reasons) == (
        ("it was 405 to 1,077.5 mm left of x = 1430 mm", 2),
        ("it was 17 mm right of x = 1430 mm", 1),
        ("“corner 1” was missed", 1),
        ("other reasons", 1),
    )


def test_words_between_backticks_are_code_on_the_page_of_marks() -> None:
    columns = [replace(each, say="Print `Colour: <` and ` at last.") for each in SHEET.columns]
    page = build_page(replace(SHEET, columns=tuple(columns)))
    assert "Print <code>Colour: &lt;</code> and ` at last." in page


def test_the_distribution_of_points_counts_every_student() -> None:
    parts = compute_distribution(SHEET)
    assert sum(count for *_, count in parts) == len(SHEET.rows)
    assert parts[0][2] == 2 and parts[8] == (8.0, 9.0, 1) and parts[9] == (9.0, 10.0, 1)


def test_the_page_of_marks_shows_goal_statistics_and_similar_programs() -> None:
    page = build_page(
        SHEET, similar=find_similar({"ada": [LINE], "ben": [RENAMED], "cleo": [OTHER]})
    )
    assert "<h2>Similar programs</h2>" in page and "ada, ben" in page
    assert (
        re.search(r"met by.*1 of 5, 1 in some runs", page, re.DOTALL)
        and "3 × it stopped 40 mm away" in page
    )


def test_the_page_of_a_class_of_one_has_no_statistics_and_no_similar_programs() -> None:
    page = build_page(
        build_sheet("", SHEET.columns, range(4), STUDENTS[:1], OUTCOMES),
        similar=find_similar({"ada": [LINE]}),
    )
    assert "<h2>Points</h2>" not in page and "Similar" not in page and "<h2>Goals</h2>" in page
