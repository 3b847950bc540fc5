"""The cells of a course in the kernel that `tuisim kernel install` adds, and the old simulator beside it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.notebook.lesson import LOAD, execute, result, stream

OLD_MODULES = {
    "load": LOAD,
    "simulator": "roboSim.state['state']",
    "frames": "list(eds.get_dataframe_from_datalog(roboSim.results_log))[:2]",
    "frames under their old name": "from nbev3devsim import ev3devsim_nb\n"
    "list(ev3devsim_nb.get_dataframe_from_datalog(roboSim.results_log))[:2]",
}


@pytest.fixture(autouse=True)
def _old_simulator(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the old simulator be installed, too."""
    (tmp_path / "nbev3devsim.py").write_text(
        "def load_ipython_extension(shell):\n    print('the old one')\n"
    )
    monkeypatch.setenv(
        "PYTHONPATH", os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH"))))
    )


@pytest.mark.slow
def test_the_modules_of_the_course_mean_tuisim(course_kernel: str) -> None:
    done = execute(OLD_MODULES, course_kernel)
    assert done["load"].outputs == []
    names = "['index', 'variable']"
    assert [result(done[name]) for name in list(OLD_MODULES)[1:]] == ["'ready'", names, names]


@pytest.mark.slow
def test_magics_of_the_course_kernel_need_no_load_ext(course_kernel: str) -> None:
    done = execute({"run": "%%sim_magic_preloaded -RWH\nprint('Colour: 1')"}, course_kernel)
    assert stream(done["run"]) == "Colour: 1\n"


@pytest.mark.slow
def test_in_other_kernels_the_old_simulator_wins_and_a_note_says_so() -> None:
    done = execute({"load": "%load_ext tuisim\n%load_ext nbev3devsim"})
    assert stream(done["load"]) == "the old one\n"
    assert stream(done["load"], "stderr") == (
        "tuisim: note: nbev3devsim is the old simulator here, and tuisim in the kernel RoboLab (tuisim)\n"
    )
