"""A name of nothing, such as a mat that does not exist, or a wrong option, in a magic line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.base.errors import ConfigError
from tuisim.programs.program_file import (
    drop_wrong_names,
    find_mistake,
    find_wrong_names,
    parse_program,
    read_program,
)

WRONG = '"""A program."""\n# %%sim_magic_preloaded -b Grey_bandz -x 300\n'


def test_a_wrong_mat_is_named_with_file_line_and_what_may_be_meant() -> None:
    (found,) = find_wrong_names(WRONG, None, "mine.py")
    assert found.line == 2
    assert found.words == "no such mat 'Grey_bandz', did you mean Grey_bands?"
    assert found.error.file == "mine.py, line 2"


@pytest.mark.parametrize("words", ["", "# %%sim_magic -b Grey_bands", "# %%sim_magic -y ?"])
def test_a_magic_line_without_a_wrong_mat_is_not_reported(words: str) -> None:
    assert not find_wrong_names(f"{words}\n", None, "mine.py")


def test_a_program_opens_without_its_wrong_mat() -> None:
    assert drop_wrong_names(parse_program(WRONG, "mine.py"), None).options == {"start.x_mm": 300}


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


@pytest.mark.parametrize(
    "option, words",
    [
        ("-r Small_Robt", "no such robot 'Small_Robt', did you mean Small_Robot or "),
        ("-o Wal", "no such obstacles 'Wal', did you mean Wall?"),
        ("--profile ev33", "no such profile 'ev33', did you mean ev3"),
        ("-b Gone.png", "Gone.png: cannot be read: "),
        ("-r gone.toml", "gone.toml: there is no such file"),
    ],
)
def test_a_program_opens_without_a_wrong_name_in_its_first_line_which_says_so(
    tmp_path: Path, option: str, words: str
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(f"# %%sim_magic_preloaded -x 300 {option}\n")
    source = read_program(file)

    assert drop_wrong_names(source, None).options == {"start.x_mm": 300}
    mistake = find_mistake(source.program.text, "mine.py", None, file)
    assert mistake is not None and mistake.line == 1
    assert words in mistake.message
