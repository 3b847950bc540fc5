"""The kernel that `tuisim kernel install` adds: the cells of a course run in it as they are."""

from __future__ import annotations

import pytest

from tests.notebook.lesson import LOAD, execute, result, stream

OLD_MODULES = {
    "load": LOAD,
    "simulator": "roboSim.state['state']",
    "frames": "list(eds.get_dataframe_from_datalog(roboSim.results_log))[:2]",
    "frames under their old name": "from nbev3devsim import ev3devsim_nb\n"
    "list(ev3devsim_nb.get_dataframe_from_datalog(roboSim.results_log))[:2]",
}


@pytest.mark.slow
def test_the_modules_of_the_course_mean_tuisim(course_kernel: str) -> None:
    done = execute(OLD_MODULES, course_kernel)
    assert done["load"].outputs == []
    names = "['index', 'variable']"
    assert [result(done[name]) for name in list(OLD_MODULES)[1:]] == ["'ready'", names, names]


@pytest.mark.slow
def test_magics_are_there_without_being_loaded(course_kernel: str) -> None:
    done = execute({"run": "%%sim_magic_preloaded -RWH\nprint('Colour: 1')"}, course_kernel)
    assert stream(done["run"]) == "Colour: 1\n"


@pytest.mark.slow
def test_other_kernels_know_nothing_of_these_modules() -> None:
    find = "%load_ext tuisim\nimport importlib.util\nimportlib.util.find_spec('nbev3devsim') is None"
    assert result(execute({"find": find})["find"]) == "True"
