"""Batch files: their keys, what they resolve to, and errors about them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.batch.parameters import RandomDraw, SampleValues
from tuisim.commands.batch_file import load_batch
from tuisim.commands.batch_request import is_batch_file
from tuisim.settings.worlds import WorldFile

WHOLE = """
background = "Loop"

[batch]
program = ["mine.py", "log_greys", "lab.ipynb#2"]
seeds = "0..3"
jobs = 2
out = "rows.csv"
goals = "goals.toml"
keep = "failed"
set.noise.motor = [0, 20]
set."robot.wheel_diameter_mm" = "54:55:0.5"
set.background = "Loop,Lollipop"
set.start.x_mm = "random(100, 300, 20)"

[batch.expressions]
far_mm = "hypot(x_mm, y_mm)"
"""


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def written(text: str) -> Path:
        (tmp_path / "mine.py").write_text("pass")
        path = tmp_path / "spec.toml"
        path.write_text(text)
        return path

    return written


def test_every_key_of_a_batch_file_is_read(write: Any, tmp_path: Path) -> None:
    found = load_batch(write(WHOLE))
    assert found.programs == (str(tmp_path / "mine.py"), "log_greys", "lab.ipynb#2")
    assert found.choices == {
        "noise.motor": (0, 20),
        "robot.wheel_diameter_mm": (54.0, 54.5, 55.0),
        "background": ("Loop", "Lollipop"),
        "start.x_mm": SampleValues(RandomDraw.RANDOM, 100, 300, 20),
        "seed": (0, 1, 2, 3),
    }
    assert (found.jobs, found.keep, found.out, found.goals) == (
        2,
        "failed",
        str(tmp_path / "rows.csv"),
        str(tmp_path / "goals.toml"),
    )
    assert found.expressions == {"far_mm": "hypot(x_mm, y_mm)"}
    assert found.world is not None and found.world.settings["background"] == "Loop"


def test_a_batch_file_may_name_a_world_file(write: Any, tmp_path: Path) -> None:
    (tmp_path / "lab.toml").write_text('background = "Square"')
    found = load_batch(write('[batch]\nworld = "lab.toml"\nseeds = [1, 5]'))
    assert found.world is not None and found.world.settings["background"] == "Square"
    assert found.choices == {"seed": (1, 5)}


@pytest.mark.parametrize(
    "text, expected",
    [("[batch]", True), ('background = "Loop"', False), ("[[goal]]", False), ("not toml", False)],
)
def test_a_toml_file_is_a_batch_file_only_with_a_table_batch(
    write: Any, text: str, expected: bool
) -> None:
    assert is_batch_file(str(write(text))) is expected


@cases(
    "text, words",
    {
        "misspelt": (
            "[batch]\nprogramm = 'a.py'",
            "batch.programm: no such key .did you mean program",
        ),
        "jobs": ("[batch]\njobs = 0", "batch.jobs: must be a whole number from 1"),
        "seeds": ("[batch]\nseeds = [1, 1]", "batch.seeds: the seed 1 occurs twice"),
        "seed text": ("[batch]\nseeds = '3..1'", "batch.seeds: 3..1 has no values"),
        "twice": (
            "[batch]\nseeds = 1\nset.seed = 2",
            "batch.seeds: cannot be combined with set.seed",
        ),
        "no values": ("[batch]\nset.noise.motor = []", "batch.set.noise.motor: has no values"),
        "nested list": ("[batch]\nset.a = [[1]]", r"batch.set.a\[1\]: must be a text, a number"),
        "range": ("[batch]\nset.a = '1:2:0'", "batch.set.a: 1:2:0 has no values"),
        "keep": ("[batch]\nkeep = 'some'", "batch.keep: no such value 'some'"),
        "expression": ("[batch]\nexpressions.a = 1", "batch.expressions.a: must be text"),
        "no world": ("[batch]\nworld = 'none.toml'", "none.toml: there is no such file"),
        "two": ("walls = true\n[batch]\nworld = 'a.toml'", "batch.world: cannot be combined with"),
        "key of a world": (
            "wall = true\n[batch]",
            "spec.toml: wall: no such key .did you mean walls",
        ),
    },
)
def test_faulty_batch_files_are_explained(write: Any, text: str, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        load_batch(write(text))


def test_opening_a_batch_file_as_a_world_is_refused(write: Any) -> None:
    with pytest.raises(
        ConfigError, match=r"spec.toml: is a batch file, not a world \(start it with: tuisim batch "
    ):
        WorldFile.load(write("[batch]"))
