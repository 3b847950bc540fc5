"""Pixel arrays in the log, line by line while a program runs."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tests.notebook.conftest import Cell
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.store import RunStore
from tuisim.notebook.image_log import parse_side

LINES = [
    ("image_data left", "left"),
    ("image_data both", "both"),
    ("image_data: right ", "right"),
    ("IMG_DATA left", "left"),
    ("IMG_DATA", "both"),
    ("image_data", ""),
    ("image_data up", ""),
    ("an image_data left", ""),
]


@for_rows("text, side", LINES)
def test_a_printed_line_image_data_names_the_sensor_sides_to_log(text: str, side: str) -> None:
    assert parse_side(OutputRow(text, 0, 0, 1, Stream.STDOUT)) == side
    assert parse_side(OutputRow(text, 0, 0, 1, Stream.STDERR)) == ""


def program(text: str, words: str = "") -> str:
    return f"%%sim_magic_preloaded -b Grey_bands -x 300 -RWH {words}\n{text}"


SIDES = "[record.partition(' ')[0] for record in roboSim.raw_image_data]"
RECORDS = [("left", ["left"]), ("right", ["right"]), ("both", ["left", "right"])]


@pytest.mark.parametrize("side, sides", RECORDS, ids=[side for side, _ in RECORDS])
def test_logging_pixel_arrays_makes_a_record_for_each_side(
    side: str, sides: list[str], cell: Cell
) -> None:
    shown = cell(program(f"print('image_data {side}')"))
    assert shown.out == f"{side} image data logged...\n"
    assert cell(SIDES).result == sides


@pytest.mark.slow
def test_logged_pixel_arrays_add_up_until_they_are_cleared(cell: Cell) -> None:
    cell(program("print('image_data left')\nprint('IMG_DATA left')"))
    cell(program("print('image_data right')"))
    assert cell(SIDES).result == ["left", "right"]
    assert list(cell("roboSim.images()").result.side) == ["left", "left", "right"]
    cell("roboSim.clear_datalog()")
    assert cell("roboSim.raw_image_data").result == []
    cell(program("print('image_data right')"))
    assert cell(SIDES).result == ["right"]


def test_the_output_panel_shows_what_the_cell_did(cell: Cell) -> None:
    cell(program("print('image_data left')"))
    assert "left image data logged..." in cell("%sim_magic -WHO").plain


HANDLER = "seen = []\ndef handle(count):\n    seen.append((count, len(roboSim.raw_image_data)))\n"
LOGGER = "from ev3dev2_glue import pyState\nfor i in range(2):\n    print('image_data both')\nprint(pyState())"


def test_the_live_image_handler_is_called_after_each_logged_pixel_array(cell: Cell) -> None:
    cell(f"{HANDLER}roboSim.live_image_handler = handle")
    shown = cell(program(LOGGER))
    # The program is further by then: a handler sees what was logged up to its record.
    assert cell("seen").result == [(1, 1), (2, 2), (3, 3), (4, 4)]
    assert shown.out == "both image data logged...\n" * 2 + "{'messages': []}\n"


def test_a_live_image_handlers_answer_is_sent_to_the_program(cell: Cell) -> None:
    cell("roboSim.live_image_handler = lambda count: 'JSON::[2]' if count == 2 else ''")
    assert cell(program(LOGGER)).out == (
        "both image data logged...\nPY RESPONSE\nJSON::[2]\nboth image data logged...\n{'messages': [[2]]}\n"
    )


def test_a_live_image_handler_that_is_no_function_is_refused(cell: Cell) -> None:
    cell("roboSim.live_image_handler = 3")
    assert (
        cell(program(LOGGER)).err
        == "tuisim: roboSim.live_image_handler: must be a function, got 3\n"
    )


def test_the_live_image_handler_may_clear_the_log(cell: Cell) -> None:
    cell(
        "seen = []\ndef handle(count):\n    seen.append(count)\n    if count == 3:\n        roboSim.clear_datalog()\n"
        "roboSim.live_image_handler = handle"
    )
    cell(program(LOGGER))
    assert cell("seen").result == [1, 2, 3, 0]
    assert cell(SIDES).result == ["right"]


def test_pixel_arrays_printed_before_an_interrupt_are_still_logged(
    cell: Cell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tuisim.notebook.cell_run.ROWS_AT_ONCE", 2)
    monkeypatch.setattr("tuisim.notebook.cell_run.ROWS_AFTER_INTERRUPT", 0)

    cell(
        "import signal\nroboSim.live_image_handler = lambda count: signal.raise_signal(signal.SIGINT)"
    )
    shown = cell(program("for i in range(400):\n    print('image_data left')"))
    assert "… and more lines" in shown.err
    # The interrupt may have stopped the program before its last line.
    printed = RunStore().load_run(RunStore().runs()[-1].id).output.read_all_rows()
    assert len(cell("roboSim.raw_image_data").result) == len(printed)
