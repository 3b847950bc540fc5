"""Lines that say what a task asks for, without a robot that does it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.tasks.goals.recorded import goals_of
from tuisim.tasks.marks.trial import ASK, answer_lines, build_matching_line

PATTERNS = [
    *(
        "house",
        "^done$",
        "(?i)black",
        r"\d+ mm",
        r"[A-Z]\w+: [^x]",
        "(?:yes|no) .*",
        r"^(\w+) \1$",
        r"a{3,}\.",
    ),
    *(r"\bgrey\b", r"^\s*[^\s\d]+\S$", "(?!x).", "[^a-zA-Z1 .:]"),
]


@pytest.mark.parametrize("pattern", PATTERNS)
def test_a_line_fits_its_pattern(pattern: str) -> None:
    line = build_matching_line(pattern)
    assert re.search(pattern, line) and "\n" not in line


def test_a_pattern_that_nothing_fits_gives_its_words() -> None:
    assert build_matching_line("(?=a)b") == "=ab"


TASK = """
[[goal]]
name = "said"
print = "^home"
after = "values"
[[goal]]
name = "values"
log = { name = "Grey", levels = [50.2, 7] }
[[goal]]
name = "asked"
dialogue = [{ answer = "5", reply = "25" }, { answer = "6" }]
[[goal]]
name = "when"
when = ["sample Red > 3", "sample Blue", "left_red_pc < 3"]
"""


def test_what_comes_after_something_is_said_after_it(tmp_path: Path) -> None:
    lines = answer_lines(goals_of(tmp_path, TASK))
    assert lines == ["Grey: 50.2", "Grey: 7", "home", ASK, "25", ASK, "Red: 4", "Blue: 1"]
