"""Every magic and switch, in a shell."""

from __future__ import annotations

import html
import re
from pathlib import Path

import pytest

from tests.notebook.conftest import Cell

LOGGER = """\
%%sim_magic_preloaded -x 100 --autorun -WH
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 0:
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
tank_drive.off()
"""
PLATEAUS = [100.0, 86.27450980392157, 82.74509803921568, 50.19607843137255]


def program(words: str, text: str = "print('ran')") -> str:
    return f"%%sim_magic_preloaded {words}\n{text}\n"


def test_sim_data_holds_the_samples_of_all_runs_until_it_is_cleared(cell: Cell) -> None:
    cell("%sim_magic -b Grey_bands")
    first = cell(LOGGER)
    assert first.out.startswith("Colour: 100.0\n")
    assert not first.bundles
    once = cell("%sim_data").result
    assert sorted(once["value"].value_counts().index[:4], reverse=True) == PLATEAUS
    assert list(once.columns[:4]) == ["index", "variable", "value", "time"]
    # As in the cell: the magic stands in line 1.
    assert set(once["line"]) == {4}
    cell(LOGGER)
    twice = cell("%sim_data").result
    assert (len(twice), list(twice["run"].unique())) == (2 * len(once), [1, 2])
    cell("%sim_data --clear")
    assert len(cell("%sim_data").result) == 0
    cell(LOGGER)
    assert cell("%sim_data").result.equals(once)


def test_a_predefined_name_in_a_plain_cell_names_the_magic(cell: Cell) -> None:
    for name, is_predefined in (("tank_drive", True), ("my_name", False)):
        with pytest.raises(NameError) as caught:
            cell(f"{name}.on(30, 30)")
        notes = getattr(caught.value, "__notes__", [])
        assert any("%%sim_magic_preloaded" in note for note in notes) == is_predefined


def test_the_table_counts_a_reversed_motor_as_the_program_does(cell: Cell) -> None:
    text = """tank_drive.left_motor.polarity = "inversed"
tank_drive.on_for_degrees(30, 30, 90)
print(tank_drive.left_motor.position)"""
    shown = cell(program("-RWi", text))
    assert shown.out.strip() == "90"
    assert "LeftMotor        90 counts" in shown.plain


@pytest.mark.parametrize(
    "words, pictures, status",
    [
        ("-R", 1, True),
        ("-OHRA", 2, False),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in [("--autorun -W", 0, True), ("-RH", 1, False), ("-RHW", 0, False)]
        ),
    ],
)
def test_switches_of_sim_magic_hide_pictures_and_status(
    words: str, pictures: int, status: bool, cell: Cell
) -> None:
    shown = cell(program(words))
    assert (shown.out, shown.pictures, "finished · " in shown.plain) == ("ran\n", pictures, status)


@pytest.mark.parametrize(
    "magic, text, out",
    [
        ("sim_magic", "print('tank_drive' in dir())", "False\n"),
        ("sim_magic_imports", "print('MoveTank' in dir(), 'tank_drive' in dir())", "True False\n"),
        ("sim_magic_preloaded", "print('MoveTank' in dir(), 'tank_drive' in dir())", "True True\n"),
    ],
)
def test_each_magic_predefines_its_names(magic: str, text: str, out: str, cell: Cell) -> None:
    assert cell(f"%%{magic} -R\n{text}\n").out == out


READY = {
    "sim_magic_imports": "OUTPUT_B",
    "sim_magic_preloaded": "tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)",
}
"""By magic, a part of what it gives a program."""


@pytest.mark.parametrize("magic", READY)
def test_the_preview_switch_of_a_magic_shows_its_predefined_names(magic: str, cell: Cell) -> None:
    alone = cell(f"%{magic} -v")
    assert READY[magic] in alone.out
    assert not alone.bundles
    with_program = cell(f"%%{magic} -vWH\nprint('mine')\n")
    assert with_program.out == f"{alone.out}print('mine')\n\n"
    given = cell(f"text = %{magic} --previewcode\nprint(text)")
    assert (given.out.strip() in alone.out, given.bundles) == (True, ())


def test_sim_magic_with_run_runs_the_program_of_the_cell_before(cell: Cell) -> None:
    assert cell(program("")).out == ""
    assert cell("%sim_magic -RW").out == "ran\n"


def test_autorun_runs_the_program_of_each_cell_at_once(cell: Cell) -> None:
    cell("get_ipython().magics_manager")
    cell("from tuisim.notebook.magics import roboSim\nroboSim.autorun = True")
    assert cell(program("")).out == "ran\n"
    assert cell("%sim_magic -x 10").out == ""


