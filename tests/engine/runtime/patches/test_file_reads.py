"""A run says which files it has read that were there before it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import Run
from tuisim.engine.runs.side_files import MAX_READS, FileRead, FilesRead, read_state

SETUP = "import io, os, pathlib, shutil\n"
READS = {
    "open": "open('data.txt').read()",
    "by keyword": "open(file='data.txt', mode='rb').close()",
    "in bytes": "open(b'data.txt').close()",
    "io": "io.open('data.txt').close()",
    "os": "os.close(os.open('data.txt', os.O_RDONLY))",
    "pathlib": "pathlib.Path('data.txt').read_text()",
    "to change it": "open('data.txt', 'r+').close()",
    "to add to it, and read": "open('data.txt', 'a+').close()",
    "after adding to it": "open('data.txt', 'a').write('x')\nopen('data.txt').read()",
    "a copy": "shutil.copyfile('data.txt', 'copy.txt')\nopen('copy.txt').read()",
    "moved": "os.rename('data.txt', 'elsewhere.txt')\nos.rename('elsewhere.txt', 'data.txt')\nopen('data.txt').read()",
    "twice, in another folder": "open('data.txt').close()\nos.mkdir('folder')\nos.chdir('folder')\nopen('../data.txt')",
}
NO_READS = {
    "written": "open('data.txt', 'w').write('x')\nopen('data.txt').read()",
    "made": "open('new.txt', 'x').write('x')\nopen('new.txt').read()",
    "added to": "open('data.txt', 'a').write('x')",
    "grown": "open('new.txt', 'a+').write('x')\nopen('new.txt').read()",
    "made and moved": "open('new.txt', 'w').write('x')\nos.replace('new.txt', 'data.txt')\nopen('data.txt').read()",
    "made by os": "os.close(os.open('new.txt', os.O_RDWR | os.O_CREAT))\nopen('new.txt').read()",
    "listed": "os.listdir(), os.path.exists('data.txt')\nos.close(os.open('.', os.O_RDONLY))",
    "Python's": "import this_is_mine, json\nopen(json.__file__).read()\nopen(this_is_mine.__file__).read()",
    "the program": "open('program.py').read()",
    "the system's": "open('/proc/self/stat').read()\nopen(os.devnull).read()",
    "a descriptor": "inlet, outlet = os.pipe()\nopen(outlet, 'w').close()\nopen(inlet).read()",
    "a folder that is removed": "os.makedirs('a/b')\nshutil.rmtree('a')",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory of the program, with a file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data.txt").write_text("12")
    (tmp_path / "this_is_mine.py").write_text("x = 1\n")
    (tmp_path / "program.py").write_text("")
    return tmp_path


@cases("text", READS)
def test_a_file_that_a_program_reads_is_noted_with_its_state_before(
    run: Run, folder: Path, text: str
) -> None:
    before = read_state(str(folder / "data.txt"))
    done = run(SETUP + text, prelude="none")
    assert done.ended.end == "finished", done.errors
    assert FilesRead.read(done.run.folder).files == (before,)


@cases("text", NO_READS)
def test_files_that_the_program_wrote_itself_are_not_noted_as_read(
    run: Run, folder: Path, text: str
) -> None:
    done = run(SETUP + text, prelude="none")
    assert done.ended.end == "finished", done.errors
    assert FilesRead.read(done.run.folder).files == ()


def test_a_file_that_a_program_looks_for_in_vain_is_noted(run: Run, folder: Path) -> None:
    done = run("try:\n    open('calibration.json')\nexcept OSError:\n    pass", prelude="none")
    assert FilesRead.read(done.run.folder).files == (
        FileRead(str(folder / "calibration.json"), there=False),
    )


def test_files_read_beyond_the_limit_are_only_counted(run: Run, folder: Path) -> None:
    text = f"for n in range({MAX_READS + 7}):\n    try:\n        open(f'n{{n}}')\n    except OSError:\n        pass"
    read = FilesRead.read(run(text, prelude="none").run.folder)
    assert (len(read.files), read.left_out) == (MAX_READS, 7)


def test_opening_what_is_no_path_raises_the_errors_of_python(run: Run, folder: Path) -> None:
    done = run(
        "class Odd:\n    def __fspath__(self): raise KeyError('odd')\nimport os\n"
        "for call in (lambda: open(), lambda: open(Odd()), lambda: open(3.5), lambda: open('a\\0b'),\n"
        "             lambda: open('data.txt', 'q'), lambda: open('x' * 9999), lambda: os.open('data.txt'),\n"
        "             lambda: os.rename('data.txt')):\n"
        "    try:\n        call()\n    except Exception as e:\n        print(type(e).__name__, str(e)[:31])",
        prelude="none",
    )
    assert done.lines == [
        "TypeError open() missing required argumen",
        "KeyError 'odd'",
        "TypeError expected str, bytes or os.PathL",
        "ValueError embedded null byte",
        "ValueError invalid mode: 'q'",
        "OSError [Errno 36] File name too long: ",
        "TypeError open() missing required argumen",
        "TypeError rename() missing required argum",
    ]
    assert FilesRead.read(done.run.folder).files == ()


def test_a_read_of_a_file_whose_name_is_not_utf_8_is_noted(run: Run, folder: Path) -> None:
    done = run(
        "import os\nopen(os.fsencode('a\\x1b') + b'\\xff', 'w').close()\nopen('b\\udcfe') ",
        prelude="none",
    )
    assert [file.path for file in FilesRead.read(done.run.folder).files] == [f"{folder}/b\udcfe"]
