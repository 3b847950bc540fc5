"""Programs that resemble each other are found under other names, and what a class has in common is left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pytest

from tests.tasks.marks.the_class import CLASS
from tuisim.tasks.marks import copies
from tuisim.tasks.marks.copies import MAX_LINE, MIN_TOKENS, Similar, find_similar, list_tokens

LINE = """\
while True:
    if colorLeft.reflected_light_intensity < 40:
        tank_drive.on(SpeedPercent(20), SpeedPercent(40))
    else:
        tank_drive.on(SpeedPercent(40), SpeedPercent(20))
    if ultrasonic.distance_centimeters < 12:
        tank_drive.off()
        break
print('done')
"""
RENAMED = """\
# My own idea.
while True:

    if sensor.value < 55:  # dark
        drive.go(Speed(10), Speed(30))
    else:
        drive.go(Speed(30), Speed(10))
    if eyes.cm < 9:
        drive.halt()
        break
print("stop")
"""
OTHER = """\
def turn(degrees):
    steering.on_for_degrees(100, 20, degrees * 2.3)

for side in range(4):
    tank_drive.on_for_rotations(30, 30, 2.5)
    turn(90)
    print('side', side, gyro.angle)
for side in reversed(range(4)):
    turn(-90)
    tank_drive.on_for_seconds(20, 20, 1)
"""


def _similar(programs: Mapping[str, str]) -> Similar:
    return find_similar({name: [text] for name, text in programs.items()})


def test_a_copy_in_an_imported_module_is_reported_as_a_similar_pair() -> None:
    found = find_similar(
        {"ada": [LINE], "ben": ["import sol\nsol.drive()\n", RENAMED], "cleo": [OTHER]}
    )
    (pair,) = found.pairs
    assert pair.names == ("ada", "ben") and pair.share > 0.9


def test_similarity_compares_only_the_first_tokens_of_a_long_program(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(copies, "MAX_TOKENS", 100)

    def write() -> Iterator[str]:
        for _ in range(10):
            yield LINE
        raise AssertionError("all of it was read")

    assert find_similar({"ada": write(), "ben": write()}).compared == 2


def test_programs_that_differ_in_names_numbers_or_comments_count_as_similar() -> None:
    found = _similar({"ada": LINE, "ben": RENAMED, "cleo": OTHER, "dora": LINE + "\n# end\n"})
    (group,) = found.groups
    assert (group.names, group.same) == (("ada", "ben", "dora"), (("ada", "dora"),))
    assert found.pairs == () and found.compared == 3 + 1


def test_a_copy_with_a_new_beginning_is_reported_as_a_similar_pair() -> None:
    found = _similar(
        {
            "ada": LINE,
            "ben": "x = [1, 2, 3]\nfor one in x:\n    print(one, x)\n" + RENAMED,
            "cleo": OTHER,
        }
    )
    (pair,) = found.pairs
    assert pair.names == ("ada", "ben") and pair.share > 0.9 and pair.lines >= 8


def test_similarity_ignores_code_that_everybody_has() -> None:
    programs = {"ada": LINE + OTHER, "ben": LINE + "print(1)\n" * 12}
    assert _similar(programs).pairs
    many = {f"student {at}": LINE + f"print({at})\n" * at for at in range(1, 12)}
    assert not _similar(many).pairs


def test_short_programs_are_not_compared_and_broken_ones_up_to_the_error() -> None:
    short = "tank_drive.on_for_rotations(50, 50, 3)\n"
    assert _similar({"ada": short, "ben": short}).compared == 0
    broken = _similar({"ada": LINE + "\n)\x00 '''", "ben": LINE})
    assert broken.compared == 2 and MIN_TOKENS > 20


def test_tokens_of_a_program_end_before_an_unclosed_string() -> None:
    tokens = list_tokens("x = 1\n'" + r"\'" * 100)
    assert [token.text for token in tokens] == ["x", "=", "1", "\n"]


def test_tokens_of_a_program_end_before_a_line_that_takes_much_memory() -> None:
    tokens = list_tokens(f"x = 1\ny = {'9' * MAX_LINE}\nz = 3\n")
    assert [token.text for token in tokens] == ["x", "=", "1", "\n"]


def test_similar_programs_do_not_depend_on_the_order_of_students() -> None:
    texts = {one.row: text for one in CLASS for text in one.files.values() if isinstance(text, str)}
    backwards = _similar(dict(reversed(texts.items())))
    assert {one.names for one in _similar(texts).pairs} == {
        tuple(sorted(one.names)) for one in backwards.pairs
    }
