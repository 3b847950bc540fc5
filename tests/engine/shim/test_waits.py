"""Waiting for motors, which the library does by asking again and again."""

from __future__ import annotations

from tests.running import Run

STOPPED_BY_A_THREAD = """\
import threading, time
def stop():
    time.sleep(0.53)
    tank_drive.off()
threading.Thread(target=stop).start()
tank_drive.on_for_rotations(20, 20, 100)
print('waited', time.time() % 1000)
"""


def test_a_move_that_ends_shortly_before_the_limit_is_seen_to_end(run: Run) -> None:
    done = run("tank_drive.on_for_seconds(20, 20, 1.93)\nprint('over')\n", time_limit_s=2.0)
    assert (done.ended.end, done.lines) == ("finished", ["over"])


def test_a_wait_for_a_move_beyond_the_time_limit_ends_with_the_limit(run: Run) -> None:
    done = run("tank_drive.on_for_seconds(20, 20, 100)\n", time_limit_s=12.5)
    assert (done.ended.end, done.ended.time_ns) == ("time_limit", 12_500_000_000)


def test_a_wait_longer_than_many_polls_ends_with_the_move(run: Run) -> None:
    done = run("tank_drive.on_for_seconds(1, 1, 25)\n", time_limit_s=60.0)
    assert (done.ended.end, done.ended.tick) == ("finished", 2500)


def test_a_thread_can_stop_the_motors_that_the_program_waits_for(run: Run) -> None:
    done = run(STOPPED_BY_A_THREAD)
    assert done.ended.end == "finished"
    # The library looks every 0.1 s.
    assert 530_000_000 <= done.ended.time_ns <= 650_000_000
