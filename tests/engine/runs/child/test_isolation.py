"""`tuisim mark --isolate`: through bubblewrap where it can start, else refused with the reason."""

from __future__ import annotations

import os
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.isolated import needs_isolation, refusal
from tests.tasks.marks.right import HOPS
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.child import isolation
from tuisim.tasks.execute import execute
from tuisim.tasks.task import Task

GOALS = """\
title = "Isolation"
background = "Grey_bands"

[[goal]]
name = "finish"
finish = true
"""


@pytest.fixture
def port() -> Iterator[int]:
    """A port of this machine that accepts connections."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield int(server.getsockname()[1])


@pytest.fixture
def marked(tmp_path: Path, here: Command, port: int) -> dict[str, list[str]]:
    """The rows of isolated programs by name; empty where isolation is refused."""
    (tmp_path / "secret.txt").write_text("secret")
    programs = {
        "drives": HOPS,
        "own_files": "open('notes.txt', 'w').write('x')\nprint(open('notes.txt').read())\n",
        "reads_beside": f"print(open({str(tmp_path / 'secret.txt')!r}).read())\n",
        "reads_users": "print(open('/etc/passwd').read())\n",
        "writes_system": "open('/usr/x', 'w')\n",
        "connects": f"import socket\nsocket.create_connection(('127.0.0.1', {port}), 5)\n",
        "sends": "import socket\nsocket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('192.0.2.1', 9))\n",
        "kills_others": "import os\nos.kill(os.getppid() or 4711, 0)\n",
    }
    (tmp_path / "goals.toml").write_text(GOALS)
    (tmp_path / "class").mkdir()
    for name, text in programs.items():
        (tmp_path / "class" / f"{name}.py").write_text(text)
    words = ("mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    done = here(*words, "--isolate")
    if refusal():
        assert (done.returncode, done.stdout, done.stderr) == (2, "", f"tuisim: {refusal()}\n")
        return {}
    assert done.returncode == 0, done.stderr
    return {
        line.partition(".py ")[0]: line.split()
        for line in done.stdout.splitlines()
        if ".py " in line
    }


@pytest.mark.slow
def test_an_isolated_program_sees_its_own_folder_and_no_network(
    marked: dict[str, list[str]],
) -> None:
    if marked:
        assert {name for name, row in marked.items() if row[1] == "1"} == {"drives", "own_files"}
        reasons = {
            name: next(word for word in row if word.endswith("Error:"))
            for name, row in marked.items()
            if name not in ("drives", "own_files")
        }
        assert reasons == {
            "reads_beside": "FileNotFoundError:",
            "reads_users": "FileNotFoundError:",
            "writes_system": "OSError:",
            "connects": "ConnectionRefusedError:",
            "sends": "OSError:",
            "kills_others": "ProcessLookupError:",
        }


@needs_isolation
def test_what_an_isolated_program_writes_below_python_is_its_output(
    tmp_path: Path, spec: RunSpec
) -> None:
    program = Program(
        "below.py", "import os\nos.write(1, b'below\\n')", working_directory=str(tmp_path)
    )
    assert execute(Task(0, program, spec, isolate=True), tmp_path).output == "below"


SERVER = """\
import asyncio, socket
ends = socket.socketpair()
print(ends[0].sendmsg([b'a', b'bc']), ends[1].recv(9))

async def main():
    async def answer(_, writer):
        writer.writelines([b'one', b' two'])
        await writer.drain()
        writer.close()

    server = await asyncio.start_server(answer, '127.0.0.1', 0)
    reader, _ = await asyncio.open_connection(*server.sockets[0].getsockname())
    print((await reader.read()).decode())
    server.close()

