"""What is installed is whole: a copy finds its mats and programs, and a kernel the modules of a course."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from venv import EnvBuilder

import nbformat
import pytest
from nbformat.notebooknode import NotebookNode

from tests.conftest import ROOT
from tests.notebook.lesson import CELLS, LOAD, pictures, result, stream


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the content of the wheel, as an installer would lay it out."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(folder / "site")
    return folder / "site"


def tuisim_in(installed: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-P", "-m", "tuisim", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_installed_copy_runs_its_own_programs(installed: Path, tmp_path: Path) -> None:
    listed = tuisim_in(installed, tmp_path, "programs")
    assert str(installed) in listed.stdout
    done = tuisim_in(installed, tmp_path, "run", "read_once")
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "color_name: White"), done.stderr


@pytest.mark.slow
def test_wheel_holds_every_mat_program_style_and_module(installed: Path) -> None:
    for folder, pattern in (
        ("backgrounds", "*.png"),
        ("backgrounds", "*.toml"),
        ("programs", "*.py"),
    ):
        wanted = {path.name for path in (ROOT / folder).glob(pattern)}
        assert wanted == {
            path.name for path in (installed / "tuisim" / "_assets" / folder).glob(pattern)
        }
    for pattern in ("*.tcss", "*.py", "*.html", "*.css", "*.js", "*.ttf", "LICENSE-*"):
        wanted = {str(path.relative_to(ROOT)) for path in (ROOT / "tuisim").rglob(pattern)}
        found = {path.relative_to(installed) for path in (installed / "tuisim").rglob(pattern)}
        assert wanted == {str(path) for path in found if "_assets" not in path.parts}
    (wheel,) = installed.parent.glob("*.whl")
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if "__pycache__" in name]


Environment = Callable[[str], Path]


@pytest.fixture
def environment(installed: Path, tmp_path: Path) -> Environment:
    """`environment("wheel")` or `("editable")` returns the Python of a new environment with tuisim in it."""

    def create(how: str) -> Path:
        EnvBuilder(symlinks=True).create(tmp_path / how)
        python = tmp_path / how / "bin" / "python"
        # What tuisim needs is there; .pth files beside it are not read, among them that of an installed tuisim.
        shared = [place for place in sys.path if Path(place).name == "site-packages"]
        (site_packages,) = (tmp_path / how).glob("lib/python*/site-packages")
        (site_packages / "shared.pth").write_text("\n".join(shared))
        (wheel,) = installed.parent.glob("*.whl")
        what = [str(wheel)] if how == "wheel" else ["--no-build-isolation", "-e", str(ROOT)]
        pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--no-deps"]
        subprocess.run([*pip, "-q", *what], cwd=tmp_path, check=True, capture_output=True)
        return python

    return create


def execute(python: Path, cells: dict[str, str]) -> dict[str, NotebookNode]:
    """Return cells by name, executed with the kernel "Python 3" of an environment."""
    metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    notebook = nbformat.v4.new_notebook(
        cells=[nbformat.v4.new_code_cell(text) for text in cells.values()], metadata=metadata
    )
    file = python.parent / "lesson.ipynb"
    nbformat.write(notebook, file)
    start = "import sys; from nbclient.cli import main; sys.exit(main())"
    command = [str(python), "-c", start, "--inplace", "--allow-errors", str(file)]
    subprocess.run(command, cwd=file.parent, check=True, capture_output=True)
    return dict(zip(cells, nbformat.read(file, as_version=4).cells, strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("how", ["wheel", "editable"])
def test_the_cells_of_a_course_run_in_the_kernel_python_3(
    how: str, environment: Environment
) -> None:
    done = execute(environment(how), CELLS)
    errors = [out for cell in done.values() for out in cell.outputs if out.output_type == "error"]
    assert errors == []
    assert [stream(cell, "stderr") for cell in done.values()] == [""] * len(CELLS)
    assert {name: len(pictures(done[name])) for name in ("load", "instruments", "arrays")} == {
        "load": 0,
        "instruments": 1,
        "arrays": 2,
    }
    # The frames of both runs are the same.
    assert result(done["both"]).startswith("(True, ")


@pytest.mark.slow
@pytest.mark.parametrize("how", ["wheel", "editable"])
def test_the_old_simulator_wins_where_it_is_installed(how: str, environment: Environment) -> None:
    python = environment(how)
    (site_packages,) = python.parent.parent.glob("lib/python*/site-packages")
    package = site_packages / "nbev3devsim"
    package.mkdir()
    (package / "__init__.py").write_text("def load_ipython_extension(shell):\n    pass\n")
    (package / "load_nbev3devwidget.py").write_text("roboSim = eds = 'the old one'\n")
    done = execute(python, {"load": LOAD, "which": "roboSim"})
    assert result(done["which"]) == "'the old one'"
    doctor = subprocess.run(
        [str(python), "-P", "-m", "tuisim", "doctor"],
        cwd=site_packages.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    told = " ".join(doctor.stdout.split())
    assert "nbev3devsim the old simulator, in " in told
    assert "It is tuisim in the kernel RoboLab (tuisim): tuisim kernel install" in told
