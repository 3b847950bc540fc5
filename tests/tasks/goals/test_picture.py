"""What sensors see and the pen draws: following a line, and drawings compared with pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw

from tests.cases import cases
from tests.tasks.goals.recorded import Run, Step, ahead, drive, goals_of, turn, wait, world
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.picture import compare, compute_cell_mm

BANDS = world(100, 500, background="Grey_bands")
"""The black band is from x 1450 to 1651; the sensors are 30 mm ahead."""

TO_BLACK = (ahead(1400, line=3), wait(2, line=4))
"""8 s to x 1500 on the black band, then 2 s on it."""


@pytest.mark.parametrize(
    "start",
    [
        (FIELD_WIDTH_MM - 12, 500, 0),
        (500, FIELD_HEIGHT_MM - 12, 90),
        (12, 500, 180),
        (500, 12, -90),
    ],
)
def test_off_the_mat_counts_as_black_in_goals_about_lines(
    start: tuple[float, float, float], home: Path, tmp_path: Path
) -> None:
    run = Run(RunStore(), world(*start), "")
    run.do([drive(36, 36, 1.5)])
    goals = "[[goal]]\nname = 'it'\nfollow = { point_mm = [0, 0], darker_than = 1 }\n"
    (found,) = judge(goals_of(tmp_path, goals), run.end())
    # 12 mm of 26 are on the white mat.
    assert "was on the line for 54.3 % of the time" in found.reason


FOLLOWED = {
    "sensor": ("sensors = 'left', darker_than = 50, share = 0.2", "met", ""),
    "too short": (
        "sensors = 'left', darker_than = 50, share = 0.5",
        "missed",
        "left was on the line for 24",
    ),
    "bright": ("sensors = 'left', brighter_than = 99, share = 0.3", "met", ""),
    "between": ("sensors = 'left', darker_than = 60, brighter_than = 40, share = 0.1", "met", ""),
    "any of two": ("sensors = ['left', 'right'], darker_than = 50, share = 0.2", "met", ""),
    "point": ("point_mm = [0, 30], darker_than = 50, share = 0.2", "met", ""),
    "point too short": (
        "point_mm = [0, 30], darker_than = 50, share = 0.9",
        "missed",
        "The robot was on the line for 24",
    ),
    "no such sensor": (
        "sensors = 'front', darker_than = 50",
        "missed",
        "no colour sensor front; it has: left, right",
    ),
}


@cases("keys, state, reason", FOLLOWED)
def test_a_followed_line_is_met_or_missed_with_its_reason(
    keys: str, state: str, reason: str, home: Path, tmp_path: Path
) -> None:
    (goal,) = goals_of(tmp_path, f"[[goal]]\nname = 'it'\nfollow = {{ {keys} }}\n")
    run = Run(RunStore(), BANDS, "")
    run.do(TO_BLACK)
    (found,) = judge([goal], run.end())
    assert found.state == state, found
    assert reason in found.reason


def test_a_goal_to_follow_a_line_counts_only_between_after_and_until(
    home: Path, tmp_path: Path
) -> None:
    text = "follow = { sensors = 'left', darker_than = 50, share = 1 }\nafter = 8\nuntil = 9\n"
    (goal,) = goals_of(tmp_path, f"[[goal]]\nname = 'it'\n{text}")
    run = Run(RunStore(), BANDS, "")
    run.do(TO_BLACK)
    (found,) = judge([goal], run.end())
    assert [(change.state, change.time_s) for change in found.changes] == [("met", 9.0)]


SQUARE = "lines_mm = [[[500, 500], [700, 500], [700, 700], [500, 700], [500, 500]]]"
SIDES = (ahead(200, 1), turn(90, 2)) * 4

DRAWN: dict[str, tuple[str, tuple[Step, ...], str, str]] = {
    "square": (f"{SQUARE}, within_mm = 10", SIDES, "met", ""),
    "three sides": (
        f"{SQUARE}, within_mm = 10",
        SIDES[:5],
        "missed",
        "% of the picture is drawn, not the part at x 50",
    ),
    "too far": (
        f"{SQUARE}, within_mm = 10",
        (*SIDES, drive(-360, -360, 2, line=7)),
        "missed",
        "% of the drawing is on the picture, it leaves it at x 489, y 500 mm at",
    ),
    "small share": (f"{SQUARE}, within_mm = 10, share = 0.7", SIDES[:5], "met", ""),
    "nothing": (f"{SQUARE}, within_mm = 10", (), "missed", "of the picture is drawn"),
    "image": ("image = 'square.png', within_mm = 10", SIDES, "met", ""),
    "image of a part": (
        "image = 'part.png', within_mm = 10",
        SIDES,
        "missed",
        "of the drawing is on the picture",
    ),
    "wide tolerance": (f"{SQUARE}, within_mm = 400", SIDES[:1], "met", ""),
}


@pytest.mark.slow_cases("image*")
@cases("keys, steps, state, reason", DRAWN)
def test_a_drawing_is_compared_with_its_picture(
    keys: str, steps: tuple[Step, ...], state: str, reason: str, home: Path, tmp_path: Path
) -> None:
    for name, corners in (("square", (500, 443, 700, 643)), ("part", (500, 443, 600, 643))):
        picture = Image.new("L", (2362, 1143), 255)
        ImageDraw.Draw(picture).rectangle(corners, outline=0, width=3)
        picture.save(tmp_path / f"{name}.png")
    (goal,) = goals_of(tmp_path, f"[[goal]]\nname = 'it'\ndraw = {{ {keys} }}\n")
    run = Run(RunStore(), world(), "")
    run.do((wait(0.1), *steps))
    (found,) = judge([goal], run.end())
    assert found.state == state, found
    assert reason in found.reason


def test_a_drawing_is_compared_up_to_the_edges_of_the_field() -> None:
    within_mm = 16.0
    side_mm = compute_cell_mm(within_mm)
    cols = int(FIELD_WIDTH_MM // side_mm)
    rows = int(FIELD_HEIGHT_MM // side_mm)
    corners = np.array([[0, 0], [cols - 1, 0], [0, rows - 1], [cols - 1, rows - 1]])
    numbers = corners[:, 1] * cols + corners[:, 0]
    points = (corners + 0.5) * side_mm
    for shift_mm, is_near in ((0, True), (10, True), (18, False)):
        for direction in (-1, 1):
            moved = points + np.array([direction * shift_mm, 0.0])
            drawn, near = compare(numbers, moved, within_mm)
            assert (drawn.tolist(), near.tolist()) == ([is_near] * 4, [is_near] * 4)
