"""The kernel's interrupt, wherever it comes: the program stops, nothing is lost, the next cell works."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from IPython.core.interactiveshell import InteractiveShell

from tests.cases import cases
from tests.notebook.conftest import Cell, Kernel
from tuisim.engine.runs.store import RunStore
from tuisim.notebook import cell_run
from tuisim.notebook.cell_output import CellOutput
from tuisim.notebook.display import Stage

ENDLESS = "%%sim_magic_preloaded -RW --speed 1\nprint('Colour: 1')\nwhile True:\n    pass\n"


@pytest.fixture(autouse=True)
def _as_in_a_kernel() -> Iterator[None]:
    """Hear interrupts, also where the tests were started in the background, with interrupts ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def striking(act: Callable[..., Any]) -> Callable[..., Any]:
    """Interrupt as Jupyter does, with its signal, right after a call."""

    def acting(*words: Any, **named: Any) -> Any:
        done = act(*words, **named)
        signal.raise_signal(signal.SIGINT)
        return done

    return acting


def check_that_all_is_well(cell: Cell) -> None:
    frame = cell("%sim_data").result
    assert list(frame[frame.run == 1].value) == [1.0]
    assert cell("%%sim_magic -RW\nprint('next')\n").out == "next\n"
    assert cell("roboSim.state").result["x_mm"] == 700


def test_a_line_that_is_nearly_a_sample_is_told_in_the_status(cell: Cell) -> None:
    cell("%%sim_magic -RW\nprint('Angle L: 5')\nprint('Angle: 6')\n")
    status = cell_run.describe_end(RunStore().load_run("last"))
    assert " · 1 sample · 'Angle L: 5' in line " in status


@pytest.mark.slow_cases("among its lines")
@cases(
    "holder, name",
    {
        "as it starts": (cell_run, "start_run"),
        "among its lines": (CellOutput, "show"),
        "in the display": (Stage, "show"),
    },
)
def test_an_interrupt_of_a_cell_stops_its_program(
    holder: Any, name: str, cell: Cell, shell: InteractiveShell, monkeypatch: pytest.MonkeyPatch
) -> None:
    # As a kernel's shell, which draws while the program runs.
    monkeypatch.setattr(shell, "kernel", None, raising=False)
    cell("%sim_magic -b Grey_bands -x 700 -W")
    cell("%%sim_magic -RW\nprint('Colour: 1')\n")
    with monkeypatch.context() as patch:
        patch.setattr(holder, name, striking(getattr(holder, name)))
        shown = cell(f"{ENDLESS.replace('-RW', '-RWF 0.02')}")
    assert "stopped · " in shown.plain
    check_that_all_is_well(cell)


def test_an_interrupt_of_a_cell_reaches_its_responder(cell: Cell) -> None:
    cell("%sim_magic -b Grey_bands -x 700 -W")
    cell(
        "import signal, time\nwent_on = False\ndef strike(text):\n    global went_on\n"
        "    signal.raise_signal(signal.SIGINT)\n    time.sleep(60)\n    went_on = True\n"
        "roboSim.responder = strike"
    )
    shown = cell(ENDLESS.replace("-RW", "-RWL").replace("while", "print('PY::now')\nwhile"))
    assert cell("went_on").result is False
    assert "stopped" in shown.plain
    check_that_all_is_well(cell)


def test_an_interrupt_before_a_cells_run_changes_nothing(
    cell: Cell, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tuisim.engine.runs.run_folder

    cell("%sim_magic -b Grey_bands -x 700 -W")
    cell("%%sim_magic -RW\nprint('Colour: 1')\n")
    with monkeypatch.context() as patch:
        patch.setattr(
            tuisim.engine.runs.run_folder,
            "field_files",
            striking(tuisim.engine.runs.run_folder.field_files),
        )
        shown = cell("%%sim_magic -RW -x 900\nprint('never')\n")
    assert (shown.out, shown.err) == ("", "tuisim: interrupted; no program was running\n")
    check_that_all_is_well(cell)


@pytest.mark.slow
@cases(
    "text",
    {
        "in real time": ENDLESS,
        "at full speed": ENDLESS.replace(" --speed 1", ""),
        "while everything is drawn": ENDLESS.replace("-RW", "-RAciXpF 0.02"),
        "in a flood": ENDLESS.replace("    pass", "    print('Flood: 1')").replace(
            " --speed 1", ""
        ),
        "in a charted flood": ENDLESS.replace("    pass", "    print('Flood: 1')").replace(
            "-RW --speed 1", "-RcO"
        ),
        "stubborn": ENDLESS.replace(
            "    pass", "    try:\n        pass\n    except BaseException: pass"
        ),
    },
)
def test_interrupting_a_kernel_stops_its_program(text: str, kernel: Kernel) -> None:
    parent = kernel.begin(text)
    kernel.message(parent, lambda m: "Colour: 1" in str(m["content"].get("text")))
    kernel.manager.interrupt_kernel()
    kernel.idle(parent)
    assert kernel.text("%%sim_magic -RW\nprint('next')") == "next\n"
    assert kernel.text("print(roboSim.results_log[-2].state)") in ("stopped\n", "killed\n")
