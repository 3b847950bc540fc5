"""Program text is read as Python reads it, everywhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Command
from tests.running import Run
from tuisim.app.editor.text_file import read_text
from tuisim.base.errors import ConfigError
from tuisim.base.source import find_code_line, source_lines
from tuisim.engine.runs.child.process import find_stuck_line
from tuisim.programs.program_file import parse_program, read_program

NO_ENDS = "\x0b \x0c \x1c \x1d \x1e \x85 \u2028 \u2029"
ODD = f"# \x0c\n\x0cx = '''{NO_ENDS}'''\nprint('A: 1')\nz = 1 / 0\n"
"""The error is in line 4."""


@pytest.mark.parametrize(
    "text", ["", "\n", "a", "a\n", "a\n\n", "a\r\nb\rc\n", f"a{NO_ENDS}\nb", "\x0c\n"], ids=repr
)
def test_source_lines_splits_a_text_as_python_does(text: str, tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_bytes(text.encode())
    with file.open(encoding="utf-8") as lines:
        assert source_lines(text) == [line.removesuffix("\n") for line in lines]


def test_an_error_shows_its_own_line_despite_odd_line_ends(run: Run) -> None:
    assert run(ODD).errors[1:3] == ['  File "program.py", line 4, in <module>', "    z = 1 / 0"]


def test_a_breakpoint_shows_its_own_line_despite_odd_line_ends(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "odd.py").write_text(ODD)
    assert "    4 | z = 1 / 0\n" in here("run", "odd.py", "--break", "4").stderr


def test_a_magic_line_is_found_on_its_own_line() -> None:
    with pytest.raises(ConfigError, match=r"odd\.py, line 2: "):
        parse_program("# \x0c\n# %%sim_magic_none\n", "odd.py")


def test_commenting_out_a_magic_line_leaves_the_other_lines_unchanged() -> None:
    expected = f"# {NO_ENDS}\n# %%sim_magic -R\nx = 1\n"
    assert parse_program(f"# {NO_ENDS}\n%%sim_magic -R\nx = 1\n", "odd.py").program.text == expected


@pytest.mark.parametrize("encoding", ["rot13", "hex", "zip", "undefined", "idna", "no-such"])
@pytest.mark.parametrize("read", [read_program, read_text], ids=["run", "editor"])
def test_a_program_that_declares_an_encoding_of_no_text_is_refused(
    tmp_path: Path, encoding: str, read: object
) -> None:
    assert callable(read)
    file = tmp_path / "coded.py"
    file.write_bytes(f"# coding: {encoding}\ncevag('\u00e4')\n".encode())
    with pytest.raises(ConfigError, match=r"coded\.py: is not Python text: .*\(save it as UTF-8\)"):
        read(file)


@pytest.mark.parametrize("encoding", ["punycode", "PUNYCODE", "idna"])
def test_a_program_in_an_encoding_of_domain_names_is_refused_before_it_is_decoded(
    tmp_path: Path, encoding: str
) -> None:
    file = tmp_path / "slow.py"
    # Decoding this as punycode would succeed, and take hours if the file were larger.
    file.write_bytes(f"# coding: {encoding}\n#-aaaa".encode())
    with pytest.raises(ConfigError, match="is an encoding of domain names"):
        read_program(file)


@pytest.mark.parametrize(
    "name", ["größe.py", "\u2028\U0001f600.py", "x" * 600 + ".py"], ids=["letters", "odd", "long"]
)
def test_a_stuck_line_is_found_whatever_the_program_is_called(tmp_path: Path, name: str) -> None:
    written = name.encode("ascii", "backslashreplace").decode()
    shown = written if len(name) <= 500 else written[:500] + "..."
    (tmp_path / "stack.txt").write_text(
        f'Current thread 0x1 (most recent call first):\n  File "{shown}", line 7 in f\n'
    )
    assert find_stuck_line(tmp_path, name) == 7


@pytest.mark.parametrize(
    "line, code",
    [(1, 4), (2, 4), (3, 4), (4, 4), (5, 0)],
    ids=["magic", "comment", "blank", "code", "end"],
)
def test_a_breakpoint_is_on_the_next_line_of_code(line: int, code: int) -> None:
    assert (
        find_code_line(["%%sim_magic", "  # words", "", "x = 1  # more", "# the end"], line) == code
    )
