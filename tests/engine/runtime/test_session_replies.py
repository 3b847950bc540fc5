"""The host answers `pyState()` and `input()` while simulated time stands still."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from tests.cases import cases
from tests.running import Done, Run, Start, over, until
from tuisim.commands.rerun import rerun, same
from tuisim.engine.protocol import Answer, Message, Reply, UserAction
from tuisim.engine.runs.handle import RunHandle
from tuisim.engine.runs.store import RunStore

GLUE = "from ev3dev2_glue import pyState, get_clock\n"
TALKS = f"""{GLUE}
for turn in range(3):
    tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(30), 0.1)
    before = get_clock()
    print('Heard:', len(pyState()['messages']), pyState()['messages'][-1], get_clock() - before)
"""


def replies() -> Iterator[tuple[Any, ...]]:
    """Two calls a turn: an empty reply, and several at once."""
    yield from ((), ("one",), ({"two": [1, 2.5, None]}, "three"), (), (True,), ())


def talk(run: RunHandle, message: Callable[[], Message], waits: Callable[[], bool]) -> Done:
    """Answer a run, slowly, until it is over."""
    while run.ended is None:
        until(run, lambda: waits() or run.ended is not None)
        if waits():
            ticks = run.telemetry.count
            # What takes real time takes no other.
            assert run.wait(0.03) is None
            assert run.telemetry.count == ticks
            run.send(message())
    return over(run)


def talked(run: RunHandle) -> Done:
    said = replies()
    return talk(run, lambda: Reply(next(said)), lambda: run.waiting_for_reply)


def test_a_program_gets_every_reply_without_simulated_time_passing(start: Start) -> None:
    text = GLUE + "import time\nfor i in range(6):\n    print(pyState())\nprint(get_clock())"
    done = talked(start(text, replies=True))
    assert done.lines[0] == "{'messages': []}"
    assert done.lines[2] == "{'messages': ['one', {'two': [1, 2.5, None]}, 'three']}"
    assert done.lines[5:] == [
        "{'messages': ['one', {'two': [1, 2.5, None]}, 'three', True]}",
        "0.0",
    ]


def test_a_run_with_messages_can_be_repeated(start: Start, tmp_path: Path) -> None:
    text = TALKS.replace("[-1]", "[-1:]")
    first = talked(start(text, replies=True, noise=(3, 50)))
    assert first.lines[0] == "Heard: 0 ['one'] 0.0"
    assert talked(start(text, replies=True, noise=(3, 50))).recording == first.recording
    stored = RunStore().load_run(first.run.run_id)
    scratch = RunStore(tmp_path)
    again = over(rerun(stored, scratch))
    assert same(stored, scratch.load_run(again.run.run_id)).same
    assert again.lines == first.lines


def test_without_a_responder_a_program_gets_no_messages(run: Run) -> None:
    assert run(GLUE + "print(pyState())").lines == ["{'messages': []}"]


def test_a_reply_may_be_larger_than_the_pipe(start: Start) -> None:
    handle = start(GLUE + "print(len(pyState()['messages'][0]))", replies=True)
    until(handle, lambda: handle.waiting_for_reply)
    handle.send(Reply(("x" * 300_000,)))
    assert over(handle).lines == ["300000"]


@cases(
    "text, options",
    {
        "message": (GLUE + "pyState()\nprint('never')", {"replies": True}),
        "input": ("input()\nprint('never')", {"asks_user": True, "time_waits": True}),
        "thread": (
            f"{GLUE}import threading\nthread = threading.Thread(target=pyState)\nthread.start()\nthread.join()\n",
            {"replies": True},
        ),
    },
)
def test_a_stop_ends_a_programs_wait_for_a_reply(
    text: str, options: dict[str, Any], start: Start
) -> None:
    handle = start(text, **options)
    until(handle, lambda: handle.waiting_for_reply or handle.waiting_for_input is not None)
    handle.stop()
    done = over(handle)
    assert (done.ended.summary, done.lines) == ("stopped", [])


def test_an_answer_to_input_takes_no_time_and_comes_again(start: Start, tmp_path: Path) -> None:
    text = f"{GLUE}import time\ntime.sleep(0.105)\nname = input('who? ')\nprint(name, get_clock())\ntime.sleep(0.1)"
    handle = start(text, asks_user=True, time_waits=True)
    done = talk(
        handle, lambda: Answer("Ada", at_once=True), lambda: handle.waiting_for_input is not None
    )
    assert done.lines == ["Ada 0.1"]
    (row,) = map(json.loads, (handle.folder / "actions.jsonl").read_text().splitlines())
    assert UserAction.from_plain(row) == UserAction(10, Answer("Ada", at_once=True))
    stored = RunStore().load_run(handle.run_id)
    scratch = RunStore(tmp_path)
    again = over(rerun(stored, scratch))
    assert same(stored, scratch.load_run(again.run.run_id)).same
