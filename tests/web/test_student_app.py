"""What a student's app opens, where it runs, and what it cannot reach where it is isolated."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.isolated import needs_isolation
from tuisim.web.class_links import StudentLink
from tuisim.web.student_app import Handed, app_of, handed_out


@pytest.fixture
def tutor(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which the tutor starts the server."""
    (tmp_path / "tutor").mkdir()
    monkeypatch.chdir(tmp_path / "tutor")
    for name in ("lab.py", "two.ipynb", "w.toml", "mat.png"):
        (tmp_path / "tutor" / name).write_text(name)
    return tmp_path / "tutor"


@pytest.fixture
def ada(tmp_path: Path) -> StudentLink:
    return student(tmp_path, "Ada")


def student(folder: Path, name: str) -> StudentLink:
    made = StudentLink(name, "x" * 32, folder / "class" / name, folder / "class" / ".homes" / name)
    made.folder.mkdir(parents=True)
    made.home.mkdir(parents=True)
    return made


HANDED = {
    "nothing": ("", "", [], []),
    "a program": ("lab.py -R", "lab.py -R", ["lab.py"], []),
    "a cell of a notebook": ("two.ipynb#2", "two.ipynb#2", ["two.ipynb"], []),
    "a world": ("w.toml", "{here}/w.toml", [], ["w.toml"]),
    "an image": ("lab.py -b mat.png", "lab.py -b {here}/mat.png", ["lab.py"], ["mat.png"]),
    "an image after a sign": (
        "--background=mat.png",
        "--background={here}/mat.png",
        [],
        ["mat.png"],
    ),
    "an example and a mat": ("line_follower -b Loop", "line_follower -b Loop", [], []),
    "arguments of the program": ("lab.py -- w.toml", "lab.py -- w.toml", ["lab.py"], []),
}


@pytest.mark.parametrize(("words", "told", "copied", "read"), HANDED.values(), ids=HANDED)
def test_files_are_copied_or_named_by_their_path(
    words: str, told: str, copied: list[str], read: list[str], tutor: Path
) -> None:
    here = Path(os.path.realpath(tutor))
    assert handed_out(words.split()) == Handed(
        tuple(told.format(here=here).split()),
        tuple(here / name for name in copied),
        tuple(here / name for name in read),
    )


def test_a_copy_is_the_students_and_is_not_replaced(tutor: Path, ada: StudentLink) -> None:
    for text in ("lab.py", "changed by Ada"):
        command, place = app_of(ada, handed_out(["lab.py"]), isolated=False)
        assert (ada.folder / "lab.py").read_text() == text
        (ada.folder / "lab.py").write_text("changed by Ada")
    assert (tutor / "lab.py").read_text() == "lab.py"
    assert (command[-2:], place.folder) == (["open", "lab.py"], ada.folder)


@pytest.mark.usefixtures("tutor")
def test_a_copy_does_not_follow_a_link(ada: StudentLink, tmp_path: Path) -> None:
    (ada.folder / "lab.py").symlink_to(tmp_path / "elsewhere")
    app_of(ada, handed_out(["lab.py"]), isolated=False)
    assert not (tmp_path / "elsewhere").exists()


def test_what_the_tutors_environment_says_is_not_passed_on(
    ada: StudentLink, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("API_KEY", "secret")
    _, place = app_of(ada, Handed((), (), ()), isolated=False)
    assert place.variables is not None
    assert "API_KEY" not in place.variables
    assert (place.variables["TUISIM_HOME"], place.variables["HOME"]) == (
        str(ada.home),
        str(ada.folder),
    )


KERNELS = {"6.18.44-x": True, "5.14.0": True, "5.13.9": False, "4.20": False, "unknown": False}


@pytest.mark.parametrize(("release", "limited"), KERNELS.items())
def test_processes_are_limited_where_each_app_is_counted_by_itself(
    release: str, limited: bool, ada: StudentLink, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("platform.release", lambda: release)
    commands = [
        " ".join(app_of(ada, Handed((), (), ()), isolated=isolated)[0])
        for isolated in (True, False)
    ]
    assert ["RLIMIT_NPROC" in command for command in commands] == [limited, False]


ATTACKS = {
    "reading the file of another": "open('{bob}/secret').read()",
    "reading the runs of another": "open('{bobs_home}/runs').read()",
    "listing the class": "assert set(os.listdir('{folder}')) - {{'Ada', '.homes'}}",
    "reading the links": "open('{folder}/.links.json').read()",
    "writing to another": "open('{bob}/new', 'w')",
    "reading what the tutor has": "open('{tutor}/w.toml').read()",
    "changing what the tutor hands out": "open('{tutor}/mat.png', 'w')",
    "seeing the server": "os.kill({pid}, 0)",
    "the network": "socket.create_connection(('127.0.0.1', {port}), 1)",
    "much memory": "bytearray(3 << 30)",
    "a file of two gigabytes": "open('big', 'wb').truncate(2 << 30)",
    "a way out by a link": "os.symlink('{bob}', 'way'); open('way/secret').read()",
}


@needs_isolation
def test_an_isolated_app_reaches_nothing_of_others(
    tutor: Path, ada: StudentLink, tmp_path: Path
) -> None:
    import socket

    bob = student(tmp_path, "Bob")
    for path in (bob.folder / "secret", bob.home / "runs", bob.folder.parent / ".links.json"):
        path.write_text("secret")
    command, place = app_of(ada, handed_out(["-b", "mat.png"]), isolated=True)
    with socket.create_server(("127.0.0.1", 0)) as server:
        told = {
            "bob": bob.folder,
            "bobs_home": bob.home,
            "folder": bob.folder.parent,
            "tutor": tutor,
            "pid": os.getpid(),
            "port": server.getsockname()[1],
        }
        lines = ["import os, socket"]
        for name, attack in ATTACKS.items():
            lines += [
                "try:",
                f"    {attack.format(**told)}",
                f"    print({name!r})",
                "except BaseException: pass",
            ]
        lines += [
            "open('own', 'w').write('x')",
            "open(os.environ['TUISIM_HOME'] + '/own', 'w').write('x')",
        ]
        lines += [f"print(open('{tutor}/mat.png').read())", "print('done')"]
        # The same start, with an attack in the place of the app.
        at = command.index("-c") + 1
        start = command[at].partition("import sys; sys.path")[0]
        assert "resource.RLIMIT_AS" in start
        code = start + "\n".join(lines)
        done = subprocess.run(
            [*command[:at], code],
            env=place.variables,
            cwd=place.folder,
            capture_output=True,
            text=True,
            check=False,
        )
    assert (done.stdout, done.stderr) == ("mat.png\ndone\n", "")
    assert (ada.folder / "own").exists() and (ada.home / "own").exists()
    assert (bob.folder / "secret").read_text() == "secret"
