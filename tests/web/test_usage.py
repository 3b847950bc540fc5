"""What is counted of processes and files."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tuisim.guide.catalogue import pages
from tuisim.runs.child import isolation
from tuisim.web import usage
from tuisim.web.usage import Usage, files_exceeded, usages

PARENT = """
import subprocess, sys, threading, time
child = subprocess.Popen([sys.executable, "-IS", "-c", "import sys; sys.stdin.read()"], stdin=subprocess.PIPE)
threading.Thread(target=time.sleep, args=(60,), daemon=True).start()
held = bytearray(50_000_000)
print(flush=True)
sys.stdin.read()
"""


def test_a_process_is_counted_with_what_it_has_started() -> None:
    with subprocess.Popen(
        [sys.executable, "-IS", "-c", PARENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as one:
        assert one.stdout is not None and one.stdin is not None
        one.stdout.readline()
        found = usages([one.pid, os.getpid()])
        one.stdin.close()
    used = found[one.pid]
    assert (used.processes, used.threads) == (2, 3)
    assert 50_000_000 <= used.memory_bytes < 100_000_000
    assert found[os.getpid()].processes >= 3


def test_a_process_that_has_ended_uses_nothing() -> None:
    done = subprocess.Popen([sys.executable, "-IS", "-c", ""])
    done.wait()
    assert usages([done.pid]) == {done.pid: Usage()}


EXCEEDED = {
    "nothing": (Usage(), ""),
    "at the limits": (Usage(usage.MOST_MEMORY_BYTES, usage.MOST_PROCESSES, usage.MOST_THREADS), ""),
    "memory": (
        Usage(memory_bytes=usage.MOST_MEMORY_BYTES + 1),
        "The session has ended: it took more than 1 GiB of",
    ),
    "processes": (Usage(processes=25), "The session has ended: it had more than 24 processes."),
    "threads": (Usage(threads=1_001), "The session has ended: it had more than 1,000 threads."),
}


@pytest.mark.parametrize(("used", "told"), EXCEEDED.values(), ids=EXCEEDED)
def test_what_is_too_much_is_told(used: Usage, told: str) -> None:
    assert used.exceeded.startswith(told)
    assert bool(used.exceeded) is bool(told)


def test_files_are_counted_in_all_folders_and_links_are_not_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folders = [tmp_path / "a", tmp_path / "b", tmp_path / "none"]
    (tmp_path / "a" / "deep").mkdir(parents=True)
    (tmp_path / "b").mkdir()
    (tmp_path / "big").write_bytes(b"x" * 1_000_000)
    (tmp_path / "a" / "link").symlink_to(tmp_path / "big")
    (tmp_path / "a" / "round").symlink_to(tmp_path)
    monkeypatch.setattr(usage, "MOST_BYTES", 100_000)
    assert files_exceeded(folders) == ""
    (tmp_path / "a" / "deep" / "file").write_bytes(b"x" * 60_000)
    (tmp_path / "b" / "file").write_bytes(b"x" * 60_000)
    assert files_exceeded(folders).startswith("The session has ended: your files are")
    monkeypatch.setattr(usage, "MOST_BYTES", 1 << 30)
    monkeypatch.setattr(usage, "MOST_FILES", 4)
    assert files_exceeded(folders) != ""


def test_what_is_nested_too_deep_to_be_counted_is_too_much(tmp_path: Path) -> None:
    here = os.open(tmp_path, os.O_RDONLY)
    try:
        for _ in range(30):
            os.mkdir("x" * 200, dir_fd=here)
            inner = os.open("x" * 200, os.O_RDONLY, dir_fd=here)
            os.close(here)
            here = inner
    finally:
        os.close(here)
    assert "cannot be looked at" in files_exceeded([tmp_path])
    shutil.rmtree(tmp_path)


def test_the_guide_names_the_limits_of_a_student() -> None:
    page = pages()["in-a-browser"].source
    for line in (
        "| apps | 1 |",
        f"| memory of one process | {isolation._MEMORY_BYTES >> 30} GiB |",
        f"| memory of app and programs together | {usage.MOST_MEMORY_BYTES >> 30} GiB |",
        f"| processes, threads | {usage.MOST_PROCESSES}, {usage.MOST_THREADS:,} |",
        f"| files | {isolation.MOST_BYTES >> 30} GiB, {isolation.MOST_FILES:,} files |",
        f"| one file | {isolation.MOST_BYTES >> 30} GiB |",
        f"| open files of a process | {isolation._OPEN_FILES} |",
    ):
        assert line in page
