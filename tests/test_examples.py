"""Every example program runs, and does what its title says."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.cases import for_each
from tests.conftest import ROOT, Command
from tuisim.engine.core.profile import PROFILES, Library
from tuisim.engine.runs.brick_state import ROW_BYTES, BrickState
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.store import load_run
from tuisim.programs.program_file import list_programs, read_program

EXAMPLES: dict[str, dict[str, object]] = {
    "bumper.py": {"background": "Empty_Map", "lines": 2, "samples": 2},
    "draw_house.py": {"background": "Empty_Map", "lines": 1},
    "draw_light.py": {"background": "Grey_bands", "lines": 0},
    "follow_line.py": {"lines": 1, "samples": 0},
    "log_greys.py": {"background": "Grey_bands"},
    "name_colour.py": {"background": "Rainbow_bands", "x_mm": 300.0, "y_mm": 500.0, "lines": 2},
    "pybricks_data_log.py": {"background": "Grey_bands", "y_mm": 500.0},
    "pybricks_line_follower.py": {"background": "Lollipop", "samples": 1},
    "pybricks_mission.py": {"background": "Empty_Map", "samples": 1},
    "pybricks_prime_missions.py": {"background": "Harbour", "lines": 10, "samples": 1},
    "read_once.py": {"background": "Grey_bands", "x_mm": 325.0, "lines": 6},
    "square.py": {"background": "Empty_Map", "lines": 4},
    "stop_at_wall.py": {"background": "Empty_Map", "lines": 1, "samples": 1},
    "until_black.py": {"background": "Grey_bands", "samples": 530},
}
"""What is known of each run beside that it finishes."""
RUNS = [
    (name, profile.name)
    for name in EXAMPLES
    for profile in PROFILES.values()
    if (profile.motor_law.library is Library.PYBRICKS) == name.startswith("pybricks_")
    # It drives until the light is 0, which a brick's sensor never reads.
    and (name, profile.name) != ("until_black.py", "ev3")
    # A hub has Pybricks 4 only.
    and (name, profile.name) != ("pybricks_prime_missions.py", "lego-micropython")
    # LEGO's template imports what Pybricks 4 does not have.
    and (profile.name != "pybricks4" or name == "pybricks_prime_missions.py")
]
"""Each example under the profiles of its library."""


def test_every_example_program_is_in_the_tests_table() -> None:
    assert sorted(EXAMPLES) == [program.name for program in list_programs()]


@for_each(name=EXAMPLES)
def test_each_example_program_has_a_title_and_runs_on_its_mat(name: str) -> None:
    path = ROOT / "programs" / name
    title = next(program.title for program in list_programs() if program.name == name)
    assert title.endswith(".")
    assert len(title) < 80
    # The magic line tells the world, so that the example runs as it is.
    assert read_program(path).options["background"]
    assert path.read_text(encoding="utf-8").isascii()


@pytest.mark.quick_cases("*-robolab", "*-lego-micropython")
@pytest.mark.parametrize("name, profile", RUNS)
def test_an_example_finishes_under_each_profile(name: str, profile: str, here: Command) -> None:
    done = here("run", name, "--json", "--profile", profile, "--timeout", 100)
    facts: dict[str, Any] = json.loads(done.stdout)
    assert (done.returncode, facts["state"], facts["profile"]) == (0, "finished", profile)
    assert facts.items() >= EXAMPLES[name].items()


@pytest.mark.quick_cases("100-White-6", "500-Green-3")
@pytest.mark.parametrize(
    "x_mm, name, code",
    [
        (100, "White", 6),
        (300, "Red", 5),
        (500, "Green", 3),
        (700, "Blue", 2),
        (900, "Blue", 2),
        (1100, "Red", 5),
        (1300, "Yellow", 4),
        (1500, "Black", 1),
    ],
    ids=lambda value: str(value),
)
def test_an_example_names_the_colour_and_speaks_it(
    x_mm: int, name: str, code: int, here: Command
) -> None:
    done = here("run", "name_colour", "-x", x_mm)
    assert done.stdout == f"This is code {code}\nI see {name}\n"
    assert f"says: I see {name}\n" in done.stderr


@pytest.mark.parametrize(
    "x_mm, value",
    [(125, 255), (1125, 128), (1525, 0)],
    ids=lambda value: str(value),
)
def test_the_example_read_once_prints_every_reading_of_a_grey(
    x_mm: int, value: int, here: Command
) -> None:
    code, name = (6, "White") if value else (1, "Black")
    assert here("run", "read_once", "-x", x_mm).stdout.splitlines() == [
        f"reflected_light_intensity: {value}",
        f"reflected_light_intensity_pc: {value / 255 * 100}",
        f"full_reflected_light_intensity: {value * 3 / 765 * 100}",
        f"rgb: {(value, value, value)}",
        f"color: {code}",
        f"color_name: {name}",
    ]


def test_display_shows_the_light_as_a_bar(here: Command) -> None:
    run = load_run(json.loads(here("run", "draw_light", "--json").stdout)["id"])
    pictures = [
        BrickState().update_face([row]).picture
        for row in run.output.read_all_rows()
        if row.stream == Stream.DISPLAY
    ]
    # One for each light on the mat, and those half way across an edge.
    assert len(pictures) > 5
    middle = slice(60 * ROW_BYTES, 61 * ROW_BYTES)
    bars = [int.from_bytes(picture[middle], "big").bit_count() for picture in pictures]
    assert bars[0] == 139
    assert 2 <= bars[-1] < 12


def test_pybricks_line_follower_stays_on_the_stick(here: Command) -> None:
    facts = json.loads(here("run", "pybricks_line_follower", "--json").stdout)
    assert facts["profile"] == "lego-micropython"
    # The edge of the stick, 20 mm to the right of its middle: the left sensor follows it.
    assert facts["x_mm"] == pytest.approx(1718, abs=10)
    assert facts["heading_deg"] == pytest.approx(-360, abs=5)


def test_the_example_pybricks_mission_drives_round_the_corner_with_the_right_button(
    here: Command,
) -> None:
    corner = here("run", "pybricks_mission", "--press", "right@1")
    assert corner.stdout == "Gyro: 0\n"


def test_the_file_of_pybricks_data_log_has_a_row_for_each_sample_but_the_last(
    tmp_path: Path, here: Command
) -> None:
    printed = here("run", "pybricks_data_log").stdout.splitlines()
    header, *rows = (tmp_path / "greys.csv").read_text().splitlines()
    assert header == "time_ms, light, way_mm"
    assert [f"Colour: {row.split(', ')[1]}" for row in rows] == printed[:-1]
    values = [int(row.split(", ")[1]) for row in rows]
    flat = [value for value, after in pairwise(values) if value == after]
    assert list(dict.fromkeys(flat)) == [85, 74, 70, 45]
