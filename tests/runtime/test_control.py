"""Stop, pause, step, user actions; and what is left when somebody is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from itertools import count
from pathlib import Path

import pytest

from tests.running import PATIENCE_S, Run, Start, until
from tuisim.core.tick_record import TICK_RECORD
from tuisim.errors import HostError
from tuisim.protocol import Answer, Message, Paused, Resume, SetNoise, SetPose, SetSpeed, StepTicks
from tuisim.runs import handle
from tuisim.runs.child import fair_clock
from tuisim.runs.child.events import decode_event
from tuisim.runs.child.fair_clock import computed_s, waited_s

ROOT = Path(__file__).resolve().parents[2]


HARD_TO_STOP = {
    "spin": "while True: pass",
    "sleep": "import time\nwhile True: time.sleep(10)",
    "bare except": "import time\nwhile True:\n    try: time.sleep(0.01)\n    except: pass",
    "regex": "import re\nre.match(r'(a+)+$', 'a' * 60 + 'b')",
    "C call": "sum(range(10**12))",
    "print flood": "i = 0\nwhile True:\n    print('A:', i)\n    i += 1",
    "memory": "x = []\nwhile True:\n    x.append(bytearray(100_000))\n    if len(x) > 5000: x.clear()",
    "threads": "import threading\ndef f():\n    while True: pass\nt = threading.Thread(target=f)\nt.start()\nt.join()",
    "ignores signals": "import signal\nfor n in range(34, 65): signal.signal(n, signal.SIG_IGN)\nwhile True: pass",
    "endless cleaning up": "try:\n    while True: pass\nfinally:\n    while True: pass",
}


@pytest.mark.slow_cases("C call")
@pytest.mark.parametrize("text", HARD_TO_STOP.values(), ids=HARD_TO_STOP)
def test_stop_always_works_and_keeps_what_was_printed(start: Start, text: str) -> None:
    run = start("print('Before: 1')\n" + text, live=True)
    until(run, lambda: run.output.length > 0)
    run.stop()
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "stopped"
    assert run.output.all_rows()[0].text == "Before: 1"


def test_commands_before_the_first_line_wait_for_it(start: Start) -> None:
    run = start("print(colorLeft.color)", live=True)
    run.send(SetPose(1500.0, 500.0, 0.0))
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, [row.text for row in run.output.all_rows()]) == ("finished", ["1"])


def test_stop_before_the_first_line(start: Start) -> None:
    run = start("while True: pass", live=True)
    run.stop()
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "stopped"


@pytest.mark.parametrize("speeds", [(0.0,), (20.0, 0.0), (0.5, 1000.0)], ids=str)
def test_the_speed_may_change_while_a_program_sleeps(start: Start, speeds: tuple[float, ...]) -> None:
    run = start("import time\nprint('A: 1')\ntime.sleep(500)\nprint('A: 2')", live=True, time_limit_s=1000.0)
    until(run, lambda: run.telemetry.count > 1)
    for speed in speeds:
        run.send(SetSpeed(speed))
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, [row.text for row in run.output.all_rows()]) == ("finished", ["A: 1", "A: 2"])


def test_cleaning_up_runs_after_a_stop(start: Start) -> None:
    run = start("import time\ntry:\n    print('A: 1')\n    time.sleep(100)\nfinally:\n    print('clean')", live=True)
    until(run, lambda: run.output.length > 0)
    run.stop()
    run.wait(PATIENCE_S)
    assert [row.text for row in run.output.all_rows()] == ["A: 1", "clean"]


def test_a_program_whose_turn_does_not_come_is_not_taken_for_stuck(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = start("print('A: 1')\n" + HARD_TO_STOP["bare except"], live=True)
    until(run, lambda: run.output.length > 0)
    # So busy a machine that the program has waited far longer at each look, while any time at all is too long.
    waits_s, killed = count(1e6, 1e3), list[int]()
    monkeypatch.setattr(fair_clock, "waited_s", lambda pid: next(waits_s))
    monkeypatch.setattr(handle, "STUCK_AFTER_S", 0.0)
    monkeypatch.setattr(handle, "end_group", killed.append)
    run.stop()
    run.pump()
    run.pump()
    assert not killed


def test_the_time_that_a_process_waits_for_a_processor_is_known() -> None:
    # Two processes for one processor: at least one of them waits.
    only = {min(os.sched_getaffinity(0))}
    spinning = [
        subprocess.Popen([sys.executable, "-c", f"import os; os.sched_setaffinity(0, {only})\nwhile True: pass"])
        for _ in range(2)
    ]
    try:
        give_up = time.monotonic() + PATIENCE_S
        while sum(waited_s(process.pid) for process in spinning) < 0.1:
            assert time.monotonic() < give_up
            time.sleep(0.01)
    finally:
        for process in spinning:
            process.kill()
            process.wait()
    assert waited_s(spinning[0].pid) == computed_s(spinning[0].pid) == 0.0


def test_the_time_that_other_threads_wait_counts_too() -> None:
    busy = f"import os, threading\nos.sched_setaffinity(0, {{{min(os.sched_getaffinity(0))}}})\n"
    busy += "threading.Thread(target=lambda: sum(range(10**12))).start()\nprint(flush=True)\n"
    spinning = [subprocess.Popen([sys.executable, "-c", busy], stdout=subprocess.PIPE) for _ in range(2)]
    try:
        give_up = time.monotonic() + PATIENCE_S
        while sum(waited_s(process.pid) for process in spinning) < 0.1 or not computed_s(spinning[0].pid):
            assert time.monotonic() < give_up
            time.sleep(0.01)
    finally:
        for process in spinning:
            process.kill()
            process.communicate()


def test_pause_steps_and_resume(start: Start) -> None:
    run = start("tank_drive.on(50, 50)\nimport time\ntime.sleep(0.2)", live=True, start_paused=True)
    until(run, lambda: run.paused)
    assert run.telemetry.count == 1
    seen: list[Message] = []
    run.send(StepTicks(3))
    until(run, lambda: any(isinstance(event, Paused) for event in seen), seen)
    assert run.telemetry.count == 4
    assert [event for event in seen if isinstance(event, Paused)][-1].tick == 3
    run.send(Resume())
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, ended.tick) == ("finished", 20)


def test_user_actions_take_effect_right_before_a_tick_and_are_written_down(start: Start) -> None:
    run = start("print(colorLeft.color)", live=True, start_paused=True)
    until(run, lambda: run.paused)
    run.send(SetPose(1500.0, 500.0, 90.0))
    run.send(SetNoise(0, 5))
    run.send(Resume())
    assert run.wait(PATIENCE_S) is not None
    assert [row.text for row in run.output.all_rows()] == ["1"]
    first = run.telemetry.record(0)
    assert (first.x_mm, first.heading_deg, first.actions) == (1500.0, 90.0, 2)
    assert (run.folder / "actions.jsonl").read_text().splitlines() == [
        '{"tick": 0, "kind": "set_pose", "x_mm": 1500.0, "y_mm": 500.0, "heading_deg": 90.0}',
        '{"tick": 0, "kind": "set_noise", "light": 0, "motor": 5}',
    ]


def test_answer_from_the_user(start: Start) -> None:
    run = start("print('hello ' + input('Name? '))", live=True, asks_user=True)
    until(run, lambda: run.waiting_for_input == "Name? ")
    run.send(Answer("Ada"))
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert [row.text for row in run.output.all_rows()] == ["Name? Ada", "hello Ada"]


def test_a_child_that_is_killed_leaves_every_row(start: Start) -> None:
    run = start("import time\nfor i in range(10**6):\n    print('A:', i)\n    time.sleep(0.01)", live=True)
    until(run, lambda: len(run.output.all_rows()) > 5)
    os.kill(run._process.pid, signal.SIGKILL)
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "crashed"
    assert "SIGKILL" in ended.summary
    texts = [row.text for row in run.output.all_rows()]
    assert texts == [f"A: {i}" for i in range(len(texts))]
    assert run.telemetry.count * TICK_RECORD.size > 0


HOST = """
import sys, time
from tests.runtime.test_control import spec
from tuisim.runs.handle import RunOptions, start_run
from tuisim.source import Program
run = start_run(Program("p.py", sys.argv[1], "preloaded"), spec(), RunOptions(live=True))
while run.output.length == 0:
    run.pump()
