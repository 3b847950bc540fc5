"""How names and signatures are drawn, and where the list stands."""

from __future__ import annotations

import pytest
from textual.geometry import Offset, Size

from tuisim.app.editor.candidate_list import format_signature, list_lines, list_place, measure_width
from tuisim.app.editor.completion import Candidate, Signature

MANY = tuple(Candidate(f"name_{n:02}", "(speed, seconds)", help=f"Help for {n}") for n in range(20))
SIGNATURE = Signature(
    "on_for_seconds", ("left_speed", "right_speed", "seconds", "brake=True", "block=True"), 2
)


def rows(chosen: int, width: int = 40) -> list[str]:
    return ["".join(text for text, _ in line) for line in list_lines(MANY, chosen, width)]


def test_a_completion_list_shows_eight_names_around_the_chosen_one_and_its_help() -> None:
    lines = rows(10)
    assert [line[:8] for line in lines[:-1]] == [
        f"{'▸' if n == 10 else ' '}name_{n:02}"[:8] for n in range(6, 14)
    ]
    assert lines[-1] == " Help for 10                      11/20 "
    assert {len(line) for line in lines} == {40}


@pytest.mark.parametrize("width", [24, 30, 40, 76])
def test_no_row_is_wider_than_the_list(width: int) -> None:
    assert {len(line) for line in rows(0, width)} == {width}


def test_the_last_name_of_a_long_completion_list_can_be_reached() -> None:
    assert rows(19)[-2].startswith("▸name_19(speed, seconds)")


@pytest.mark.parametrize(
    "longest, room, width",
    [("on", 78, 24), ("n" * 40, 78, 59), ("n" * 200, 118, 76), ("n" * 200, 58, 58)],
)
def test_a_completion_list_is_as_wide_as_its_names_need_and_the_room_allows(
    longest: str, room: int, width: int
) -> None:
    assert measure_width([Candidate("a"), Candidate(longest, "(speed, seconds)")], room) == width


@pytest.mark.parametrize(
    "word, place",
    [
        (Offset(10, 5), Offset(9, 6)),
        (Offset(70, 5), Offset(39, 6)),
        (Offset(10, 20), Offset(9, 11)),
        (Offset(0, 3), Offset(0, 4)),
    ],
    ids=["below", "at the right edge", "above", "at the left edge"],
)
def test_a_completion_list_is_placed_at_its_word_and_inside_the_screen(
    word: Offset, place: Offset
) -> None:
    assert list_place(word, Size(40, 9), Size(80, 24)) == place


@pytest.mark.parametrize(
    "width, text",
    [
        (80, "on_for_seconds(left_speed, right_speed, seconds, brake=True, block=True)"),
        (70, "on_for_seconds(…, right_speed, seconds, brake=True, block=True)"),
        (45, "on_for_seconds(…, seconds, brake=True, …)"),
        (30, "on_for_seconds(…, seconds, …)"),
        (20, "on_for_seconds(…, s…"),
    ],
)
def test_a_signature_is_shortened_around_its_present_parameter(width: int, text: str) -> None:
    shown = format_signature(SIGNATURE, width)
    assert shown.plain == text
    assert [shown.plain[span.start : span.end] for span in shown.spans if span.style == "bold"] == (
        ["seconds"] if width > 20 else ["s…"]
    )


def test_a_signature_without_parameters_has_empty_parentheses() -> None:
    assert format_signature(Signature("beep", (), None), 40).plain == "beep()"
