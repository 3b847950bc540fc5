"""Lines that say what a task asks for, without a robot that does it."""

from __future__ import annotations

import re
from pathlib import Path

from tests.cases import for_each
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


@for_each(pattern=PATTERNS)
def test_a_line_built_for_a_pattern_matches_it(pattern: str) -> None:
    line = build_matching_line(pattern)
    assert re.search(pattern, line) and "\n" not in line


def test_a_pattern_that_no_line_matches_gives_its_plain_words() -> None:
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


def test_lines_that_a_goal_wants_after_others_are_printed_after_them(tmp_path: Path) -> None:
    lines = answer_lines(goals_of(tmp_path, TASK))
    assert lines == ["Grey: 50.2", "Grey: 7", "home", ASK, "25", ASK, "Red: 4", "Blue: 1"]
