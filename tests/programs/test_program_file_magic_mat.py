"""A mat that does not exist in a magic line."""

from __future__ import annotations

import pytest

from tuisim.programs.program_file import drop_wrong_mat, find_wrong_mat, parse_program

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
