"""Trajectories: each part begins where the one before has come to, and the last one where the move shall end."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest

from tests.cases import for_each
from tuisim.engine.core.servo.trajectory import (
    MILLI,
    MS_US,
    Segment,
    Trajectory,
    build_angle_move,
    build_endless_move,
    build_timed_move,
    scale_move,
)

MAX_MILLI_OFF, MAX_US_OFF = 2.5 * MILLI, 8 * MS_US
"""Times are rounded to milliseconds, rates and lengths to whole counts."""
MAX_RATE_OFF = 8
FASTEST = 1000
SEEDS = range(200)


def check_joints(trajectory: Trajectory) -> None:
    parts = trajectory[:2] if trajectory.endless else trajectory[:4]
    for part, following in pairwise(parts):
        assert part.start_us <= following.start_us + MAX_US_OFF
        assert part.find_milli(following.start_us) == pytest.approx(
            following.milli, abs=MAX_MILLI_OFF
        )
        assert part.find_rate(following.start_us) == pytest.approx(following.rate, abs=MAX_RATE_OFF)
        assert abs(following.rate) <= FASTEST


def draw_move(seed: int) -> tuple[Segment, int, int, int]:
    """Return where a move begins, its rate, its acceleration and its target."""
    chance = random.Random(seed)
    rate = chance.choice((0, chance.randrange(-FASTEST, FASTEST)))
    start = Segment(chance.randrange(4_000_000) * MS_US, chance.randrange(-90_000, 90_000), rate, 0)
    wanted = chance.choice((-1, 1)) * chance.randrange(20, 1200)
    target = chance.choice((chance.randrange(-200, 200), chance.randrange(-3000, 3000)))
    return start, wanted, chance.randrange(800, 4000), target


@for_each(seed=SEEDS)
def test_the_trajectory_of_a_move_ends_at_its_target_at_rest(seed: int) -> None:
    start, rate, acceleration, target = draw_move(seed)
    trajectory = build_angle_move(start, target, rate, acceleration, FASTEST)
    check_joints(trajectory)
    assert trajectory.end[1:] == (target * MILLI, 0, 0)
    assert trajectory.first[:2] == start[:2]
    assert abs(trajectory.even.rate) <= abs(rate)


@for_each(seed=SEEDS)
def test_the_trajectory_of_a_timed_move_ends_after_its_time(seed: int) -> None:
    start, rate, acceleration, target = draw_move(seed)
    time_us = (1 + 2 * abs(target)) * MS_US
    trajectory = build_timed_move(start, time_us, rate, acceleration, FASTEST)
    check_joints(trajectory)
    assert trajectory.end.start_us == start.start_us + time_us
    assert trajectory.end[2:] == (0, 0)
    if time_us > 4 * FASTEST * 1_000_000 // acceleration:
        assert trajectory.first[:3] == start[:3]
        assert abs(trajectory.even.rate - rate) <= max(0, abs(rate) - FASTEST)


@for_each(seed=SEEDS)
def test_the_trajectory_of_an_endless_move_reaches_its_speed(seed: int) -> None:
    start, rate, acceleration, _ = draw_move(seed)
    trajectory = build_endless_move(start, rate, acceleration, FASTEST)
    check_joints(trajectory)
    assert trajectory.first[:3] == start[:3]
    assert abs(trajectory.even.rate - rate) <= max(0, abs(rate) - FASTEST)


@for_each(seed=SEEDS)
def test_a_follower_move_in_proportion_ends_at_the_same_time_as_its_leader(seed: int) -> None:
    start, rate, acceleration, target = draw_move(seed)
    leader = build_angle_move(start, 2000 + abs(target), rate, acceleration, FASTEST)
    ways = target * MILLI - start.milli, leader.end.milli - start.milli
    follower = scale_move(leader, start.milli, *ways)
    assert (follower.first.milli, follower.end.milli) == (start.milli, target * MILLI)
    share = ways[0] / ways[1]
    for part, led in zip(follower[:4], leader[:4], strict=True):
        assert part.start_us == led.start_us
        scaled = (
            start.milli + share * (led.milli - start.milli),
            *(share * one for one in led[2:]),
        )
        assert part[1:] == pytest.approx(scaled, abs=1)


@pytest.mark.parametrize("is_endless", [False, True])
def test_each_time_of_a_trajectory_lies_in_one_of_its_segments(is_endless: bool) -> None:
    start = Segment(7 * MS_US, 0, -300, 0)
    trajectory = (
        build_endless_move(start, 500, 900, FASTEST)
        if is_endless
        else build_angle_move(start, 2000, 500, 900, FASTEST)
    )
    parts = trajectory[:2] if is_endless else trajectory[:4]
    ends_us = [*(part.start_us for part in parts[1:]), None]
    for part, end_us in zip(parts, ends_us, strict=True):
        middle_us = part.start_us + 100 * MS_US if end_us is None else (part.start_us + end_us) // 2
        assert trajectory.find_segment(middle_us) == part
        assert trajectory.find_segment_end_us(middle_us) == end_us
