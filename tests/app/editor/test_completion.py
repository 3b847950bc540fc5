"""What may follow at a place of a program, and the signature of a call."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.cases import for_rows
from tuisim.app.editor.completion import (
    Candidate,
    Signature,
    extract_sentence,
    find_candidates,
    find_signature,
    find_word,
    is_in_call,
    list_installed,
)

EV3DEV2 = "from ev3dev2.motor import LargeMotor\nfrom ev3dev2.sensor.lego import TouchSensor\nm = LargeMotor()\n"
PYBRICKS = """\
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, ColorSensor
from pybricks.parameters import Port, Color
ev3 = EV3Brick()
motor = Motor(Port.A)
"""
HUB = """\
from pybricks.hubs import PrimeHub
from pybricks.pupdevices import Motor
from pybricks.robotics import DriveBase
robot = DriveBase(Motor(), Motor(), 56, 112)
"""


def at_end(text: str, path: str = "prog.py") -> tuple[Candidate, ...]:
    return find_candidates(text, path, *place(text))


def place(text: str) -> tuple[int, int]:
    lines = text.split("\n")
    return len(lines) - 1, len(lines[-1])


def names(text: str) -> list[str]:
    return [one.name for one in at_end(text)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "text, first",
    [
        (
            "tank_drive.",
            [
                "on",
                "off",
                "on_for_degrees",
                "on_for_rotations",
                "on_for_seconds",
                "follow_gyro_angle",
            ],
        ),
        ("colorLeft.", ["reflected_light_intensity", "reflected_light_intensity_pc", "color"]),
        ("ultrasonic.", ["distance_centimeters"]),
        ("import time\ntime.", ["sleep"]),
    ],
)
def test_completion_lists_names_used_by_programs_first_and_inherited_ones_last(
    text: str, first: list[str]
) -> None:
    found = names(text)
    assert found[: len(first)] == first
    if text == "tank_drive.":
        assert found.index("turn_left") < found.index("stop") < found.index("desc")


@pytest.mark.parametrize(
    "text, found",
    [
        ("tank_drive.o", ["on", "off", "on_for_degrees", "on_for_rotations", "on_for_seconds"]),
        ("col", ["colorLeft", "colorRight", "ColorSensor"]),
        ("get_cl", ["get_clock"]),
        ("print(colorLeft.refl", ["reflected_light_intensity", "reflected_light_intensity_pc"]),
        ("# %%sim_magic_imports\ntank_d", []),
        ("# %%sim_magic_preloaded -b\ntank_d", ["tank_drive"]),
        (EV3DEV2 + "m.run_f", ["run_forever"]),
        (EV3DEV2 + "tank_d", []),
        (PYBRICKS + "ev3.s", ["screen", "speaker"]),
        (PYBRICKS + "ColorSensor(Port.S1).", ["ambient", "color", "reflection", "rgb"]),
        (HUB + "robot.use", ["use_gyro"]),
        (HUB + "from pybricks.iodevices import X", ["XboxController"]),
        ("from pybricks.rob", ["robotics"]),
        ("from pybricks.tools import w", ["wait"]),
        ("def speed_of(wheel):\n    return wheel\n\nspee", ["speed_of", "SpeedPercent"]),
        ("import timei", ["timeit"]),
        ("x = (1,\nif tank_drive.of", ["off"]),
    ],
    ids=[
        "method",
        "prelude in any case",
        "clock",
        "of the course",
        "other prelude",
        "unfinished magic",
        "ev3dev2",
        "no prelude",
        "Pybricks",
        "no inner names",
        "Pybricks of hubs",
        "module of hubs",
        "module",
        "from a module",
        "own function",
        "import",
        "broken text",
    ],
)
def test_completion_lists_exactly_the_names_that_begin_like_the_word(
    home: Path, text: str, found: list[str]
) -> None:
    assert names(text) == found


def test_completion_reads_packages_wherever_python_finds_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packages, own = tmp_path / "lib" / "dist-packages", tmp_path / "work"
    for folder in (packages, own):
        folder.mkdir(parents=True)
        monkeypatch.syspath_prepend(str(folder))

    folders = list_installed()

    assert str(packages) in folders and str(own) not in folders


@pytest.mark.parametrize("text", ["", "    ", "'tank_drive.o", "# tank_drive.o", "3.", "x ="])
def test_no_names_are_offered_where_none_may_follow(text: str) -> None:
    assert names(text) == []


def test_help_of_reflected_light_names_both_scales_if_the_program_has_imports() -> None:
    text = (
        "from ev3dev2.sensor.lego import ColorSensor\nColorSensor('in2').reflected_light_intensity"
    )
    assert [one.help for one in at_end(text)] == [
        "Reflected red light from 0 to 255, or to 100 under the profile `ev3`"
    ]


@pytest.mark.slow
def test_a_candidate_has_a_signature_and_help(home: Path) -> None:
    found = {one.name: one for one in at_end("tank_drive.o")}
    assert found["on"] == Candidate(
        "on",
        "(left_speed, right_speed)",
        help="Start rotating the motors according to `left_speed` and `right_speed` forever",
    )
    assert (
        at_end(PYBRICKS + "motor.run_t")[-1].signature == "(speed, time, then=Stop.HOLD, wait=True)"
    )
    assert [one.kind for one in at_end("colorLeft.reflected_light_intensity_p")] == ["property"]


@pytest.mark.slow
def test_completion_offers_constants_last(home: Path) -> None:
    found = names(EV3DEV2 + "m.")
    assert found.index("COMMAND_STOP") > found.index("wait_until")
    assert found[-1].isupper()
    assert not any(name.startswith("_") for name in found)


def test_a_module_beside_the_program_is_read_and_not_run(home: Path, tmp_path: Path) -> None:
    ran = tmp_path / "ran"
    (tmp_path / "helper.py").write_text(f"def turn_left(): pass\nopen({str(ran)!r}, 'w')\n1 / 0\n")
    found = at_end("import helper\nhelper.tu", str(tmp_path / "prog.py"))
    assert [one.name for one in found] == ["turn_left"]
    assert not ran.exists()


@pytest.mark.parametrize(
    "text, found",
    [
        ("tank_drive.on(", Signature("on", ("left_speed", "right_speed"), 0)),
        ("tank_drive.on(SpeedPercent(5), ", Signature("on", ("left_speed", "right_speed"), 1)),
        ("tank_drive.on(SpeedPercent(", Signature("SpeedPercent", ("percent", "desc=None"), 0)),
        (
            "def add(a: int, b: int = 2) -> int:\n    return a\n\nadd(b=",
            Signature("add", ("a", "b=2"), 1),
        ),
        ("nothing(", None),
    ],
    ids=["method", "second", "inner", "own function", "unknown"],
)
def test_find_signature_gives_the_called_function_and_its_current_parameter(
    home: Path, text: str, found: Signature | None
) -> None:
    assert find_signature(text, "prog.py", *place(text)) == found


@for_rows(
    "line, column, word",
    [
        ("tank", 4, "tank"),
        ("tank", 2, "ta"),
        ("a.b", 3, "b"),
        ("a.", 2, ""),
        ("f().", 4, ""),
        ("x[1].", 5, ""),
        ("'a'.", 4, ""),
        ("x = ", 4, None),
        ("    ", 4, None),
        ("# tank", 6, None),
        ("'tank", 5, None),
        ("1.", 2, None),
        ("x12.", 4, ""),
        ("a..", 3, None),
    ],
)
def test_find_word_gives_the_name_before_the_cursor(
    line: str, column: int, word: str | None
) -> None:
    assert find_word(line, column) == word


@for_rows(
    "lines, is_in",
    [
        (["f("], True),
        (["f(1, [2], "], True),
        (["f(", "  1,"], True),
        (["f()"], False),
        (["(1, "], False),
        (["x = [1, "], False),
        (["f([1, "], True),
        (["print('(')"], False),
        (["# f("], False),
        (["f(g(1)"], True),
    ],
)
def test_is_in_call_is_true_only_between_a_calls_parentheses(
    lines: Sequence[str], is_in: bool
) -> None:
    assert is_in_call(lines, len(lines) - 1, len(lines[-1])) == is_in


@pytest.mark.parametrize(
    "documentation, first",
    [
        ("Stop.  Then go.", "Stop"),
        ("One\nline, e.g. here. More", "One line, e.g. here"),
        ("Set ``on``\n\nMore", "Set `on`"),
        ("", ""),
    ],
)
def test_extract_sentence_gives_the_first_sentence_of_a_docstring(
    documentation: str, first: str
) -> None:
    assert extract_sentence(documentation) == first
