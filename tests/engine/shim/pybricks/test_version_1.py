"""`pybricks.ev3brick` of version 1.0, in programs."""

from __future__ import annotations

from pathlib import Path

from tests.engine.shim.conftest import RunOn
from tests.engine.shim.test_display import dark, shown
from tuisim.engine.runs.records import Stream

HEAD = (
    "from pybricks import ev3brick as brick\n"
    "from pybricks.parameters import Align, Button, Color, ImageFile, SoundFile\n"
    "from pybricks.tools import print, wait\n"
)
PROFILE = "lego-micropython"


def test_sound_functions_of_version_1_play_in_turn_at_their_times(run_on: RunOn) -> None:
    done = run_on(
        HEAD
        + "brick.sound.beep(1000, 500)\nbrick.sound.beeps(2)\nbrick.sound.tune([(440, 200), (880, 100)])\n"
        "brick.sound.file(SoundFile.HELLO, 100)\nbrick.sound.speech('hi there', volume=50)",
        profile=PROFILE,
    )
    heard = [
        (row.text, row.time_ns // 1_000_000)
        for row in done.run.output.read_all_rows()
        if row.stream == Stream.SPEECH
    ]
    assert heard == [
        ("[tone 1000 Hz 0.5 s]", 0),
        ("[tone 500 Hz 0.1 s]", 500),
        ("[tone 500 Hz 0.1 s]", 700),
        ("[tone 440 Hz 0.2 s]", 900),
        ("[tone 880 Hz 0.1 s]", 1100),
        ("[plays SoundFile.HELLO, 1.0 s]", 1200),
        ("hi there", 2200),
    ]


def test_text_in_version_1_is_drawn_at_its_place_or_below_the_last(run_on: RunOn) -> None:
    done = run_on(
        HEAD
        + "brick.display.text('Hello', (60, 50))\nbrick.display.text('one')\nbrick.display.text('two')\n"
        "brick.display.clear()",
        profile=PROFILE,
    )
    placed, *_, both, cleared = (dark(row) for row in shown(done))
    assert (
        min(placed)[0] >= 60 and 50 <= min(y for _, y in placed) and max(y for _, y in placed) < 65
    )
    assert {y // 15 for x, y in both - placed} == {0, 1}
    assert cleared == set()


PLACES = {
    "Align.TOP_LEFT": (0, 0),
    "Align.TOP": (79, 0),
    "Align.TOP_RIGHT": (158, 0),
    "Align.LEFT": (0, 59),
    "Align.CENTER": (79, 59),
    "Align.RIGHT": (158, 59),
    "Align.BOTTOM_LEFT": (0, 118),
    "Align.BOTTOM": (79, 118),
    "Align.BOTTOM_RIGHT": (158, 118),
    "(5, 6)": (5, 6),
}


def filled(left: int, top: int) -> set[tuple[int, int]]:
    """Return the pixels of the image."""
    return {(x, y) for x in range(left, left + 20) for y in range(top, top + 10)}


def test_an_image_in_version_1_is_drawn_at_its_place(run_on: RunOn, tmp_path: Path) -> None:
    file = str(tmp_path / "mark")
    calls = [f"brick.display.image(file, {place})" for place in PLACES]
    done = run_on(
        HEAD
        + f"from pybricks.media.ev3dev import Image\nimage, file = Image.empty(20, 10), {file!r}\n"
        "image.draw_box(0, 0, 19, 9, fill=True)\nimage.save(file)\n"
        + "\n".join([*calls, "brick.display.image(file, (100, 100), clear=False)"]),
        profile=PROFILE,
    )
    found = [pixels for row in shown(done) if (pixels := dark(row))]
    alone = [filled(*place) for place in PLACES.values()]
    assert found == [*alone, alone[-1] | filled(100, 100)], done.errors


def test_light_buttons_and_battery_of_version_1_can_be_used(run_on: RunOn) -> None:
    done = run_on(
        HEAD + "brick.light(Color.RED)\nbrick.light(None)\n"
        "while Button.CENTER not in brick.buttons():\n    wait(10)\n"
        "print(brick.buttons(), brick.battery.voltage() > 5000, brick.battery.current() > 0)",
        profile=PROFILE,
        presses=("enter@0.5-1",),
    )
    assert done.lines == ["[Button.CENTER] True True"], done.errors
    lights = [row.text for row in done.run.output.read_all_rows() if row.stream == Stream.LED]
    assert len(lights) == 2
