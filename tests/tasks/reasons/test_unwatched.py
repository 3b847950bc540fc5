"""Light that came and went while a long line kept the program from looking."""

from __future__ import annotations

import pytest

from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.reason import ReasonKind, find_reasons

LINE = "# %%sim_magic_preloaded -b Line_Following_Test\n"
TWO_TURNS = f"""{LINE}for turn in range(8):
    if colorLeft.reflected_light_intensity_pc < 50:
        tank_drive.on_for_{{0}}(SpeedPercent(10), SpeedPercent(30), {{1}})
    else:
        tank_drive.on_for_{{0}}(SpeedPercent(30), SpeedPercent(10), {{1}})
"""
BLACK = """\
# %%sim_magic_preloaded -b Grey_bands
for step in range(6):
    if colorLeft.color == 1:
        break
    tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), {0})
tank_drive.off()
"""


def list_unwatched(text: str) -> list[str]:
    reasons = find_reasons(run_text(text))
    return [one.words for one in reasons if "takes too long" in one.words]


@pytest.mark.parametrize(
    "text, words",
    [
        (
            TWO_TURNS.format("rotations", 1),
            "3.16 s, line 6: colorLeft saw light of 1 here, but the program read it only at 2.69 s and 4.03 s: "
            "line 6 takes too long",
        ),
        (
            BLACK.format(1.5),
            "6.60 s, line 5: colorLeft saw black here, but the program read it only at 6.10 s and 7.62 s: "
            "line 5 takes too long",
        ),
    ],
    ids=["percent", "colour"],
)
def test_a_call_that_kept_the_program_from_reading_the_line_is_named(
    home: object, text: str, words: str
) -> None:
    assert list_unwatched(text) == [words]
    (reason,) = [one for one in find_reasons(run_text(text)) if one.words == words]
    assert reason.kind is ReasonKind.LOST


@pytest.mark.parametrize(
    "text",
    [
        TWO_TURNS.format("seconds", 0.1),
        BLACK.format(0.2),
        BLACK.replace("if colorLeft.color == 1", "print(colorLeft.color)\n    if step > 3").format(
            1.5
        ),
    ],
    ids=["short moves", "a colour in time", "a sensor that decides nothing"],
)
def test_a_program_that_reads_often_enough_is_not_blamed_for_losing_the_line(
    home: object, text: str
) -> None:
    assert list_unwatched(text) == []
