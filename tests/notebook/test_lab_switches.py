"""Each switch of the magics, short and long: with it something is so that is not so without it."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.notebook.conftest import Cell, Shown
from tuisim.settings.magic_line import _build_command

DRIVE = "tank_drive.on_for_rotations(SpeedPercent(50), SpeedPercent(50), 2)"
PROGRAM = (
    f"%%sim_magic_preloaded -b Grey_bands -WH\nprint('ran')\nsay('spoken', show=False)\n{DRIVE}\n"
)

Probe = Callable[[Cell, str], Any]


def spec(what: str) -> Probe:
    """What `roboSim.spec` says after a cell with the switch."""
    return lambda cell, words: cell(f"%sim_magic -W {words}\nroboSim.spec.{what}").result


def text(part: str, hidden: str = "-W") -> Probe:
    """Whether a display or a printed line of a cell with the switch begins so."""
    return lambda cell, words: any(
        line.strip().startswith(part) for line in _lines(cell(f"%sim_magic {hidden} {words}"))
    )


def _lines(shown: Shown) -> list[str]:
    return [*shown.plain.splitlines(), *shown.out.splitlines()]


def run_text(part: str) -> Probe:
    """As `text`, of a cell that runs the program."""
    return lambda cell, words: text(part)(cell, f"-R {words}")


def ink(color: tuple[int, int, int], before: str = "", more: str = "") -> Probe:
    """Whether there is a colour in the world's picture, after a cell `before`."""

    def probe(cell: Cell, words: str) -> bool:
        if before:
            cell(f"%sim_magic {before}")
        shown = cell(f"%sim_magic {more} {words}")
        (world,) = (
            bundle["image/png"] for bundle in shown.bundles if "<world" in bundle["text/plain"]
        )
        pixels = np.asarray(Image.open(io.BytesIO(world)).convert("RGB")).reshape(-1, 3)
        return bool((pixels == color).all(axis=1).any())

    return probe


def moved_back(cell: Cell, words: str) -> bool:
    cell("%sim_magic -RW")
    cell(f"%sim_magic -W {words}")
    return bool(cell("roboSim.state").result["x_mm"] == 150)


def another_simulator(cell: Cell, words: str) -> Any:
    cell("from tuisim.notebook.lab import Lab\nother = Lab()")
    cell(f"%sim_magic -W -x 99 {words}")
    return cell("other.state['x_mm']").result


def refreshed(cell: Cell, words: str) -> int:
    """How often a run that takes half a second is drawn."""
    from tuisim.settings import magic_line as said

    return int(1000 * said.parse_line(words, "sim_magic").refresh_s)


def answered(cell: Cell, words: str) -> list[str]:
    cell("heard = []\nroboSim.responder = heard.append")
    cell(f"%%sim_magic -RW {words}\nprint('PY::hello')")
    heard: list[str] = cell("heard").result
    return heard


def paced(cell: Cell, words: str) -> bool:
    cell(f"%sim_magic -RW {words}")
    return bool(cell("roboSim.results_log[-1].live").result)


def names(cell: Cell, words: str) -> str:
    return cell(
        f"%%sim_magic_preloaded -RW {words}\nprint('gyro' in dir(), 'get_clock' in dir())"
    ).out


def given_ready(cell: Cell, words: str) -> bool:
    return "import MoveTank" in str(cell(f"%sim_magic -W {words}").result)


def pressed(cell: Cell, words: str) -> bool:
    """Whether a program sees that the button was pressed at some time."""
    cell(
        "%%sim_magic -W\n"
        "from ev3dev2.button import Button\n"
        "from time import sleep\n"
        "sleep(0.55)\n"
        "print(Button().enter)\n"
    )
    return "True" in cell(f"%sim_magic -WR {words}").out


