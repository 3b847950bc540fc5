"""Stored runs done again give the same bits: varied programs, noise, threads, users' actions, stopped ones."""

from __future__ import annotations

import json
import os
import random
import signal
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import Start, over, run_live_and_headless, until, until_tick
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.commands.rerun import rerun, same
from tuisim.engine.protocol import Answer, Message, SetButtons, SetNoise, SetPen, SetPose
from tuisim.engine.runs.brick_state import BrickState
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.side_files import MODULES_FILE, STOP_FILE
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

LOOP = """
import random, time
for turn in range({turns}):
    tank_drive.on(SpeedPercent(random.randint(-{speed}, {speed})), SpeedPercent({speed}))
    print('Light:', colorLeft.reflected_light_intensity_pc, time.time())
    time.sleep(random.random() * 0.1)
"""
MOVES = """
for turn in range({turns} // 5):
    tank_drive.on_for_rotations({speed}, {speed} - 10, 0.3)
    tank_turn.on_for_degrees(-100, {speed}, 90)
    print('Gyro:', gyro.angle)
"""
THREADS = """
import threading, time
def watch():
    for turn in range({turns}):
        print('Far:', ultrasonic.distance_centimeters)
        time.sleep(0.02)
watcher = threading.Thread(target=watch)
watcher.start()
for turn in range({turns} // 4):
    tank_drive.on_for_seconds({speed}, -20, 0.05)
watcher.join()
"""
ASKS = """
for turn in range({turns} // 10):
    tank_drive.on_for_seconds({speed}, 30, 0.1)
    print('hello', input('who? '))
"""
RAISES = LOOP + "raise ValueError('over')\n"
PROGRAMS = (LOOP, MOVES, THREADS, ASKS, RAISES)
WAYS = ("headless", "live", "stopped", "limited")


def _action(chance: random.Random) -> Message:
    return chance.choice(
        (
            SetPose(
                chance.uniform(100, 2000), chance.uniform(100, 1000), chance.uniform(-180, 180)
            ),
            SetNoise(chance.randint(0, 128), chance.randint(0, 500)),
            SetPen(chance.random() < 0.5),
            SetButtons(("enter", "up") if chance.random() < 0.5 else ()),
        )
    )


@pytest.mark.quick_cases("1", "2", "3")
@pytest.mark.parametrize("number", range(10))
def test_a_rerun_gives_the_same_bits(number: int, start: Start, tmp_path: Path) -> None:
    chance = random.Random(number)
    way = WAYS[number % len(WAYS)]
    text = PROGRAMS[number % len(PROGRAMS)].format(
        turns=chance.randint(20, 40), speed=chance.randint(20, 60)
    )
    live = way in ("live", "stopped")
    answers = () if live else ("Ada",) * 2
    handle = start(
        text,
        seed=number,
        noise=(chance.randint(0, 40), chance.randint(0, 100)),
        profile=chance.choice(("robolab", "nbev3devsim", "ev3")),
        live=live,
        speed=8.0,
        asks_user=live,
        answers=answers,
        time_limit_s=0.5 if way == "limited" else 30.0,
    )
    if live:
        for at in range(3):
            until_tick(handle, 5 + 6 * at)
            handle.send(_action(chance))
            handle.send(Answer(f"name {at}"))
    if way == "stopped":
        until_tick(handle, 25)
        handle.stop()
    elif live:
        for _ in range(4):
            handle.send(Answer("more"))
    over(handle)
    stored = RunStore().load_run(handle.run_id)
    store = RunStore(tmp_path)
    again = rerun(stored, store)
    over(again)
    found = same(stored, store.load_run(again.run_id))
    assert found.same, (way, text, found)


CLEANS_UP = """
import time
try:
    while True:
        tank_drive.on(20, 40)
        time.sleep(0.05)
        print('Light:', colorLeft.reflected_light_intensity_pc)
finally:
    tank_drive.on_for_seconds(-30, 10, 0.3)
    print('Far:', ultrasonic.distance_centimeters)
"""


