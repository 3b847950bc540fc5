"""Slow-downs that tests plant in what is measured, to see that the figures get worse."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

from tests.bench import processes
from tuisim.engine.runs.child import process

SLOW = """
import sys, threading

def burn(frame, event, arg, turns=range({turns})):
    for _ in turns:
        pass

sys.setprofile(burn)
threading.setprofile(burn)
"""
"""Makes every call and every return of a process cost so many turns of a loop."""
NOISY = """
from tuisim.engine.core import noise
moved = noise._compute_shift

def burn(values, level):
    for _ in range({turns}):
        pass
    return moved(values, level)

noise._compute_shift = burn
"""
"""Makes every channel of a noisy reading cost so many turns of a loop."""
FOLLOWING = """
from tuisim.engine.core.servo.control import Controller
milli = Controller.milli

def burn(control, now_us):
    for _ in range({turns}):
        pass
    return milli(control, now_us)

Controller.milli = burn
"""
"""Makes every look at a trajectory cost so many turns of a loop."""
ANSWERS = """
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.channel import Channel
send = Channel.send

def burn(channel, event):
    for _ in range({turns}):
        pass
    send(channel, event)

Channel.send = burn
"""
"""Makes every event of a run cost so many turns of a loop; a debugger works where calls are not noticed."""
DRAWN = """
from tuisim.terminal.frame_buffer import FrameBuffer
codes = FrameBuffer.codes

def burn(*words):
    for _ in range({turns}):
        pass
    return (codes(*words) or "") + {more!r}

FrameBuffer.codes = burn
"""
"""Makes everything that the app draws cost so many turns of a loop and so many bytes more."""
LARGE = "ballast = bytearray({megabytes} << 20)\n"
"""Makes a process so much larger."""
WALKS = """
from tuisim.terminal.frame_buffer import FrameBuffer
codes = FrameBuffer.codes

def function_of(module):
    names = dict(__name__=module)
    exec("def walk(): pass", names)
    return names["walk"]

walks = [function_of(f"tuisim.planted{{number}}") for number in range({modules})]

def walk(*words):
    for _ in range({times}):
        for function in walks:
            function()
    return codes(*words)

FrameBuffer.codes = walk
"""
"""Makes the app walk so often through so many modules more for everything that it draws."""


@contextmanager
def in_runs(code: str) -> Iterator[None]:
    """Plant code in the processes of runs that this process starts."""
    process.end_warm_process()
    start = "runpy.run_module"
    with patch.object(process, "BOOT", process.BOOT.replace(start, f"exec({code!r}); {start}")):
        yield
        process.end_warm_process()


@contextmanager
def in_commands(code: str) -> Iterator[None]:
    """Plant code in the commands and apps that are started."""
    with TemporaryDirectory() as folder:
        Path(folder, "sitecustomize.py").write_text(code)
        with patch.object(processes, "SEARCH_PATH", [folder, *processes.SEARCH_PATH]):
            yield
