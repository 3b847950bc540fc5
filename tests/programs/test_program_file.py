"""What a file of a program holds: its magic line, its prelude, its text; and which file a word names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.programs.program_file import (
    MAX_PROGRAM_BYTES,
    describe_new_file,
    find_magic,
    find_program,
    list_programs,
    parse_program,
    parse_unfinished,
    read_program,
    replace_mat,
)


def test_an_example_is_found_by_its_name_unless_a_file_has_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    example = list_programs()[0].path
    assert find_program(example.stem) == find_program(example.name) == example
    Path(example.name).write_text("")
    assert find_program(example.name) == Path(example.name)
    assert find_program("no_such") == Path("no_such")


@pytest.mark.parametrize(
    "name, data, said",
    [
        ("none.py", None, "there is no such program"),
        ("notes.ipynb", b"{}", "is a notebook"),
        ("picture.txt", b"0 mm  100 mm\n", "is text, not a program"),
        (
            "drive.sh",
            b"#!/bin/bash\necho run-forever > $M/command\n",
            "is a shell script, not a program in Python",
        ),
        ("null.py", b"x = 1\0\n", "null characters"),
        ("bytes.py", b"x = '\xff'\n", "bytes.py: is not Python text"),
        ("coding.py", b"# coding: klingon\n", "is not Python text"),
        ("large.py", b"#" * (MAX_PROGRAM_BYTES + 1), "is larger than 4 MiB"),
    ],
)
def test_a_file_that_is_no_program_says_why(
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
    "name, notice",
    {
        "square2.py": "new file square2.py; did you mean square.py?",
        "log_gerys.py": "new file log_gerys.py; did you mean log_greys.py?",
        "xylophone.py": "new file xylophone.py",
    }.items(),
)
def test_a_new_file_names_similar_files_and_examples(
    name: str, notice: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "square.py").touch()
    monkeypatch.chdir(tmp_path)
    assert describe_new_file(Path(name)) == notice
    assert describe_new_file(tmp_path / name) == notice


def test_a_program_may_be_in_a_txt_file(tmp_path: Path) -> None:
    path = tmp_path / "prog.txt"
    path.write_text("x = 1\n")
    assert read_program(path).program.text == "x = 1\n"


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
def test_an_unfinished_programs_predefined_names_are_known_while_editing(
    text: str, prelude: str
) -> None:
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


@for_rows("before, after", MAGIC_MATS)
def test_a_mat_is_written_into_the_magic_line(before: str, after: str) -> None:
    assert replace_mat(before, "p.py", "Loop") == after


PLAIN = "import time\nprint(1)\n"


@for_rows(
    "text, line, prelude, comment",
    [
        ("%%sim_magic_preloaded -b Loop -OHR\n" + PLAIN, 1, "preloaded", False),
        ("%%sim_magic_imports\n" + PLAIN, 1, "imports", False),
        ("%sim_magic -R\n" + PLAIN, 1, "none", False),
        ("# %%sim_magic -b Loop\n" + PLAIN, 1, "none", True),
        ("#%%sim_magic_preloaded\n" + PLAIN, 1, "preloaded", True),
        ('"""Title."""\n# %%sim_magic_preloaded\n' + PLAIN, 2, "preloaded", True),
        ('"""Title.\n\n%%sim_magic\n"""\n\n# %%sim_magic_imports\n' + PLAIN, 6, "imports", True),
        (
            "#!/usr/bin/env python3\n# -*- coding: utf-8 -*-\n\n# %%sim_magic_imports\n" + PLAIN,
            4,
            "imports",
            True,
        ),
    ],
)
def test_magic_line_is_found(text: str, line: int, prelude: str, comment: bool) -> None:
    magic = find_magic(text, "a.py")
    assert magic is not None
    assert (magic.line, magic.prelude, magic.comment) == (line, prelude, comment)


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN + "# %%sim_magic -b Loop\n",
        '"""\n%%sim_magic\n"""\n',
        "# about %%sim_magic\n",
        "",
    ],
    ids=["none", "too late", "in the docstring", "in a sentence", "empty"],
)
def test_a_line_that_is_no_magic_is_not_taken_for_one(text: str) -> None:
    assert find_magic(text, "a.py") is None


@pytest.mark.parametrize("end", ["\n", ""], ids=["newline", "end of file"])
def test_a_raw_magic_line_becomes_a_comment_and_lines_keep_their_numbers(
    end: str,
) -> None:
    program = parse_program(f"\n%%sim_magic_preloaded -b Grey_bands -OHR{end}", "a.py")
    assert program.program.text == f"\n# %%sim_magic_preloaded -b Grey_bands -OHR{end}"
    assert program.options["background"] == "Grey_bands"


@for_rows(
    "text, prelude",
    [
        ("from ev3dev2.motor import MoveTank\n", "none"),
        ("import ev3dev2.sensor as s\n", "none"),
        ("def f():\n    from ev3dev2 import motor\n", "none"),
        ("from ev3dev2.motor import (\n", "none"),
        ("print('import ev3dev2')\n", "none"),
        ("from ev3dev2_glue import get_clock\nprint(get_clock())\n", "none"),
        ("from lib import go\ngo()\n", "none"),
        ("tank_drive.on(10, 10)\n", "preloaded"),
        ("from lib import *\ntank_drive.on(10, 10)\n", "preloaded"),
        ("def f():\n    return [colorLeft.color for _ in range(3)]\n", "preloaded"),
        ("def f(gyro):\n    return gyro.angle\n", "none"),
        ("class Team:\n    gyro = 3\n    print(gyro)\n", "none"),
        ("def f():\n    global gyro\n    gyro = 3\nf()\nprint(gyro)\n", "none"),
        ("def say(text):\n    print(text)\nsay('hello')\n", "none"),
        ("# tank_drive\nprint('tank_drive')\n", "none"),
        ("print(eval(input()))\n", "preloaded"),
        ("tank_drive.on(10, 10\n", "preloaded"),
        ("# %%sim_magic_imports --preload none\n", "none"),
    ],
)
def test_imports_decide_which_names_are_predefined(text: str, prelude: str) -> None:
    assert parse_program(text, "a.py").program.prelude == prelude


@pytest.mark.parametrize(
    "line, said",
    [
        ("%%sim_magic_preloded -b Loop", r"^a\.py, line 1: no such magic .*sim_magic_preloaded"),
        ("# %%sim_magic -x abc", r"^a\.py, line 1: -x: must be a number"),
        ("# %%sim_magic -b 'Loop", r"^a\.py, line 1: cannot be split"),
        ("# %%sim_magic -s other", r"^a\.py, line 1: no such option"),
    ],
    ids=["name", "value", "quote", "switch"],
)
def test_wrong_magic_lines_say_where(line: str, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        parse_program(line + "\n", "a.py")


def test_missing_program_names_its_neighbour(tmp_path: Path) -> None:
    (tmp_path / "follow.py").touch()
    with pytest.raises(ConfigError, match=r"no such program \(did you mean follow\.py\?\)"):
        read_program(tmp_path / "folow.py")


def test_only_a_word_without_a_folder_may_be_meant_as_an_example(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="did you mean log_greys"):
        read_program(Path("log_grays"))
    with pytest.raises(ConfigError, match="see `tuisim programs`"):
        read_program(tmp_path / "log_grays")


def test_other_encodings_and_line_ends_are_read(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_bytes("# coding: latin-1\r\nx = 'ä'\r\n".encode("latin-1"))
    assert read_program(file).program.text == "# coding: latin-1\nx = 'ä'\n"
