"""What the brick's lights show, as it is written down."""

from __future__ import annotations

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.table_led import LED
from tests.running import Done
from tuisim.engine.runs.brick_state import BrickState
from tuisim.engine.runs.records import OutputRow, Stream

STEPS = """\
from ev3dev2.led import Leds
import time
leds = Leds()
leds.reset()
leds.set_color('LEFT', 'AMBER')
leds.set_color('LEFT', 'AMBER')
time.sleep(1)
leds.leds['green_right'].brightness = 0
"""

BLINKING = """\
from ev3dev2.led import Leds
from ev3dev2.motor import LargeMotor
red = Leds().leds['red_left']
red.trigger = 'timer'
red.delay_on = 100
LargeMotor('outB').on_for_seconds(10, 1.25)
red.brightness = 0
print('dark')
"""


def rows(done: Done) -> list[OutputRow]:
    """Return the rows about the lights."""
    return [row for row in done.run.output.read_all_rows() if row.stream == Stream.LED]


def lights(row: OutputRow) -> tuple[int, ...]:
    """Return left red, left green, right red, right green."""
    return tuple(BrickState().update_face([row]).leds.values())


def test_each_change_of_a_light_is_recorded_once_with_its_line(run_on: RunOn) -> None:
    done = run_on(STEPS)
    assert [(row.line, lights(row)) for row in rows(done)] == [
        (5, (255, 255, 0, 255)),
        (8, (255, 255, 0, 0)),
    ]
    first, last = rows(done)
    assert last.time_ns - first.time_ns == 1_000_000_000
    assert list(BrickState().update_face([first]).leds) == [
        "left red",
        "left green",
        "right red",
        "right green",
    ]


def test_each_change_of_a_blinking_light_is_recorded(run_on: RunOn) -> None:
    done = run_on(BLINKING)
    found = [(row.time_ns // 10_000_000, lights(row)[0]) for row in rows(done)]
    assert found == [(0, 255), (10, 0), (60, 255), (70, 0), (120, 255), (125, 0)]
    assert done.lines == ["dark"]


def test_blinking_does_not_change_which_line_lets_time_pass(run_on: RunOn) -> None:
    done = run_on(BLINKING)
    assert {done.run.telemetry.record(tick).line for tick in range(1, 125)} == {6}


TABLES: Tables = {
    "lights": (LED, "plain", "empty"),
}


@cases(TABLES)
def test_the_lights_show_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