MISTAKES = [
    ("-Y", "no such option: -Y"),
    ("-b Nope", "no such mat 'Nope'"),
    ("-r Nope", "Nope"),
    ("-o Nope", "Nope"),
    ("-x far", "-x: must be a number"),
    ("-P greenish", "no such colour 'greenish'"),
    ("--profile Nope", "Nope"),
    ("-s nobody", "-s: no simulator 'nobody'"),
    ("-F 0", "-F: must be a number"),
    ("'", "cannot be split into words"),
]


@pytest.mark.parametrize("words, told", MISTAKES, ids=[words for words, _ in MISTAKES])
def test_a_mistake_in_sim_magic_is_told_in_one_line_and_changes_nothing(
    words: str, told: str, cell: Cell
) -> None:
    cell(program("-b Grey_bands -x 300 -WH"))
    before = cell("roboSim.state").result
    shown = cell(program(f"-R -y 77 {words}", "print('never')"))
    assert (shown.out, shown.bundles) == ("", ())
    assert shown.err.startswith("tuisim: ")
    assert told in shown.err
    assert shown.err.count("\n") == 1
    assert cell("roboSim.state").result == before
    assert cell("roboSim.program_text").result == "print('ran')\n"


@pytest.mark.parametrize(
    "line",
    [
        "%sim_magic -R",
        "%sim_data -x",
        "%sim_image_pair",
        "%sim_bw_image_data -i 3",
        "%sim_robot_state now",
        "%sim_bw_image_data --crop 3,3,2",
        "%sim_data --sim nobody",
    ],
)
def test_magics_for_logs_tell_mistakes_in_one_line(line: str, cell: Cell) -> None:
    shown = cell(line)
    assert shown.err.startswith("tuisim: ")
    assert shown.err.count("\n") == 1


def test_magics_for_pixel_arrays_say_so_if_none_are_logged(cell: Cell) -> None:
    assert "no pixel arrays are logged" in cell("%sim_image_pair").err
    cell(program("-RWH", "print('image_data left')"))
    assert "no pixel arrays 1 (0 … 0 are logged" in cell("%sim_bw_image_data -i 1").err


def test_choosing_a_mat_in_sim_magic_sets_its_start(cell: Cell) -> None:
    cell("%sim_magic -b Grey_bands -x 700")
    assert cell("roboSim.state").result["x_mm"] == 700
    cell("%sim_magic -W")
    assert cell("roboSim.state").result["x_mm"] == 700
    cell("%sim_magic -b Grey_bands")
    assert cell("roboSim.state").result["x_mm"] == 150


def test_a_programs_error_in_a_cell_shows_its_own_line(cell: Cell) -> None:
    shown = cell(program("-RW", "print('Colour: 1')\n1 / 0"))
    assert "line 3, in <module>" in shown.err
    assert "ZeroDivisionError" in shown.err
    assert "raised" in shown.plain
    assert len(cell("%sim_data").result) == 1


def test_logged_pixel_arrays_are_available_as_frame_and_pictures(cell: Cell) -> None:
    cell(program("-b Grey_bands -x 1520 -RW", "print('image_data both')\nprint('image_data left')"))
    frame = cell(
        "from tuisim.notebook import eds\nfrom tuisim.notebook.magics import roboSim\nroboSim.images()"
    )
    assert list(frame.result.side) == ["left", "right", "left"]
    assert {len(vals) for vals in frame.result.vals} == {1600}
    assert (
        cell("[picture.size for picture in eds.image_pair(roboSim.images(), 0)]").result
        == [(20, 20)] * 2
    )
    dark = cell("eds.bw_image_data(roboSim.images(), 0)").result
    # The disc lies on the black band: its 305 pixels are dark, the corners are not.
    assert (dark.shape, int(dark.to_numpy().sum())) == ((20, 20), 305)


OLD_SWITCHES = [
    ("%sim_data --sim other", 0),
    ("%sim_image_pair --pairindex 0 --sim roboSim", None),
    ("%sim_bw_image_data --index 0 --threshold 127 --digitclass", (14, 14)),
    ("%sim_bw_image_data -n", (20, 20)),
    ("%sim_bw_image_data --crop 3,4,17,17 -r", (14, 13)),
    ("%sim_robot_state --sim roboSim --clear", None),
]
"""Switches of the magics that read the log, as courses know them, and the size of what comes of them."""


@pytest.mark.parametrize("line, size", OLD_SWITCHES, ids=[line for line, _ in OLD_SWITCHES])
def test_the_old_switches_of_magics_for_logs_are_accepted(
    line: str, size: object, cell: Cell
) -> None:
    cell("from tuisim.notebook.lab import Lab\nother = Lab()")
    cell(program("-WRH", "print('Colour: 1')\nprint('image_data both')"))
    shown = cell(line)
    assert shown.err == ""
    assert getattr(shown.result, "size", None) == size


