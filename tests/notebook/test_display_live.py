"""What a kernel shows while a program runs."""

from __future__ import annotations

import re

import pytest

from tests.notebook.conftest import Kernel

DRIVE = (
    "%%sim_magic_preloaded -b Grey_bands -x 100 -RXF 0.05 --speed 0.5\n"
    "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 2)\n"
)


@pytest.mark.slow
def test_a_running_cells_picture_table_and_chart_are_updated_in_place(kernel: Kernel) -> None:
    parent = kernel.begin(DRIVE)
    drawn: dict[str, list[str]] = {}
    kinds: list[str] = []
    pictures: list[str] = []
    while True:
        message = kernel.message(parent, lambda _: True)
        content = message["content"]
        if "display_data" in message["msg_type"]:
            kinds.append(message["msg_type"])
            drawn.setdefault(content["transient"]["display_id"], []).append(
                content["data"]["text/plain"]
            )
            pictures += [content["data"]["image/png"]] if "image/png" in content["data"] else []
        if content.get("execution_state") == "idle":
            break
    # World, positioning and the line about the run, each once; then each of them again and again.
    assert kinds[:3] == ["display_data"] * 3
    assert set(kinds[3:]) == {"update_display_data"}
    world, places, status = drawn.values()
    assert len(world) == len(places) == len(status) > 3
    xs = [float(re.findall(r"x +([\d.]+) mm", place)[0]) for place in places]
    assert xs == sorted(xs)
    assert xs[0] < xs[len(xs) // 2] < xs[-1]
    # The robot moves in the picture while it moves in the world.
    assert len(set(pictures)) > 3
    assert all(line.startswith("running · ") for line in status[:-1])
    assert status[-1] == "finished · 2.000 s · 0 samples"
