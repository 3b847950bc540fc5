"""What counts as done by a visitor."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.web.visit import Activity, is_done_by_a_person, is_use

INPUT = {
    "a letter": ("R", True),
    "escape": ("\x1b", True),
    "an arrow": ("\x1b[A", True),
    "ctrl and an arrow": ("\x1b[1;5C", True),
    "F5": ("\x1b[15~", True),
    "F1": ("\x1bOP", True),
    "the mouse": ("\x1b[<35;10;20M", True),
    "a paste": ("\x1b[200~text\x1b[201~", True),
    "an answer and a key": ("\x1b[12;40R.", True),
    "nothing": ("", False),
    "the cursor's place": ("\x1b[12;40R", False),
    "two answers": ("\x1b[12;40R\x1b[?2026;2$y", False),
    "the size of a cell": ("\x1b[6;21;9t", False),
    "what the terminal can do": ("\x1b[?1;2c", False),
    "its name": ("\x1bP>|xterm.js\x1b\\", False),
    "its background": ("\x1b]11;rgb:0000/0000/0000\x07", False),
}


@for_rows("text, by_a_person", INPUT)
def test_automatic_answers_of_the_terminal_do_not_count_as_user_activity(
    text: str, by_a_person: bool
) -> None:
    assert is_done_by_a_person(text) is by_a_person


MOUSE = {
    "a move": ("\x1b[<35;10;20M", False),
    "two moves with keys held": ("\x1b[<39;10;20M\x1b[<51;11;20M", False),
    "a move and an answer": ("\x1b[<35;10;20M\x1b[12;40R", False),
    "a press": ("\x1b[<0;10;20M", True),
    "a drag": ("\x1b[<32;10;20M", True),
    "the wheel": ("\x1b[<64;10;20M", True),
    "a move and a key": ("\x1b[<35;10;20MR", True),
}


@cases("text, uses", MOUSE)
def test_mouse_movement_alone_does_not_count_as_using_the_app(text: str, uses: bool) -> None:
    assert is_done_by_a_person(text)
    assert is_use(text) is uses


def test_a_visitors_idle_time_counts_from_the_last_input() -> None:
    clock = iter([100.0, 130.0, 135.0]).__next__
    activity = Activity(clock)
    activity.note()
    assert activity.idle_s == 5.0
