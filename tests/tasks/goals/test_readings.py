"""The readings that a program took, as its recording shows them."""

from __future__ import annotations

from pathlib import Path
from textwrap import indent

import pytest

from tests.conftest import Command
from tests.tasks.goals.recorded import world
from tuisim.base.source import Program
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.evidence import Evidence

# Five readings and one that changes the mode, 100 ms apart.
PROGRAM = """\
from pybricks.ev3devices import ColorSensor
from pybricks.parameters import Port
from pybricks.tools import wait
eye = ColorSensor(Port.S2)
eye.reflection()
for _ in range(5):
    light = eye.reflection()
    print("Light: " + str(light))
    wait(90)
"""
GOALS = """\
title = "Light"
program = "reads.py"
background = "Grey_bands"
start = { x_mm = 325, y_mm = 500, heading_deg = 0 }
[[goal]]
name = "log"
log = { name = "Light", levels = [86.3], within = 0.5, reading = "color", as_read = true }
[[goal]]
name = "print"
print = { lines = ["Light", "Light"], reading = "color" }
[[goal]]
name = "read"
read = { reading = "color", times = 5 }
[[goal]]
name = "read_more"
read = { reading = "color", times = 9 }
"""


def test_each_reading_of_a_pybricks_program_counts(tmp_path: Path, here: Command) -> None:
    (tmp_path / "reads.py").write_text(PROGRAM)
    # A brick's sensor reads 85 % on white paper.
    (tmp_path / "goals.toml").write_text(GOALS.replace("86.3", "74"))
    assert here("run", "goals.toml").returncode == 0
    lines = here("goals", "check", "goals.toml").stdout.splitlines()
    marks = [line.split()[:2] for line in lines if line.lstrip()[:1] in "✓✗" and line.strip()]
    assert marks == [["✓", "log"], ["✓", "print"], ["✓", "read"], ["✗", "read_more"]], lines


HELPER = """\
def light(sensor):
    return sensor.reflected_light_intensity_pc
"""
MAIN = """\
import helper
from time import sleep
for _ in range(5):
    sleep(0.05); light = helper.light(colorLeft)
    print("Light: ", end=""); print(light)
"""


def test_readings_made_in_a_programs_own_module_count_for_goals(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "reads.py").write_text(MAIN)
    (tmp_path / "helper.py").write_text(HELPER)
    (tmp_path / "goals.toml").write_text(GOALS)
    assert here("run", "goals.toml").returncode == 0
    lines = here("goals", "check", "goals.toml").stdout.splitlines()
    marks = [line.split()[:2] for line in lines if line.lstrip()[:1] in "✓✗" and line.strip()]
    assert marks == [["✓", "log"], ["✓", "print"], ["✓", "read"], ["✗", "read_more"]], lines


IDIOMS = {
    "arguments": "def show(*args):\n    print(*args, sep='')\nshow('Light: ', light)",
    "match": "match light:\n    case value if value > 50:\n        print(f'Light: {value}')",
    "getattr": "print('Light: {}'.format(getattr(colorLeft, 'reflected_light_intensity_pc')))",
    "debug_print": (
        "import sys\ndef debug_print(*args, **kwargs):\n    print(*args, **kwargs, file=sys.stderr)\n"
        "debug_print('Light:', light)\nprint('Light:', light)"
    ),
}


@pytest.mark.parametrize("idiom", IDIOMS)
def test_usual_ways_of_printing_a_reading_are_accepted_by_goals(
    tmp_path: Path, here: Command, idiom: str
) -> None:
    text = f"sleep(0.05)\nlight = colorLeft.reflected_light_intensity_pc\n{IDIOMS[idiom]}\n"
    loop = f"from time import sleep\nfor _ in range(5):\n{indent(text, '    ')}"
    (tmp_path / "reads.py").write_text(loop)
    (tmp_path / "goals.toml").write_text(GOALS)
    assert here("run", "goals.toml").returncode == 0
    lines = here("goals", "check", "goals.toml").stdout.splitlines()
    marks = [line.split()[:2] for line in lines if line.lstrip()[:1] in "✓✗" and line.strip()]
    assert marks[:3] == [["✓", "log"], ["✓", "print"], ["✓", "read"]], lines


def test_a_run_that_has_just_begun_has_no_readings_and_no_error(home: Path) -> None:
    store = RunStore()
    spec = RunSpec(RobotSpec(), world(), ROBOLAB)
    run = store.create_run(Program("reads.py", PROGRAM), spec)
    assert not len(Evidence(store.load_run(run.id)).readings.rows)