def own_mat(cell: Cell, words: str) -> str:
    """The file of the mat `Loop`, with a picture of one's own in a folder `pics`."""
    folder = Path(os.environ["TUISIM_HOME"], "pics")
    folder.mkdir(exist_ok=True)
    Image.new("RGB", (30, 20)).save(folder / "_loop.png")
    done = cell(
        f"%sim_magic -W -b Loop {words.replace('pics', str(folder))}\nroboSim.spec.world.background"
    )
    return Path(done.result).name


@dataclass(frozen=True, slots=True)
class Case:
    """One switch."""

    flags: tuple[str, ...]
    value: str
    probe: Probe
    seen: Any = True


PINK = (255, 105, 180)
RAY = (0, 175, 175)
"""Of a pen, of the ultrasonic sensor; the mat has neither."""

CASES = [
    Case(("-b", "--background"), "Loop", spec("world.background"), "Loop"),
    Case(("--mats",), "pics", own_mat, "_loop.png"),
    Case(("--background-fit",), "centre", spec("world.background_fit"), "centre"),
    Case(("-r", "--robot", "--robotSetup"), "Small_Robot", spec("robot.name"), "Small_Robot"),
    Case(("-o", "--obstacles"), "Square_posts", spec("world.obstacles.__len__()"), 4),
    Case(("--walls",), "off", spec("world.walls"), False),
    Case(("--drift",), "gyro_dps=2", spec("world.drift.gyro_dps"), 2.0),
    Case(("--solid",), "", spec("world.solid"), True),
    Case(
        ("--no-solid",),
        "--profile ev3",
        spec("world.solid, roboSim.spec.profile.name"),
        (False, "ev3"),
    ),
    Case(("-x", "--x", "--xpos"), "77", spec("world.start.x_mm"), 77),
    Case(("-y", "--y", "--ypos"), "77", spec("world.start.y_mm"), 77),
    Case(("-a", "--angle"), "-90", spec("world.start.heading_deg"), -90),
    Case(("-N", "--sensornoise"), "7", spec("world.noise.light"), 7),
    Case(("-M", "--motornoise"), "7", spec("world.noise.motor"), 7),
    Case(("-p", "--pendown"), "", ink(PINK, more="-R -x 400 -P hotpink")),
    Case(("-P", "--pencolor"), "hotpink", ink(PINK, more="-R -x 400 -p")),
    Case(("--pen-width",), "9", spec("robot.pen.width_mm"), 9),
    Case(("--pen-marks",), "", spec("world.pen_marks"), True),
    Case(("--profile",), "nbev3devsim", spec("profile.name"), "nbev3devsim"),
    Case(("--seed",), "5", spec("seed"), 5),
    Case(("--press",), "enter@0.5", pressed, True),
    Case(("--speed",), "9", paced),
    Case(("--preload",), "none", names, "False False\n"),
    Case(("-R", "--autorun"), "", text("ran")),
    Case(("-C", "--clear"), "", ink(PINK, before="-R -p -P hotpink -x 1100"), False),
    Case(("-u", "--ultrasound"), "", ink(RAY)),
    Case(("-q", "--quiet"), "", run_text("says: spoken"), False),
    Case(("-O", "--output"), "", text("nothing was printed")),
    Case(("-A", "--array"), "", text("<sensor arrays,")),
    Case(("-c", "--chart"), "", text("<chart,")),
    Case(("-i", "--instrumentation"), "", text("Sensor1 (left)")),
    Case(("-z", "--noisecontrols"), "", text("motor  0")),
    Case(("-Z", "--settings"), "", text("mat        Grey_bands")),
    Case(("-X", "--positioning"), "", text("heading  0.0°")),
    Case(("-D", "--code"), "", text("2  print('ran')")),
    Case(("-W", "--hideworld", "--world"), "", text("<world,", ""), False),
    Case(("-H", "--hidecontrols", "--hide"), "", text("ready"), False),
    Case(("-s", "--sim"), "other", another_simulator, 99),
    Case(("-h", "--help"), "", text("Usage: %sim_magic")),
    Case(("-v", "--preview"), "", text("print('ran')")),
    Case(("--previewcode",), "--preload imports", given_ready, True),
    Case(("-S", "--stop"), "", text("nothing is running")),
    Case(("-m", "--move"), "", moved_back),
    Case(("-F", "--refresh"), "0.5", refreshed, 500),
    Case(("-L", "--collab"), "", answered, ["hello"]),
]
OF_TERMINALS = {"--fps", "--colors", "--cells", "--pixels"}
"""Switches that the command line shares and that mean nothing in a notebook."""


