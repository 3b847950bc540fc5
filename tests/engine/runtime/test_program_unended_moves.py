"""What a program leaves its motors to do when it ends: a brick's driver ends its moves, the rest is named."""

from __future__ import annotations

from tests.cases import cases
from tests.running import Run, Start, over, until_tick

_EV3DEV2 = (
    "from ev3dev2.motor import LargeMotor, MoveTank\n"
    "from time import sleep\n"
    "left, right = LargeMotor('outB'), LargeMotor('outC')\n"
)
_LEFT_AND_RIGHT = "ended while outB and outC were still set to turn"
LEFT = {
    "a tank": ("MoveTank('outB', 'outC').on(50, 50)", "ev3", _LEFT_AND_RIGHT),
    "one motor": (
        "right.run_direct(duty_cycle_sp=-30)",
        "ev3",
        "ended while outC was still set to turn",
    ),
    "an exit": (
        "left.on(10); right.on(10); raise SystemExit(2)",
        "ev3",
        f"the program ended itself with exit code 2; {_LEFT_AND_RIGHT}",
    ),
    "a stop": ("left.on(50); sleep(1); left.off()", "ev3", ""),
    "speed 0": ("left.on(0)", "ev3", ""),
    "an exit function": ("import atexit; atexit.register(left.off); left.on(50)", "ev3", ""),
    "an error": ("left.on(50); 1 / 0", "ev3", "ZeroDivisionError: division by zero"),
    "the course's rules": ("left.on(50)", "robolab", ""),
}


@cases("text, profile, summary", LEFT)
def test_motors_that_run_for_ever_are_named(
    run: Run, text: str, profile: str, summary: str
) -> None:
    assert run(_EV3DEV2 + text, profile=profile).ended.summary.startswith(summary)


MOVES = {
    "for a time": ("left.run_timed(speed_sp=300, time_sp=2000)", 1.99, (680, 0)),
    "to a position": ("left.run_to_rel_pos(speed_sp=300, position_sp=600)", 1.99, (670, 0)),
    "the longer one": (
        "left.on_for_degrees(20, 90, block=False); right.on_for_seconds(20, 3, block=False)",
        2.99,
        (90, 630),
    ),
    "a ramp to its end": (
        "left.run_forever(speed_sp=500, ramp_down_sp=2000); sleep(1); left.stop()",
        1.9,
        (740, 0),
    ),
}


@cases("text, least_s, turned", MOVES)
def test_a_move_still_under_way_at_the_programs_end_is_completed(
    run: Run, text: str, least_s: float, turned: tuple[int, int]
) -> None:
    done = run(_EV3DEV2 + text, profile="ev3")
    assert (done.ended.end, done.ended.summary) == ("finished", "")
    assert least_s < done.ended.time_ns / 1e9 < least_s + 0.7
    last = done.run.telemetry.last()
    assert last is not None
    wheels = last.left_position_deg, last.right_position_deg
    assert all(abs(is_deg - must) < 40 for is_deg, must in zip(wheels, turned, strict=True))


BOTH = "left.on_for_degrees(30, 500, block=False); right.on_for_degrees(30, 500)"
RESTS = {
    "held": (BOTH, 0.5),
    "rolling out": (f"{BOTH.replace(')', ', brake=False)')}", 0.5),
    "held while it ran": ("left.on(50); sleep(1); left.off()", 0.5),
    "at rest": (f"{BOTH}; sleep(1)", 0.0),
    "never moved": ("sleep(1)", 0.0),
}


@cases("text, most_s", RESTS)
def test_a_run_lasts_until_its_wheels_have_come_to_rest(run: Run, text: str, most_s: float) -> None:
    done = run(_EV3DEV2 + text, profile="ev3")
    alone = run(f"{_EV3DEV2}{text}; left.on(5)", profile="ev3")
    rests_s = (done.ended.time_ns - alone.ended.time_ns) / 1e9
    assert (done.ended.end, 0 < rests_s if most_s else rests_s <= 0) == ("finished", True)
    assert rests_s <= most_s
    *_, before, last = done.run.telemetry.array()
    assert abs(before["x_mm"] - last["x_mm"]) < 0.01


def test_wheels_rolling_out_at_the_end_do_not_make_a_run_hit_the_time_limit(run: Run) -> None:
    text = _EV3DEV2 + "left.on(50); sleep(1); left.off()"
    done = run(text, profile="ev3", time_limit_s=1.05)
    assert (done.ended.end, done.ended.time_ns) == ("finished", 1_050_000_000)


def test_in_the_course_profile_a_run_ends_at_once_with_its_program(run: Run) -> None:
    done = run(_EV3DEV2 + "left.on(50); sleep(1); left.off()", profile="robolab")
    assert done.ended.time_ns < 1_010_000_000


def test_a_move_that_goes_on_after_the_program_ends_at_the_time_limit(run: Run) -> None:
    done = run(
        _EV3DEV2 + "left.on_for_seconds(20, 9, block=False)", profile="ev3", time_limit_s=2.0
    )
    assert (done.ended.end, done.ended.time_ns) == ("time_limit", 2_000_000_000)


def test_a_daemon_thread_stops_when_the_program_ends(run: Run) -> None:
    done = run(
        "import threading\n"
        + _EV3DEV2
        + "def talk():\n    while True:\n        sleep(0.5)\n        print('on')\n"
        "threading.Thread(target=talk, daemon=True).start()\n"
        "left.on_for_seconds(20, 2, block=False)\n",
        profile="ev3",
    )
    assert (done.lines, done.ended.time_ns > 1.9e9) == ([], True)


def test_a_live_run_ends_at_the_same_time_as_one_in_the_background(run: Run) -> None:
    text = _EV3DEV2 + "left.on_for_degrees(30, 200, block=False); right.on(10)"
    live = run(text, profile="ev3", live=True, speed=0.0)
    background = run(text, profile="ev3")
    assert live.ended.summary == "ended while outC was still set to turn"
    assert (live.ended.time_ns, live.ended.summary, live.recording) == (
        background.ended.time_ns,
        background.ended.summary,
        background.recording,
    )


def test_the_user_stops_a_move_that_goes_on(start: Start) -> None:
    handle = start(
        _EV3DEV2 + "left.run_timed(speed_sp=100, time_sp=100_000)", profile="ev3", live=True
    )
    until_tick(handle, 20)
    handle.stop()
    done = over(handle)
    assert (done.ended.end, done.ended.time_ns < 100e9) == ("stopped", True)
