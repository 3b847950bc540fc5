"""Two runs compared."""

from __future__ import annotations

import numpy as np
import pytest

from tests.engine.runs.test_recorded_run import stored
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.runs.diff import diff_runs, find_first_difference_s, spell_name


def test_the_difference_of_two_runs_is_told() -> None:
    text = "for speed in (30, 60):\n    tank_drive.on_for_seconds({}, speed, 0.5)\n    print('Speed: ' + str(speed))\n"
    one = stored(text.format(30), {"seed": 1})
    two = stored(text.format("speed"), {"seed": 2})
    found = diff_runs(one, two)
    recording = dict(found.describe_recording())
    setup = dict(found.describe_setup())
    assert "x mm" in recording["first differing tick"]
    assert "mm apart" in recording["poses"]
    assert setup["settings, seed"] == "1 | 2"
    assert "--- prog.py" in [line for label, line in found.describe_setup() if not label]
    assert list(diff_runs(one, one).describe_recording()) == [
        ("bit-identical", "recording, output, settings")
    ]


@pytest.mark.parametrize(
    "name, words",
    [
        ("left_speed_dps", "left speed °/s"),
        ("world.noise.light", "noise, light"),
        ("world.obstacles.0.x_mm", "obstacles 1, x mm"),
        ("robot.color_sensors.1.diameter_mm", "robot, colour sensors 2, diameter mm"),
    ],
)
def test_what_differs_between_two_runs_is_named_in_words(name: str, words: str) -> None:
    assert spell_name(name) == words


@pytest.mark.parametrize(
    "field, step, at_s",
    [
        ("x_mm", 0.3, 0.4),
        ("heading_deg", -0.3, 0.4),
        ("heading_deg", 36.0, 0.1),
        ("y_mm", 0.01, None),
    ],
)
def test_the_first_difference_of_two_runs_is_found_by_distance_or_heading(
    field: str, step: float, at_s: float | None
) -> None:
    one = np.zeros(11, np.dtype(list(TICK_FIELDS)))
    two = one.copy()
    two[field] += step * np.arange(11)
    assert find_first_difference_s(one, two, (10, 10)) == at_s


def test_headings_a_full_turn_apart_are_no_difference_of_two_runs() -> None:
    one = np.zeros(3, np.dtype(list(TICK_FIELDS)))
    two = one.copy()
    two["heading_deg"] += 360.0
    assert find_first_difference_s(one, two, (10, 10)) is None


@pytest.mark.parametrize(
    "until, prefix, row",
    [(None, False, 2), (None, True, 2), (99, False, None), (100, False, None), (101, False, 2)],
)
def test_the_output_of_two_runs_is_compared_up_to_the_given_tick(
    until: int | None, prefix: bool, row: int | None
) -> None:
    text = "for number in (1, 2):\n    tank_drive.on_for_seconds(20, 20, 0.5)\n    print({})\n"
    one = stored(text.format("'a', number"))
    two = stored(text.format("'a', number * number"))
    found = diff_runs(one, two, until=until, prefix=prefix)
    assert (found.output and found.output.row) == row
    assert (found.tick, found.same) == (None, row is None)


def test_two_runs_are_compared_only_as_long_as_both_last() -> None:
    one = np.zeros(11, np.dtype(list(TICK_FIELDS)))
    one["x_mm"][6:] = 100.0
    assert find_first_difference_s(one, one[:6], (10, 10)) is None
    assert find_first_difference_s(one[:6], one, (10, 10)) is None


def test_a_comparison_says_which_runs_output_ends_earlier() -> None:
    one = stored("print('a')\n")
    two = stored("print('a')\nprint('b')\n")
    recording = dict(diff_runs(one, two).describe_recording())
    assert recording["first differing output row"].startswith("2: no more | 'b' at ")
