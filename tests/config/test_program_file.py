"""What a file of a program holds: its magic line, its prelude, its text; and which file a word names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.config.program_file import (
    find_magic,
    find_program,
    parse_program,
    parse_unfinished,
    prelude_for,
    programs,
    read_program,
    with_mat,
)
from tuisim.errors import ConfigError


@pytest.mark.parametrize(
    "text, line, is_comment",
    [
        ("# %%sim_magic_preloaded -x 5\n", 1, True),
        ("\n# words\n%%sim_magic_preloaded -x 5\nx = 1\n", 3, False),
        ("'''What it does.'''\n# %sim_magic_preloaded -x 5\n", 2, True),
    ],
    ids=["comment", "cell", "below a docstring"],
)
def test_a_magic_line_is_found_before_the_first_statement(
    text: str, line: int, is_comment: bool
) -> None:
    magic = find_magic(text, "p.py")
    assert magic is not None
    assert (magic.line, magic.comment, magic.prelude) == (line, is_comment, "preloaded")


def test_a_magic_line_below_a_statement_is_a_comment() -> None:
    assert find_magic("x = 1\n# %%sim_magic_preloaded -x 5\n", "p.py") is None


@pytest.mark.parametrize(
    "text, said",
    [
        ("# %%sim_magic_preloded\n", "no such magic"),
        ("# %%sim_magic -x 'five\n", "cannot be split"),
        ("# %%sim_magic -x five\n", "-x"),
    ],
)
def test_a_wrong_magic_line_is_told_with_its_place(text: str, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        find_magic("\n" + text, "p.py")
    assert said in str(caught.value) and "p.py, line 2" in str(caught.value)


@pytest.mark.parametrize(
    "text, prelude",
    [
        ("from ev3dev2.motor import LargeMotor\n", "none"),
        ("def go():\n    import ev3dev2.sensor\n", "none"),
        ("print(1)\n", "none"),
        ("tank_drive.off()\n", "preloaded"),
        ("tank_drive = None\ntank_drive.off()\n", "none"),
        ("eval(input())\n", "preloaded"),
        ("tank_drive.on(\n", "preloaded"),
        ("import ev3dev2\nx = (\n", "none"),
    ],
    ids=[
        "imports",
        "imports later",
        "uses nothing",
        "uses a name",
        "defines it",
        "may use any",
        "broken",
        "broken one",
    ],
)
def test_a_program_without_a_magic_line_has_the_prelude_that_it_uses(
    text: str, prelude: str
) -> None:
    assert prelude_for(text) == prelude


def test_the_magic_line_of_a_cell_becomes_a_comment() -> None:
    source = parse_program("%%sim_magic_preloaded\nx = 1\n", "p.py")
    assert source.program.text == "# %%sim_magic_preloaded\nx = 1\n"
    assert source.has_magic


def test_an_example_is_found_by_its_name_unless_a_file_has_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    example = programs()[0].path
    assert find_program(example.stem) == find_program(example.name) == example
    Path(example.name).write_text("")
    assert find_program(example.name) == Path(example.name)
    assert find_program("no_such") == Path("no_such")


@pytest.mark.parametrize(
    "name, data, said",
    [
        ("none.py", None, "there is no such program"),
        ("notes.ipynb", b"{}", "is a notebook"),
        ("null.py", b"x = 1\0\n", "null characters"),
        ("bytes.py", b"x = '\xff'\n", "bytes.py"),
    ],
)
def test_what_is_no_program_is_told(
    name: str, data: bytes | None, said: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(ConfigError, match=said):
        read_program(path)
    if name == "bytes.py":
        assert read_program(path, as_python=True).program.text == "x = '\udcff'\n"


@pytest.mark.parametrize(
    "text, prelude",
    [
        ("tank_dr", "preloaded"),
        ("tank_drive.on(", "preloaded"),
        ("# %%sim_magic\ntank_dr", "none"),
        ("# %%sim_magic_preloaded -x\n", "preloaded"),
        ("import ev3dev2\ntank_dr", "none"),
        ("from pybricks.hubs import (", "none"),
    ],
    ids=[
        "no name yet",
        "not Python yet",
        "magic",
        "unfinished magic",
        "library",
        "unfinished import",
    ],
)
def test_a_program_that_is_edited_has_the_names_that_it_may_use(text: str, prelude: str) -> None:
    program = parse_unfinished(text, "p.py")
    assert (program.text, program.prelude) == (text, prelude)


MAGIC_MATS = {
    "replaced": (
        "# %%sim_magic_preloaded -OHRb Grey_bands -x 3\nx\n",
        "# %%sim_magic_preloaded -OHRb Loop -x 3\nx\n",
    ),
    "added": ("%%sim_magic -x 3\n", "%%sim_magic -x 3 -b Loop\n"),
    "long option": (
        "# %%sim_magic --background='a b.png' -x 5\n",
        "# %%sim_magic --background=Loop -x 5\n",
    ),
    "quoted": ('# %%sim_magic -b "a b.png"\n', "# %%sim_magic -b Loop\n"),
    "without a line": ("print(1)\n", "# %%sim_magic_preloaded -b Loop\nprint(1)\n"),
    "after the docstring": ('"""A\nB"""\nx\n', '"""A\nB"""\n# %%sim_magic_preloaded -b Loop\nx\n'),
    "after the interpreter": (
        "#!/usr/bin/python3\nx\n",
        "#!/usr/bin/python3\n# %%sim_magic_preloaded -b Loop\nx\n",
    ),
    "unfinished": ("print(\n", "# %%sim_magic_preloaded -b Loop\nprint(\n"),
}


@cases("before, after", MAGIC_MATS)
def test_a_mat_is_written_into_the_magic_line(before: str, after: str) -> None:
    assert with_mat(before, "p.py", "Loop") == after
