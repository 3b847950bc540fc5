"""A program that writes to its recording or to the pipes falsifies its own run, and harms nobody else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import PATIENCE_S, Start
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.protocol import End
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

FILES = """
import os, struct
links = ['/proc/self/fd/' + name for name in os.listdir('/proc/self/fd')]
files = {os.readlink(link) for link in links if os.path.exists(link)}
output, telemetry = sorted(file for file in files if file.endswith(('telemetry.bin', 'output.bin')))
folder = os.path.dirname(output)
"""
TO_ALL = """
import os
for fd in range(3, 20000):
    try:
        os.write(fd, {!r})
    except OSError:
        pass
"""
PAUSED = b'{"kind":"paused","tick":0,"time_ns":0,"line":0}\n'
WANTED = b'{"kind":"input_wanted","prompt":"x"}\n'
FINISHED = b'{"kind":"ended","end":"finished","tick":500,"time_ns":5000000000}\n'
TO_PIPES = """
import os, stat
for fd in map(int, os.listdir('/proc/self/fd')):
    try:
        if stat.S_ISFIFO(os.fstat(fd).st_mode):
            os.write(fd, {!r})
    except OSError:
        pass
"""
REPLACED = """
for name in {!r}:
    name = folder + '/' + name
    if os.path.lexists(name):
        os.unlink(name)
    {}
"""
ALL = ("telemetry.bin", "output.bin", "run.json", "actions.jsonl", "stop.json", "modules.jsonl")

FALSIFIES = {
    "all descriptors": TO_ALL.format(b"hello\n"),
    "an event of a paused run": TO_PIPES.format(PAUSED) + "while True: pass",
    "an event of a program that asks": TO_PIPES.format(WANTED) + "sum(range(10**12))",
    "an end of its own": TO_PIPES.format(FINISHED) + "os._exit(0)",
    **{
        f"an end with {name}": TO_PIPES.format(
            b'{"kind":"ended","end":"finished","tick":0,' + more + b"}\n"
        )
        + "import ctypes; ctypes.CDLL(None)._exit(0)"
        for name, more in {
            "a time before the start": b'"time_ns":-1',
            "a line that no file can hold": b'"time_ns":0,"error_line":99999999999999999999',
        }.items()
    },
    "a message without end": TO_PIPES.format(b"x" * 65536) * 200 + "sum(range(10**12))",
    "an empty start": "print(1)\n" + FILES + "open(telemetry, 'r+b').truncate(16)",
    "zeros at the start": "print(1)\n" + FILES + "open(telemetry, 'r+b').write(bytes(64))",
    "another position": FILES
    + "with open(telemetry, 'r+b') as f: f.seek(72); f.write(struct.pack('<d', float('nan')))",
    "a record too many": FILES
    + "with open(telemetry, 'r+b') as f: f.seek(16); f.write(struct.pack('<Q', 5))",
    "endless": FILES
    + """
block = b''.join(struct.pack('<I', tick) + data[4:] for data in [open(telemetry, 'rb').read()[64:128]]
                 for tick in range(100000))
with open(telemetry, 'r+b') as f:
    f.seek(64); f.write(block); f.flush(); f.seek(16); f.write(struct.pack('<Q', 100000))
sum(range(10**12))
""",
    "a row too long": "print('A: 1')\n"
    + FILES
    + "with open(output, 'r+b') as f: f.seek(64); f.write(b'xxxx')",
    "pipes in place of recordings": FILES + REPLACED.format(ALL, "os.mkfifo(name)"),
    "links": FILES + REPLACED.format(ALL, "os.symlink('/dev/zero', name)"),
    "deleted": FILES + REPLACED.format(ALL[:2], "pass"),
}


@cases("text", FALSIFIES)
def test_a_falsified_run_ends_as_falsified(start: Start, text: str) -> None:
    handle = start(text)
    ended = handle.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, str(handle.folder) in ended.summary) == (End.FALSIFIED, False)
    run = handle.stored()
    assert (run.state, run.program.text) == (End.FALSIFIED, handle.program.text)
    assert len(run.telemetry.array()) == run.telemetry.count
    assert len(run.output.read_all_rows()) <= 1


FORGED = (
    FILES
    + """
import json
data = json.load(open(folder + '/run.json'))
data['spec']['world']['start']['x_mm'] = 2000.0
data['program']['text'] = 'print(1)'
json.dump(data, open(folder + '/run.json', 'w'))
"""
)


def test_what_is_stored_of_a_run_is_what_was_started(start: Start) -> None:
    handle = start(FORGED)
    assert handle.wait(PATIENCE_S) is not None
    run = handle.stored()
    assert (run.program.text, run.spec) == (handle.program.text, handle.spec)


def test_a_link_in_place_of_the_run_file_leads_nowhere(start: Start, tmp_path: Path) -> None:
    other = tmp_path / "other.json"
    other.write_text("mine")
    handle = start(
        FILES + f"os.unlink(folder + '/run.json')\nos.symlink({str(other)!r}, folder + '/run.json')"
    )
    assert handle.wait(PATIENCE_S) is not None
    assert other.read_text() == "mine"
    assert json.loads((handle.folder / "run.json").read_text())["end"]["end"] == "finished"


def test_a_folder_in_place_of_the_run_file_is_replaced(start: Start) -> None:
    handle = start(
        FILES + "os.unlink(folder + '/run.json')\nos.makedirs(folder + '/run.json/deep')"
    )
    assert handle.wait(PATIENCE_S) is not None
    assert (handle.unstored, handle.stored().state) == ("", End.FINISHED)


def test_a_live_run_is_falsified_while_it_goes_on(start: Start) -> None:
    text = FILES + "open(telemetry, 'r+b').write(bytes(range(200)))\nwhile True: pass"
    handle = start(text, live=True)
    ended = handle.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, ended.tick) == (End.FALSIFIED, 0)


@pytest.mark.usefixtures("home")
def test_nobody_removes_a_run_before_its_end_is_stored() -> None:
    handle = start_run(
        Program("a.py", "print(1)", "none"), build_run_spec(Settings()), RunOptions()
    )
    store = RunStore()
    # Its process is gone, but what it left has not been looked at.
    handle._process.wait()
    with pytest.raises(LogError, match="is still running"):
        store.remove(handle.run_id)
    while handle.ended is None:
        handle.pump()
    assert handle.ended.end is End.FINISHED
    store.remove(handle.run_id)
