"""A mat that does not exist, or a wrong option, in a magic line."""

from __future__ import annotations

import pytest

from tuisim.base.errors import ConfigError
from tuisim.programs.program_file import (
    drop_wrong_mat,
    find_mistake,
    find_wrong_mat,
    parse_program,
)

WRONG = '"""A program."""\n# %%sim_magic_preloaded -b Grey_bandz -x 300\n'


def test_a_wrong_mat_is_named_with_file_line_and_what_may_be_meant() -> None:
    found = find_wrong_mat(WRONG, "mine.py", None)
    assert found is not None
    assert found.line == 2
    assert found.words == "no such mat 'Grey_bandz', did you mean Grey_bands?"
    assert found.error.file == "mine.py, line 2"


@pytest.mark.parametrize(
    "words", ["", "# %%sim_magic -b Grey_bands", "# %%sim_magic -b mine.png", "# %%sim_magic -y ?"]
)
def test_a_magic_line_without_a_wrong_mat_is_not_reported(words: str) -> None:
    assert find_wrong_mat(f"{words}\n", "mine.py", None) is None


def test_a_program_opens_without_its_wrong_mat() -> None:
    assert drop_wrong_mat(parse_program(WRONG, "mine.py"), None).options == {"start.x_mm": 300}


def test_a_program_opens_without_the_options_of_a_wrong_line_which_says_what_was_meant() -> None:
    text = "\n# %%sim_magic_preloaded -b Loop -A 90\n"
    with pytest.raises(ConfigError):
        parse_program(text, "mine.py")
    assert parse_program(text, "mine.py", is_unfinished=True).options == {}
    mistake = find_mistake(text, "mine.py")
    assert mistake is not None
    assert (mistake.line, mistake.message) == (
        2,
        "line 2: got unexpected extra argument (90) "
        "(did you mean -a 90? -a: Start heading, counter-clockwise from +x)",
    )
