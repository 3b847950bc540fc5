"""Which instants of a run a movie shows, and for how long."""

from __future__ import annotations

import pytest

from tuisim.pictures.movies.clip import END_MS, plan_shots

# Start, end, speed and frames per second; expected times, and durations without the time added at the end.
SHOTS = {
    "real time": ((0, 0.3, 1, 10), [0, 0.1, 0.2, 0.3], [100] * 4),
    "part of a run": ((2, 2.2, 1, 10), [2, 2.1, 2.2], [100] * 3),
    "twice as fast": ((0, 0.6, 2, 10), [0, 0.2, 0.4, 0.6], [100] * 4),
    "slow motion": ((0, 0.1, 0.5, 10), [0, 0.05, 0.1], [100] * 3),
    "range that no frame ends": ((0, 0.25, 1, 10), [0, 0.1, 0.2, 0.25], [100] * 4),
    "rate that no hundredths meet": (
        (0, 0.2, 1, 30),
        [0, 1 / 30, 2 / 30, 0.1, 4 / 30, 5 / 30, 0.2],
        [30, 40, 30, 30, 40, 30, 30],
    ),
    "single instant": ((5, 5, 1, 20), [5], [50]),
}


@pytest.mark.parametrize("name", SHOTS)
def test_frames_of_a_movie_are_evenly_spaced_in_time(name: str) -> None:
    (start_s, stop_s, speed, fps), times_s, durations_ms = SHOTS[name]
    shots = plan_shots(start_s, stop_s, speed, fps)
    assert [shot.time_s for shot in shots] == pytest.approx(times_s)
    assert [shot.duration_ms for shot in shots] == [*durations_ms[:-1], durations_ms[-1] + END_MS]
