"""The report of a marked run: its goals, where on the mat they were decided, and nothing of the machine."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PIL import Image

from tests.conftest import Command

GOALS = """
background = "own.png"
[start]
x_mm = 200
y_mm = 500
[[obstacle]]
x_mm = 700
y_mm = 400
width_mm = 100
height_mm = 200
[[goal]]
name = "there"
say = "Come to x = 400."
points = 2
reach = { x_mm = 400, within_mm = 10 }
[[goal]]
name = "free"
say = "Touch nothing."
touch_nothing = true
[[goal]]
name = "end"
say = "Stop at x = 550."
points = 3
reach = { x_mm = 550, at_end = true }
[[goal]]
name = "call"
say = "Call <b>time.sleep</b>."
use = "time.sleep"
"""
PROGRAM = """\
# %%sim_magic_preloaded
tank_drive.on_for_rotations(50, 50, 3)
import time
"""


@pytest.fixture
def report(tmp_path: Path, here: Command) -> str:
    """The report of a run that comes to the place, goes on, touches the obstacle and stops behind it."""
    Image.new("RGB", (200, 100), "white").save(tmp_path / "own.png")
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "ada.py").write_text(PROGRAM)
    (tmp_path / "goals.toml").write_text(GOALS)
    done = here(
        "mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--export", "marks.html"
    )
    assert done.returncode == 0, done.stderr
    return (tmp_path / "marks-runs" / "ada-seed-0.html").read_text()


def test_a_marked_runs_report_lists_goals_with_result_reason_and_points(
    report: str, tmp_path: Path
) -> None:
    (section,) = re.findall("<h2>Goals</h2>.*?</section>", report, re.DOTALL)
    rows = [re.findall("<td[^>]*>(.*?)</td>", row) for row in section.split("</tr>")[1:-1]]
    words = [
        (number, said, result.partition(" at ")[0], why[:22], points)
        for number, said, result, why, points in rows
    ]
    assert words == [
        ("1", "Come to x = 400.", "met", "", "2 of 2"),
        ("2", "Touch nothing.", "missed", "The robot touched the ", "0 of 1"),
        ("3", "Stop at x = 550.", "missed", "At the end the robot w", "0 of 3"),
        ("4", "Call &lt;b&gt;time.sleep&lt;/b&gt;.", "missed", "The program does not c", "0 of 1"),
    ]
    there, touched, end = (
        int(re.findall(r"x (\d+), y 500 mm", result)[0]) for _, _, result, *_ in rows[:3]
    )
    # From x 200 on by three rotations of 175.93 mm; the obstacle is at x 700, the front some 50 mm before the axle.
    assert 390 <= there <= 400 and 640 <= touched <= 660 and end == 728
    assert "(line 2)" in rows[2][3] and "line" not in rows[3][3]
    # The same goals on the mat.
    (pins,) = re.findall('<svg class="pins".*?</svg>', report, re.DOTALL)
    labels = [re.findall("<tspan[^>]*>(.*?)</tspan>", ring) for ring in pins.split("</g>")[:-1]]
    x_px = [float(x) for x in re.findall('cx="(.*?)"', pins)]
    assert (labels, x_px == sorted(x_px)) == ([["✓1"], ["✗2"], ["✗3"]], True)
    assert "<title>1. Come to x = 400. met at " in pins
    # No path of the machine is told.
    assert str(tmp_path) not in report and "the mat own.png and" in report


@pytest.mark.slow
def test_the_movie_of_a_run_that_missed_a_goal_shows_the_goals_places(
    report: str, tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class" / "right.py").write_text("tank_drive.on_for_rotations(50, 50, 1)\n")
    goals = GOALS.partition('[[goal]]\nname = "free"')[0].replace("x_mm = 400", "x_mm = 550")
    (tmp_path / "goals.toml").write_text(
        goals.replace("x_mm = 550, within_mm = 10", "x_mm = 375.9, at_end = true")
    )
    words = ("--seeds", "0", "--jobs", "1", "--keep", "all", "--export", "marks.html", "--movies")
    assert here("mark", "goals.toml", "class", *words).returncode == 0
    missed, right = (
        (tmp_path / "marks-runs" / f"{name}-seed-0.html").read_text() for name in ("ada", "right")
    )
    assert '<details class="movie">' not in report + right
    movie = missed.partition('<details class="movie">')[2].partition("</details>")[0]
    assert "data:image/gif" in movie and movie.count("✗1") == 1