asyncio.run(main())
"""


@needs_isolation
def test_an_isolated_program_may_be_a_server_of_its_own(tmp_path: Path, spec: RunSpec) -> None:
    program = Program("server.py", SERVER, working_directory=str(tmp_path))
    done = execute(Task(0, program, spec, isolate=True), tmp_path)
    assert (done.error, done.output) == ("", "3 b'abc'\none two")


def test_isolation_without_bubblewrap_is_refused(
    tmp_path: Path, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "goals.toml").write_text(GOALS)
    (tmp_path / "ada.py").write_text("")
    monkeypatch.setenv("PATH", str(tmp_path))
    done = here("mark", "goals.toml", "ada.py", "--isolate")
    assert (done.returncode, done.stdout) == (2, "")
    assert (
        done.stderr
        == "tuisim: --isolate: bwrap is not installed (install bubblewrap; --no-isolate goes without)\n"
    )


def test_where_bubblewrap_fails_isolation_is_refused_with_its_reason(
    tmp_path: Path, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "goals.toml").write_text(GOALS)
    (tmp_path / "ada.py").write_text("")
    bwrap = tmp_path / "bwrap"
    bwrap.write_text(
        "#!/bin/sh\necho 'bwrap: No permissions to create a new namespace' >&2\nexit 1\n"
    )
    bwrap.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    done = here("mark", "goals.toml", "ada.py", "--isolate")
    assert (done.returncode, done.stdout) == (2, "")
    assert "cannot start here: bwrap: No permissions to create a new namespace" in done.stderr


def test_the_guide_names_the_limits_that_are_set() -> None:
    # The attacks on a marking try them.
    page = (ROOT / "tuisim" / "guide" / "pages" / "security.md").read_text(encoding="utf-8")
    limits = {
        "memory": f"{isolation._MEMORY_BYTES >> 30} GiB",
        "processes, threads": f"1, {isolation._MAX_THREADS:,}",
        "its `/tmp`": f"{isolation._TMP_BYTES >> 20} MiB",
        "its files and its recording together": f"{isolation.MOST_BYTES >> 30} GiB, {isolation.MOST_FILES:,} files",
        "one file": f"{isolation.MOST_BYTES >> 30} GiB",
        "open files": f"{isolation._OPEN_FILES}",
        "sockets": f"{isolation._MAX_SOCKETS}",
    }
    assert [
        f"| {what} | {most} |"
        for what, most in limits.items()
        if f"| {what} | {most} |" not in page
    ] == []


def test_deleted_files_that_are_still_open_count_for_the_disk_quota(tmp_path: Path) -> None:
    def sizes() -> list[int]:
        return sorted(isolation.Quota(os.getpid(), [tmp_path])._measure_nameless())

    before = sizes()
    with (tmp_path / "file").open("wb") as file:
        file.write(bytes(1 << 20))
        file.flush()
        os.fsync(file.fileno())
        assert sizes() == before
        os.unlink(file.name)
        assert sum(sizes()) - sum(before) == pytest.approx(1 << 20, rel=0.1)


@pytest.fixture
def idle_pid() -> Iterator[int]:
    """The number of a process that has no file open that is deleted, as that of the tests may have."""
    with subprocess.Popen(["cat"], stdin=subprocess.PIPE) as idle:
        yield idle.pid
        assert idle.stdin is not None
        idle.stdin.close()


@pytest.mark.parametrize(
    "files, size, says", [(3, 1, ""), (4, 1, "more than 3 files"), (1, 9, "more than")]
)
def test_files_added_beyond_the_quota_of_number_or_size_are_noticed(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    idle_pid: int,
    files: int,
    size: int,
    says: str,
) -> None:
    monkeypatch.setattr(isolation, "MOST_FILES", 3)
    monkeypatch.setattr(isolation, "MOST_BYTES", 1 << 17)
    (tmp_path / "there").write_bytes(bytes(1 << 19))
    quota = isolation.Quota(idle_pid, ["", tmp_path])
    assert quota.exceeded(5.0) == ""
    for number in range(files):
        (tmp_path / str(number)).write_bytes(b"x" * (size << 14))
    assert quota.exceeded(5.0) == ""
    assert says in quota.exceeded(1e9)
    assert bool(quota.exceeded(2e9)) == bool(says)