@pytest.mark.parametrize("live", [True, False], ids=["live", "headless"])
def test_a_rerun_stops_a_stopped_run_at_the_same_tick(
    start: Start, tmp_path: Path, live: bool
) -> None:
    text = CLEANS_UP if live else CLEANS_UP.replace("time.sleep(0.05)", "time.sleep(1e6)")
    handle = start(text, noise=(10, 20), live=live, time_limit_s=0.0)
    until_tick(handle, 20)
    handle.stop()
    assert over(handle).ended.end == "stopped"
    stored = RunStore().load_run(handle.run_id)
    assert any(row.text.startswith("Far:") for row in stored.output.rows())
    stopped_at = json.loads((handle.folder / STOP_FILE).read_text())["tick"]
    assert stored.telemetry.count > stopped_at + 30
    store = RunStore(tmp_path)
    again = rerun(stored, store)
    assert over(again).ended.end == "stopped"
    second = store.load_run(again.run_id)
    assert second.telemetry.array().tobytes() == stored.telemetry.array().tobytes()
    assert second.output.read_all_rows() == stored.output.read_all_rows()
    assert same(stored, second).same
    (stored.folder / STOP_FILE).write_text("rubbish")
    with pytest.raises(LogError, match=STOP_FILE):
        rerun(stored, store)


def test_a_run_stopped_before_its_first_tick_can_be_rerun_also_with_30_ticks_a_second(
    start: Start, tmp_path: Path
) -> None:
    handle = start(
        "tank_drive.on(20, 20)\nwhile True: pass",
        live=True,
        profile="nbev3devsim",
        start_paused=True,
    )
    until(handle, lambda: handle.paused)
    handle.send(SetPen(True))
    until(handle, lambda: handle.telemetry.record(0).actions == 1)
    handle.stop()
    over(handle)
    stored = RunStore().load_run(handle.run_id)
    again = rerun(stored, RunStore(tmp_path))
    assert over(again).ended.end == "stopped"
    assert same(stored, again.stored()).same


def test_a_killed_run_is_compared_up_to_its_last_record(start: Start, tmp_path: Path) -> None:
    handle = start(CLEANS_UP, live=True)
    until_tick(handle, 20)
    os.kill(handle._process.pid, signal.SIGKILL)
    assert over(handle).ended.end == "crashed"
    stored = RunStore().load_run(handle.run_id)
    store = RunStore(tmp_path)
    again = rerun(stored, store)
    over(again)
    second = store.load_run(again.run_id)
    assert second.telemetry.count > 20
    assert same(stored, second).same


ARM = """
from ev3dev2.motor import MediumMotor, OUTPUT_A
from ev3dev2.sensor.lego import InfraredSensor
import time
arm = MediumMotor(OUTPUT_A)
arm.on(50)
time.sleep(0.1)
arm.position = 7
arm.on_for_degrees(20, -90)
time.sleep(0.0137)
"""


ENDS_BETWEEN_LOOKS = """
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)
light = ColorSensor()
tank.on_for_seconds(30, 30, 1)
print('Light:', light.reflected_light_intensity)
"""
STARTS_AND_STOPS = """
from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor
left = LargeMotor(OUTPUT_B)
right = LargeMotor(OUTPUT_C)
arm = MediumMotor(OUTPUT_A)
light = ColorSensor()
left.on_for_degrees(30, 90)
arm.on(-50)
print('Light:', light.reflected_light_intensity, left.position, right.speed, arm.state)
arm.off()
print('Light:', light.reflected_light_intensity, left.position, right.speed, arm.state)
"""


@cases(
    "text, choices",
    {
        "both wheels": (ENDS_BETWEEN_LOOKS, {"profile": "ev3"}),
        "an arm": (STARTS_AND_STOPS, {"profile": "robolab", "robot": "Explorer"}),
    },
)
def test_a_program_does_the_same_live_and_headless(
    home: Path, text: str, choices: dict[str, str]
) -> None:
    _, diff = run_live_and_headless(Program("p.py", text), choices)
    assert diff.same


def test_a_blocked_motor_is_recorded_the_same_live_and_headless(home: Path) -> None:
    run, diff = run_live_and_headless(Program("arm.py", ARM), {"robot": "Explorer"})
    turns = [row for row in run.output.rows() if row.stream == Stream.MOTORS]
    ((position_deg, speed_dps),) = BrickState().update_face(turns).turns
    assert (round(position_deg), speed_dps) == (-83, 0.0)
    assert diff.same


def test_a_run_that_cannot_be_prepared_is_not_listed(home: Path, tmp_path: Path) -> None:
    program = Program("program.py", "print('A: 1')", modules_from=tmp_path)
    # Not the file that it should be.
    (tmp_path / MODULES_FILE).mkdir()
    with pytest.raises(LogError, match="cannot be copied"):
        start_run(program, build_run_spec(Settings()), RunOptions())
    assert RunStore().runs() == []


def test_a_run_without_a_tick_cannot_be_done_again(tmp_path: Path) -> None:
    new = RunStore().create_run(Program("p.py", "print(1)"), build_run_spec(Settings()))
    with pytest.raises(LogError, match="has no recording: it ended before its first tick"):
        rerun(RunStore().load_run(new.id), RunStore(tmp_path))