@pytest.mark.parametrize(
    "magic", ["sim_data", "sim_robot_state", "sim_image_pair", "sim_bw_image_data"]
)
def test_magics_for_logged_data_print_their_help(magic: str, cell: Cell) -> None:
    assert cell(f"%{magic} -h").out.startswith(f"Usage: %{magic} ")


def test_a_program_displayed_as_html_is_escaped_and_complete(cell: Cell) -> None:
    (code,) = cell(program("-WHD", "if 1 < 2:\n    print('<b>')")).bundles
    rows = re.findall(r"<tr><th>(\d+)</th><td[^>]*><pre>(.*?)</pre></td></tr>", code["text/html"])
    assert [(number, html.unescape(line)) for number, line in rows] == [
        ("1", ""),
        ("2", "if 1 < 2:"),
        ("3", "    print('<b>')"),
    ]
    assert "<b>" not in code["text/html"]


def test_the_status_of_a_cell_counts_one_sample_in_the_singular(cell: Cell) -> None:
    assert cell(program("-RW", "print('Colour: 1')")).plain == "finished · 0.000 s · 1 sample"


def test_what_a_robots_file_has_that_means_nothing_here_is_said_once(
    cell: Cell, tmp_path: Path
) -> None:
    (tmp_path / "mine.json").write_text('{"owner": "Ann"}')
    noted = cell(f"%sim_magic -W -r {tmp_path / 'mine.json'}")
    assert noted.err.count("ignored unknown keys: owner") == 1
    assert "ignored unknown keys" not in cell("%sim_magic -W -x 100").err


PYBRICKS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Direction, Port
from pybricks.robotics import DriveBase
left, right = Motor(Port.B, Direction.COUNTERCLOCKWISE), Motor(Port.C, Direction.COUNTERCLOCKWISE)
robot = DriveBase(left, right, 55.5, 104)
robot.straight(100)
print('Distance:', robot.distance())
"""
EV3DEV2 = "from ev3dev2.motor import MoveTank\nMoveTank('outB', 'outC').on_for_seconds(20, 20, 1)\nprint('Done: 1')\n"


def test_the_imports_of_a_cell_choose_its_profile(cell: Cell) -> None:
    shown = cell(f"%%sim_magic -RW\n{PYBRICKS}")
    assert shown.out == "Distance: 100\n"
    assert (
        "both wheel motors the other way round; as on a brick (profile lego-micropython)"
        in shown.err
    )
    (sample,) = cell("%sim_data").result.to_dict("records")
    assert (sample["variable"], sample["value"], sample["line"], round(sample["x_mm"])) == (
        "Distance",
        100,
        8,
        236,
    )
    assert cell(f"%%sim_magic -RW\n{EV3DEV2}").out == "Done: 1\n"
    assert cell(program("-RW", "print('Kept:', len([gyro]))")).out == "Kept: 1\n"
    assert cell(f"%%sim_magic -RW\n{PYBRICKS}").out == "Distance: 100\n"


def test_a_chosen_profile_of_the_same_library_wins(cell: Cell) -> None:
    assert "profile" not in cell(f"%%sim_magic -RW --profile pybricks4\n{PYBRICKS}").err
    assert cell("roboSim.spec.profile.name").result == "pybricks4"
    misfit = "tuisim: profile: cell uses ev3dev2, and the profile pybricks4 is for pybricks"
    assert cell(f"%%sim_magic -RW\n{EV3DEV2}").err.startswith(misfit)
    # A line chooses for the cells below it, whatever the cell above it uses.
    assert cell("%sim_magic -W --profile ev3").err == ""
    assert cell(f"%%sim_magic -RW\n{EV3DEV2}").out == "Done: 1\n"


def test_sim_magic_refuses_predefined_names_for_a_pybricks_program(cell: Cell) -> None:
    told = cell(f"%%sim_magic_preloaded -RW\n{PYBRICKS}").err
    assert told.startswith(
        "tuisim: preload: cell uses pybricks, and its predefined names are of ev3dev2"
    )


def test_a_cell_gets_the_robot_that_its_program_talks_about_under_the_course_s_rules(
    cell: Cell,
) -> None:
    text = (
        "from ev3dev2.motor import MediumMotor\nfrom ev3dev2.sensor.lego import ColorSensor\n"
        "claw = MediumMotor('outA')\nprint(claw.address, ColorSensor('in2').reflected_light_intensity)\n"
    )
    shown = cell(f"%%sim_magic -RHW\n{text}")
    assert shown.out == "ev3-ports:outA 255\n"
    assert (
        "cell runs on a robot built from it: medium motor on outA; by the rules of the course"
        in shown.err
    )
    assert "is not connected" in cell(f"%%sim_magic -RHW -r Small_Robot\n{text}").err
    # A chosen robot lasts until another cell changes it.
    assert "is not connected" in cell(f"%%sim_magic -RHW\n{text}").err