print(run._process.pid, run.folder, flush=True)
time.sleep(60)
"""


def spec() -> object:
    """A plain run."""
    from tuisim.core.profile import ROBOLAB
    from tuisim.core.spec import RobotSpec, RunSpec, WorldSpec

    return RunSpec(RobotSpec(), WorldSpec(background="Grey_bands"), ROBOLAB)


@pytest.mark.quick_cases("C call")
@pytest.mark.parametrize(
    "text",
    [
        pytest.param("while True: print('A: 1')", id="python"),
        pytest.param("print('A: 1')\nsum(range(10**12))", id="C call"),
    ],
)
def test_child_dies_with_its_host(text: str) -> None:
    command = [sys.executable, "-c", HOST, text]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.PIPE) as host:
        assert host.stdout is not None
        pid, folder = host.stdout.readline().decode().split()
        host.kill()
    killed_at = time.monotonic()
    while Path(f"/proc/{pid}").exists() and _alive(int(pid)):
        assert time.monotonic() - killed_at < PATIENCE_S
        os.sched_yield()
    assert (Path(folder) / "output.bin").exists()


def _alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


@pytest.mark.parametrize(
    "line",
    [
        b"rubbish",
        b"[]",
        b'{"kind":"ended"}',
        b'{"kind":"nonsense"}',
        b'{"kind":"spoke","text":1,"time_ns":2}',
        b"\xff\xfe",
    ],
    ids=["text", "list", "missing", "unknown", "type", "bytes"],
)
def test_rubbish_from_the_child_is_a_host_error(line: bytes) -> None:
    with pytest.raises(HostError):
        decode_event(line)


def test_runs_of_the_same_program_are_told_apart(run: Run) -> None:
    first, second = run("print('A: 1')"), run("print('A: 1')")
    assert first.run.run_id != second.run.run_id
    assert first.run.number + 1 == second.run.number
