"""`tuisim kernel`: a kernel for Jupyter is added, listed and removed."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command

FOLDER = Path("share", "jupyter", "kernels")


@pytest.fixture(autouse=True)
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let the folders of user and environment be empty ones, and return a prefix of one's own."""
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "user" / "share" / "jupyter"))
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "environment"))
    return tmp_path / "prefix"


PLACES = {"": "user", "--user": "user", "--sys-prefix": "environment", "--prefix prefix": "prefix"}


@pytest.mark.parametrize("place", PLACES)
def test_a_kernel_is_added_listed_and_removed(place: str, here: Command, tmp_path: Path) -> None:
    words = place.split()
    folder = tmp_path / PLACES[place] / FOLDER / "tuisim"
    done = here("kernel", "install", *words)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"'RoboLab (tuisim)' installed in {folder}" in done.stdout
    spec = json.loads((folder / "kernel.json").read_text())
    assert (spec["display_name"], spec["language"], spec["argv"][0]) == (
        "RoboLab (tuisim)",
        "python",
        sys.executable,
    )
    listed = json.loads(here("kernel", "list", "--json", *words).stdout)
    assert [(kernel["name"], kernel["folder"]) for kernel in listed] == [("tuisim", str(folder))]
    assert str(folder) in here("kernel", *words).stdout
    assert here("kernel", "remove", *words).stdout == f"kernel 'tuisim' removed from {folder}\n"
    assert not folder.exists()
    assert (
        here("kernel", *words).stdout
        == "no tuisim kernel is installed; `tuisim kernel install` adds one\n"
    )


def test_a_kernel_may_have_a_name_of_its_own(here: Command) -> None:
    here("kernel", "install", "--name", "lab-2")
    here("kernel", "install")
    assert [line.split()[0] for line in here("kernel").stdout.splitlines()] == [
        "NAME",
        "lab-2",
        "tuisim",
    ]
    here("kernel", "remove")
    assert [line.split()[0] for line in here("kernel").stdout.splitlines()] == ["NAME", "lab-2"]


def foreign(prefix: Path) -> None:
    """Another program's kernel."""
    folder = prefix / FOLDER / "other"
    folder.mkdir(parents=True)
    (folder / "kernel.json").write_text('{"argv": ["python"], "display_name": "Other"}')


@cases(
    "words, told",
    {
        "action": ("instal", "kernel: no such command 'instal' (did you mean install"),
        "none": ("remove", "--name: no tuisim kernel 'tuisim' is installed"),
        "name": (
            "install --name a/b",
            "--name: may contain only lower-case letters, digits and . _ -",
        ),
        "two places": ("install --user --sys-prefix", "name one of --user and --sys-prefix"),
        "no folder": ("install --prefix file", "kernel.json: cannot be written: "),
        "other's": (
            "install --prefix prefix --name other",
            "--name: 'other' is already the name of another",
        ),
        "not ours": (
            "remove --prefix prefix --name other",
            "no tuisim kernel 'other' is installed",
        ),
        "json": ("install --json", "no such option: --json"),
    },
)
def test_a_kernel_that_cannot_be_installed_or_removed_says_why(
    words: str, told: str, here: Command, tmp_path: Path, prefix: Path
) -> None:
    (tmp_path / "file").touch()
    foreign(prefix)
    done = here("kernel", *words.split())
    assert (done.returncode, done.stdout) == (2, "")
    assert told in done.stderr
    assert done.stderr.count("\n") == 1
    assert (prefix / FOLDER / "other" / "kernel.json").exists()


def test_without_ipykernel_it_says_what_to_install(
    here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ipykernel", None)
    done = here("kernel", "install")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "tuisim: the kernel needs ipykernel, which is not installed (pip install 'tuisim[notebook]')\n"
    )