def with_slow(cases: Sequence[Any], quick: Callable[[Any], bool]) -> list[Any]:
    return [
        pytest.param(*case, id=case[0], marks=() if quick(case) else pytest.mark.slow)
        for case in cases
    ]


FLAGS = [(flag, case) for case in CASES for flag in case.flags]


@pytest.mark.parametrize("flag, case", with_slow(FLAGS, lambda one: one[0] == one[1].flags[0]))
def test_each_switch_of_sim_magic_does_what_it_says(flag: str, case: Case, cell: Cell) -> None:
    cell(PROGRAM)
    assert case.probe(cell, f"{flag} {case.value}") == case.seen


@pytest.mark.slow
@pytest.mark.parametrize("case", [pytest.param(case, id=case.flags[0]) for case in CASES])
def test_sim_magic_without_a_switch_does_not_do_what_the_switch_does(
    case: Case, cell: Cell
) -> None:
    cell(PROGRAM)
    assert case.probe(cell, "") != case.seen


def test_every_switch_of_sim_magic_has_a_test_case() -> None:
    known = {flag for param in _build_command("sim_magic").params for flag in param.opts}
    assert known == {flag for case in CASES for flag in case.flags} | OF_TERMINALS


COMPOUNDS = [
    ("-OHR", "-O -H -R"),
    ("-RWiX", "-R -W -i -X"),
    ("-pRx400", "-p -R -x 400"),
    ("-ucAR", "-u -c -A -R"),
    ("-RpP green", "--autorun --pendown --pencolor=green"),
]


@pytest.mark.parametrize("together, apart", with_slow(COMPOUNDS, lambda one: one[0] == "-OHR"))
def test_short_switches_of_sim_magic_may_be_joined(together: str, apart: str, cell: Cell) -> None:
    cell(PROGRAM)
    one = cell(f"%sim_magic {together}")
    cell("%sim_magic -CWH")
    other = cell(f"%sim_magic {apart}")
    assert one.out == other.out == "ran\nsays: spoken\n"
    assert one.bundles == other.bundles


def test_a_program_that_has_not_run_is_ready_whatever_became_of_the_one_before(cell: Cell) -> None:
    assert "NameError" in str(cell("%%sim_magic_preloaded -R\nprnt('x')").bundles[-1])
    assert (
        cell("%%sim_magic_preloaded\nprint('x')").bundles[-1]["text/plain"]
        == "ready: -R runs the program"
    )


WAITS = """\
%%sim_magic -WR --press enter@1
from ev3dev2.button import Button
print(Button().wait_for_pressed('enter', timeout_ms=3000))
"""


@pytest.mark.slow
def test_presses_planned_in_a_cells_magic_line_happen_in_its_run(cell: Cell) -> None:
    assert cell(WAITS).out == "True\n"
    assert cell("%sim_magic -R").out == "True\n"
    assert cell("%sim_magic -R --press up@1").out == "False\n"
    assert cell("%sim_magic -R").out == "True\n"
    assert cell(WAITS.replace(" --press enter@1", "")).out == "False\n"


def test_a_wrong_press_in_a_magic_line_is_told_in_the_cell(cell: Cell) -> None:
    shown = cell(WAITS.replace("enter@1", "entre@1"))
    assert (shown.out, shown.err) == (
        "",
        "tuisim: --press: 'entre' cannot be pressed (did you mean enter?)\n",
    )
