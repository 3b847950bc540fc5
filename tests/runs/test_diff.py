"""Two runs compared."""

from __future__ import annotations

from tests.runs.test_recorded_run import stored
from tuisim.runs.diff import diff_runs, recording_in_words, setup_in_words


def test_the_difference_of_two_runs_is_told() -> None:
    text = "for speed in (30, 60):\n    tank_drive.on_for_seconds({}, speed, 0.5)\n    print('Speed: ' + str(speed))\n"
    one, two = stored(text.format(30), {"seed": 1}), stored(text.format("speed"), {"seed": 2})
    found = diff_runs(one, two)
    recording, setup = dict(recording_in_words(found)), dict(setup_in_words(found))
    assert "x_mm" in recording["first differing tick"]
    assert "mm apart" in recording["poses"]
    assert setup["settings, seed"] == "1 | 2"
    assert "--- prog.py" in [line for label, line in setup_in_words(found) if not label]
    assert list(recording_in_words(diff_runs(one, one))) == [("bit-identical", "recording, output, settings")]
