"""Words that no file system takes, and users that nobody knows: a clear line, not an error of ours."""

from __future__ import annotations

import pytest

from tests.cases import for_each
from tuisim.cli import run_command

LONG = "x" * 300
NOBODY = "~nobody-at-all/x"


@pytest.mark.usefixtures("home")
@for_each(
    word=[LONG, LONG + ".toml", "9" * 5000, NOBODY],
    command=[
        "run",
        "runs show",
        "runs rm",
        "log summary",
        "goals check",
        "mark",
        "batch",
        "batch --seeds 0 --jobs 1",
        "learn check",
        "learn list --folder",
        "obstacles",
        "robots",
        "profiles",
        "guide",
        "backgrounds --mats",
        "backgrounds --use-originals",
        "run --world",
        "run --background",
        "run --mats",
        "run --robot",
        "kernel remove --prefix",
    ],
)
def test_a_word_that_cannot_be_a_file_name_is_refused_in_one_line(
    command: str, word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [*command.split(), word]
    if command.startswith("run --"):
        words.append("line_follower")
    assert run_command(words) == 2
    line = capsys.readouterr().err.removesuffix("\n")
    assert "\n" not in line
    assert len(line) < 2000
