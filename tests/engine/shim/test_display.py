"""What the brick shows of a program's picture and text, as it is written down."""

from __future__ import annotations

import pytest

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.table_display import DISPLAY, FRAME_BUFFER
from tests.engine.shim.test_console import SCREENS
from tests.running import Done
from tuisim.engine.runs.brick_state import BLANK, DISPLAY_WIDTH, ROW_BYTES, BrickState
from tuisim.engine.runs.records import OutputRow, Stream

EXERCISED = {
    "ev3dev2.console:Console.text_at",
    "ev3dev2.console:Console.clear_to_eol",
    "ev3dev2.console:Console.reset_console",
}
"""Items that only these tests exercise."""

PICTURE = """
from ev3dev2.display import Display
import time
d = Display()
d.point(x=1, y=0)
time.sleep(1)
d.update()
d.update()
d.image.putpixel((177, 127), 127)
d.image.putpixel((176, 127), 128)
d.update()
print('done')
"""


def shown(done: Done) -> list[OutputRow]:
    """Return the rows about the screen."""
    return [
        row
        for row in done.run.output.read_all_rows()
        if row.stream in (Stream.DISPLAY, Stream.CONSOLE)
    ]


def dark(row: OutputRow) -> set[tuple[int, int]]:
    """Return the dark pixels of a picture's row."""
    picture = BrickState().update_face([row]).picture
    assert len(picture) == len(BLANK)
    bits = ((at, bit) for at, byte in enumerate(picture) for bit in range(8) if byte << bit & 0x80)
    return {(at % ROW_BYTES * 8 + bit, at // ROW_BYTES) for at, bit in bits}


def test_a_display_update_is_recorded_when_it_is_done(run_on: RunOn) -> None:
    done = run_on(PICTURE)
    first, second = shown(done)
    assert (dark(first), dark(second)) == ({(1, 0)}, {(1, 0), (DISPLAY_WIDTH - 1, 127)})
    # Two more updates of 10 ms lie between them, of which one changed nothing.
    assert (first.line, second.line, second.time_ns - first.time_ns) == (7, 11, 20_000_000)
    assert first.time_ns >= 1_010_000_000
    assert done.lines == ["done"]


def test_the_text_screen_shows_the_right_text_after_each_console_call(run_on: RunOn) -> None:
    lines = ["from ev3dev2.console import Console", "c = Console()", *SCREENS]
    done = run_on("\n".join([*lines, "print('done')"]))
    faces = {row.line: BrickState().update_face([row]).text for row in shown(done)}
    found = {}
    for number, statement in enumerate(lines[1:], 2):
        # What leaves the screen as it was is not written down.
        text = faces.get(number) or faces[number - 1]
        faces[number] = text
        assert text is not None
        found[statement] = ("|".join(text.lines), text.inverse)
    assert {statement: found[statement] for statement in SCREENS} == SCREENS
    assert (done.lines, done.errors) == (["done"], [])


def test_the_brick_shows_picture_or_text_whichever_was_drawn_last(run_on: RunOn) -> None:
    done = run_on(
        "from ev3dev2.console import Console\nfrom ev3dev2.display import Display\n"
        "d = Display()\nd.update()\nc = Console()\nc.text_at('x')\nd.update()\nc.text_at('x')"
    )
    assert [(row.line, row.stream) for row in shown(done)] == [
        (4, Stream.DISPLAY),
        (5, Stream.CONSOLE),
        (6, Stream.CONSOLE),
        (7, Stream.DISPLAY),
        (8, Stream.CONSOLE),
    ]


def test_a_font_that_is_not_there_is_told(run_on: RunOn) -> None:
    done = run_on("from ev3dev2.console import Console\nprint(Console('nonsense').columns)")
    assert (done.lines, done.errors) == (["14"], ["setfont: cannot find the font 'nonsense'"])


@pytest.mark.slow_cases("volume-*", "console-nbev3devsim")
@pytest.mark.parametrize("profile", ["ev3", "nbev3devsim"])
@pytest.mark.parametrize(
    "text",
    [
        "from ev3dev2.display import Display\nd = Display()\nany(d.update() for _ in iter(int, 1))",
        "from ev3dev2.console import Console\nc = Console()\nany(c.text_at('x') for _ in iter(int, 1))",
        "from ev3dev2.sound import Sound\ns = Sound()\nany(s.set_volume(9) for _ in iter(int, 1))",
        "from ev3dev2.sound import Sound\nSound().speak('', play_type=2)",
    ],
    ids=["display", "console", "volume", "sound for ever"],
)
def test_an_endless_loop_of_drawing_calls_reaches_the_time_limit(
    run_on: RunOn, text: str, profile: str
) -> None:
    done = run_on(text, profile=profile, time_limit_s=2.0)
    assert done.ended.end == "time_limit"


def test_pillow_is_imported_for_the_display_only(run_on: RunOn) -> None:
    text = (
        "import sys\nfrom ev3dev2 import motor, sound, console\nfrom ev3dev2.sensor import lego\n"
    )
    done = run_on(
        text + "print('PIL' in sys.modules)\nimport ev3dev2.display\nprint('PIL' in sys.modules)"
    )
    assert done.lines == ["False", "True"]


TABLES: Tables = {
    "display": (DISPLAY, "plain", "empty"),
    "frame buffer": (FRAME_BUFFER, "plain", "empty"),
}


@cases(TABLES)
def test_the_display_shows_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
