"""What is heard of a program's sounds: in words for people, as tones for a loudspeaker."""

from __future__ import annotations

import json

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import FAR_WALL, PLAIN, RunOn
from tests.engine.shim.table_sound import FILE, HEARD, SOUND
from tuisim.base.source import Program
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import Spoke
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.records import Stream


def test_each_sound_call_is_recorded_in_words_and_tones() -> None:
    program = Program("program.py", "\n".join([FILE, *HEARD]), "none")
    run = start_run(program, RunSpec(PLAIN, FAR_WALL, PROFILES["ev3"]), RunOptions(live=False))
    events = []
    while run.ended is None:
        run.wait_for_event(10.0)
        events += run.pump()
    run.close()
    spoken = [event for event in events if isinstance(event, Spoke)]
    found = [(event.text, json.loads(event.tones or "[]")) for event in spoken]
    assert found == [(words, json.loads(tones or "[]")) for words, tones in HEARD.values()]
    files = [event.file.rpartition("/") for event in spoken if event.file]
    assert [(folder[:1], name) for folder, _, name in files] == [("/", "bark.wav")]


def test_a_sound_in_the_background_overlaps_the_next(run_on: RunOn) -> None:
    done = run_on(
        "from ev3dev2.sound import Sound\nimport time\ns = Sound()\n"
        "p = s.tone(440, 2000, play_type=1)\ns.tone(880, 500)\nprint(p.poll(), p.wait(), round(time.time() % 60, 2))"
    )
    rows = [
        (row.text, row.time_ns)
        for row in done.run.output.read_all_rows()
        if row.stream == Stream.SPEECH
    ]
    assert rows == [("[tone 440 Hz 2 s]", 0), ("[tone 880 Hz 0.5 s]", 0)]
    assert done.lines == ["None 0 2.0"]


def test_a_song_is_heard_up_to_its_wrong_note(run_on: RunOn) -> None:
    done = run_on("from ev3dev2.sound import Sound\nSound().play_song([('D4', 'q'), ('D4', 'z')])")
    assert done.errors[-1] == "ValueError: invalid note (z)"
    assert [row.text for row in done.run.output.read_all_rows() if row.stream == Stream.SPEECH] == [
        "[♪ song of 1 note, 0.6 s]"
    ]
    assert done.ended.time_ns == 550_000_000


def test_a_tone_played_in_a_loop_repeats_until_the_run_stops(run_on: RunOn) -> None:
    done = run_on(
        "from ev3dev2.sound import Sound\nSound().tone(440, 400, play_type=2)", time_limit_s=1.9
    )
    assert done.ended.end == "time_limit"
    assert [row.time_ns // 1_000_000 for row in done.run.output.read_all_rows()] == [
        0,
        400,
        800,
        1200,
        1600,
    ]


def test_a_program_that_imports_everything_keeps_its_own_names(run_on: RunOn) -> None:
    done = run_on(
        "from ev3dev2.sound import *\nfrom ev3dev2.console import *\n"
        "print(os.path.basename('a/b'), os.getpid() > 0)\nsleep(1)\nimport time\nprint(round(time.time() % 60, 2))"
    )
    assert done.lines == ["b True", "1.0"]


def test_threads_take_turns_while_a_song_plays(run_on: RunOn) -> None:
    done = run_on(
        "import threading, time\nfrom ev3dev2.sound import Sound\n"
        "def notes():\n    for note in 'CDE':\n        time.sleep(0.1)\n        yield note + '4', 'q'\n"
        "song = threading.Thread(target=lambda: Sound().play_song(notes(), delay=0))\nsong.start()\n"
        "for _ in range(4):\n    time.sleep(0.07)\n    Sound().tone(880, 10)\n"
        "song.join()\nprint(round(time.time() % 60, 2))"
    )
    assert done.lines == ["1.8"]
    heard = [row.text for row in done.run.output.read_all_rows() if row.stream == Stream.SPEECH]
    assert sorted(heard) == ["[tone 880 Hz 0.01 s]"] * 4 + ["[♪ song of 3 notes, 1.5 s]"]


TABLES: Tables = {
    "sound": (SOUND, "plain", "empty"),
}


@cases(TABLES)
def test_sounds_are_heard_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
