"""What a recording tells of a former tick: rows, marks of the pen, what stands out."""

from __future__ import annotations

import tracemalloc
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.app.app_help import program
from tests.running import PATIENCE_S
from tuisim.app.timeline import Timeline
from tuisim.engine.core.pen_marks import MarkedField, PenMarks
from tuisim.engine.runs.brick_state import LED_NAMES, build_led_row
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording, RowIndex
from tuisim.engine.runs.records import Mark, OutputWriter, Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.views import OutputView
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

pytestmark = pytest.mark.usefixtures("home")


def index_of(folder: Path, rows: list[tuple[int, Stream, str]]) -> RowIndex:
    """Write rows (tick, stream, text) and take them all in."""
    writer = OutputWriter(folder)
    for tick, stream, text in rows:
        writer.write(text.encode(), tick, tick * 10_000_000, 3, stream)
    writer.close()
    index = RowIndex(OutputView(folder))
    assert len(index.take(2)) == min(2, len(rows))
    index.take(1_000_000)
    return index


def test_the_line_of_a_sample_is_that_of_the_last_one_in_its_tick(tmp_path: Path) -> None:
    rows = [(4, "a: 1", 2), (5, "a: 2", 3), (5, "b: 1", 4), (5, "a: 3", 5), (6, "a", 6)]
    writer = OutputWriter(tmp_path)
    for tick, text, line in rows:
        writer.write(text.encode(), tick, tick * 10_000_000, line, Stream.STDOUT)
    writer.close()
    index = RowIndex(OutputView(tmp_path))
    index.take(9)
    assert [index.find_line("a", tick) for tick in (3, 4, 5, 6)] == [0, 2, 5, 0]
    assert [index.find_line("b", tick) for tick in (4, 5)] == [0, 4]


def test_rows_printed_until_a_tick_are_found(tmp_path: Path) -> None:
    leds = [build_led_row(dict.fromkeys(LED_NAMES, light)) for light in (0, 9)]
    index = index_of(
        tmp_path,
        [
            (0, Stream.STDOUT, "a"),
            (5, Stream.LED, leds[0]),
            (5, Stream.STDOUT, "b"),
            (7, Stream.LED, leds[1]),
            (9, Stream.STDOUT, "c"),
        ],
    )
    assert [index.until(tick) for tick in (0, 4, 5, 8, 9, 99)] == [1, 1, 3, 4, 5, 5]
    texts = {
        tick: [row.text for row in index.list_texts(index.until(tick), 2)[0]] for tick in (0, 6, 99)
    }
    assert texts == {0: ["a"], 6: ["a", "b"], 99: ["b", "c"]}
    assert index.list_texts(index.until(99), 2)[1] == 1
    assert [row.text for row in index.rows(3)] == [leds[1], "c"]
    assert [row.text for row in index.rows(1, -1)] == [leds[0], "a"]
    assert [index.row(number).text for number in index.list_face_numbers(6)] == [leds[0]]
    assert index.list_ticks(3) == [0, 5, 5, 7, 9]


def test_the_line_that_printed_a_sample_is_found_in_its_tick(tmp_path: Path) -> None:
    samples = [(2, Stream.STDOUT, "A: 1"), (5, Stream.STDOUT, "B: 1")]
    index = index_of(tmp_path, samples)
    assert [index.find_line("A", tick) for tick in (1, 2, 3, 5)] == [0, 3, 0, 0]
    assert index.find_line("B", 5) == 3


def test_the_timeline_marks_each_new_level_and_error_once(tmp_path: Path) -> None:
    values = [100, 100, 99, 50, 50, 51, 100]
    rows = [(10 * at, Stream.STDOUT, f"Colour: {value}") for at, value in enumerate(values)]
    index = index_of(
        tmp_path, [*rows, (90, Stream.STDERR, "Traceback"), (90, Stream.STDERR, "NameError")]
    )
    assert index.marks == [
        (20, Mark.SAMPLE),
        (30, Mark.SAMPLE),
        (60, Mark.SAMPLE),
        (90, Mark.ERROR),
    ]


def stored(
    text: str, choices: Mapping[str, Any] | None = None, prelude: str = "preloaded"
) -> StoredRun:
    spec = build_run_spec(Settings({"background": "Grey_bands", **(choices or {})}))
    run = start_run(replace(program(text), prelude=prelude), spec, RunOptions())
    assert run.wait(PATIENCE_S)
    return RunStore().load_run(run.run_id)


def test_sensors_at_a_past_instant_see_only_the_pen_line_drawn_by_then() -> None:
    run = stored("tank_drive.on_for_seconds(50, 50, 0.6)\n", {"pen.down": True, "pen_marks": True})
    mat = run.open_mat()
    recording = Recording(run)
    records = run.telemetry.array().tolist()
    for tick in (30, 30, 31, 0, 59):
        drawn = PenMarks(mat, run.spec)
        drawn.add_records(records[: tick + 1])
        seen = recording.find_field(tick, mat)
        assert isinstance(seen, MarkedField)
        assert (seen.marks, seen.blocks) == (drawn.field.marks, drawn.field.blocks)


def test_the_pen_of_a_long_run_takes_little_memory() -> None:
    run = stored("import time\ntime.sleep(100)\n", {"pen.down": True, "pen_marks": True})
    mat = run.open_mat()
    recording = Recording(run)
    assert recording.newest >= 10_000
    tracemalloc.start()
    try:
        recording.find_field(10_000, mat)
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
    finally:
        tracemalloc.stop()


def test_a_timeline_marks_what_the_user_and_breakpoints_did() -> None:
    timeline = Timeline()
    recording = Recording(stored("tank_drive.on_for_seconds(50, 50, 1)\n"))
    timeline.show_run(recording)
    assert recording.name == f"run {recording.number}"
    timeline.breaks.append(40)
    assert timeline.list_marks() == [(40, "break")]
    timeline.go(30)
    timeline.play(10.0)
    assert not timeline.advance_playback(10.2, 1.0)
    assert timeline.at == 50
    assert not timeline.advance_playback(10.3, 2.0)
    assert timeline.at == 70
    assert timeline.advance_playback(12.0, 0.0)
    assert not timeline.playing
    assert timeline.record() is None


DRIVE = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait
base = DriveBase(Motor(Port.B), Motor(Port.C), 56, 118)
base.drive({speed}, 0)
wait(9000)
"""


@pytest.mark.parametrize("speed, stalls", [(0, False), (300, True)])
def test_wheels_that_rest_under_control_are_not_stalled_and_wheels_at_a_wall_are(
    speed: int, stalls: bool
) -> None:
    choices = {"profile": "lego-micropython", "solid": True}
    run = stored(DRIVE.format(speed=speed), choices, "none")
    recording = Recording(run)
    assert recording.stalled(run.telemetry.record(800)) == (stalls, stalls)
