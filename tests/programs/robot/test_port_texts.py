"""Programs without a library, which look for motors in the files of the brick."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.programs.robot.reading import changed

FILES = "FOLDER = '/sys/class/tacho-motor/'\ndef find(port): pass\n"

PORTS: Mapping[str, tuple[str, str]] = {
    "other ports": (
        "for port in ('outA', 'outD'): find(port)",
        "A left wheel, B -, C -, D right wheel",
    ),
    "names of sides": (
        "left = find('ev3-ports:outD')\nright = find('ev3-ports:outA')",
        "A right wheel, B -, C -, D left wheel",
    ),
    "an arm": (
        "arm = find('outA')\nb, c = find('outB'), find('outC')",
        "A large motor",
    ),
    "the usual ports": ("b, c = find('outB'), find('outC')", ""),
    "no ports": ("find('motor0')", ""),
}


@pytest.mark.parametrize("case", PORTS)
def test_the_robot_has_motors_on_the_ports_in_the_text(case: str) -> None:
    text, ports = PORTS[case]
    assert changed(FILES + text, head="") == ports


def test_ports_named_in_texts_are_ignored_if_the_program_uses_a_library() -> None:
    assert changed("print('outA')\nMoveTank(OUTPUT_B, OUTPUT_C)") == ""
