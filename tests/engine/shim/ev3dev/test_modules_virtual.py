"""The parts that the simulator Gears adds to the library."""

from __future__ import annotations

import pytest

from tests.running import Run
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN

_HEAD = "from ev3dev2.motor import *\nfrom ev3dev2.sensor import *\nfrom ev3dev2.sensor.virtual import *\n"


def test_the_virtual_pen_draws_and_the_virtual_gps_gives_the_true_position(run: Run) -> None:
    done = run(
        f"{_HEAD}wheels, pen, place = MoveTank(OUTPUT_B, OUTPUT_C), Pen(INPUT_5), GPSSensor(INPUT_6)\n"
        "talk = Radio()\nwheels.on_for_rotations(30, 30, 1)\npen.down()\npen.setColor(255, 0, 0)\n"
        "wheels.on_for_rotations(30, 30, 1)\npen.up()\nwheels.on_for_rotations(30, 30, 1)\n"
        "import time\ntime.sleep(1)\nprint(place.x * 10, place.y * 10, place.position)\n",
        profile="ev3",
        prelude="none",
    )
    assert done.errors == []
    x_mm, y_mm, *rest = done.lines[0].split(" ", 2)
    assert (float(x_mm), float(y_mm)) == pytest.approx(done.pose[:2])
    assert rest == [f"[{float(x_mm) / 10}, {float(y_mm) / 10}, 0.0]"]
    down = (done.run.telemetry.array()["flags"] & FLAG_PEN_DOWN) != 0
    assert (down[0], down.any(), down[-1]) == (False, True, False)


@pytest.mark.parametrize(
    "use", ["Radio().send('a')", "CameraSensor().image", "LidarSensor(INPUT_7).scan()"]
)
def test_using_a_virtual_part_that_is_not_simulated_raises_with_its_name(
    run: Run, use: str
) -> None:
    name = use.split("(")[0]
    done = run(f"{_HEAD}part = {name}(INPUT_7)\n{use}\n", profile="ev3", prelude="none")
    assert done.errors[-1].startswith(
        f"NotSimulated: tuisim does not simulate ev3dev2.sensor.virtual.{name}."
    )
    assert done.ended.error_line == 5
