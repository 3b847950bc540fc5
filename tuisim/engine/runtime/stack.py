"""The stack as the program sees it: its frames and those of the library, without those of the runtime.

Affects `traceback`, `inspect` and `faulthandler`.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import types
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any

from tuisim.engine.protocol import COMMAND_SIGNAL, STACK_SIGNAL
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.patches.replacement import replace

_CRASHES = (signal.SIGSEGV, signal.SIGFPE, signal.SIGABRT, signal.SIGBUS, signal.SIGILL)
_OURS = (COMMAND_SIGNAL, STACK_SIGNAL, signal.SIGALRM, signal.SIGVTALRM, signal.SIGINT)
"""Signals that the runtime handles."""
PACKAGE_FOLDER = str(Path(__file__).parents[2]) + os.sep
_BOTTOM = os.path.join(PACKAGE_FOLDER, "engine", "runtime", "__main__.py")
"""File of the outermost frame of the process."""


_shows_whole = False


@contextmanager
def show_whole_stacks() -> Iterator[None]:
    """Return a context in which `traceback` and `inspect` also return the frames of the runtime."""
    global _shows_whole
    _shows_whole = True
    try:
        yield
    finally:
        _shows_whole = False


def _iterate_visible(walk: Iterable[Any], file_of: Callable[[Any], str]) -> Iterator[Any]:
    """Yield those items of a stack whose frames a program may see.

    Frames of tuisim are left out, and so are the frames from which the program was started.

    Args:
        walk: Items that stand for the frames of a stack.
        file_of: Returns the file of an item's frame.
    """
    for item in walk:
        if _shows_whole:
            yield item
            continue
        file = file_of(item)
        if file == _BOTTOM:
            return
        if not file.startswith(PACKAGE_FOLDER):
            yield item


def _walk_frames(frame: types.FrameType | None) -> Iterator[types.FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back


def finish_traceback(module: types.ModuleType) -> None:
    """Patch `traceback` after its import, so that it shows only the frames that a program may see."""
    changed: Any = module

    def walk_stack(f: types.FrameType | None) -> Iterator[tuple[types.FrameType, int]]:
        """Walk a stack yielding the frame and line number for each frame."""
        frames = _walk_frames(sys._getframe(1) if f is None else f)
        for frame in _iterate_visible(frames, lambda frame: frame.f_code.co_filename):
            # If no frame is given, the walk starts at the caller of the function of `traceback`.
            if f is not None or frame.f_code.co_filename != module.__file__:
                yield frame, frame.f_lineno

    changed.walk_stack = wraps(changed.walk_stack)(walk_stack)
    for name in ("walk_tb", "_walk_tb_with_full_positions"):
        setattr(
            changed,
            name,
            _build_filtered(getattr(changed, name), lambda row: row[0].f_code.co_filename),
        )


def finish_inspect(module: types.ModuleType) -> None:
    """Patch `inspect` after its import, so that it shows only the frames that a program may see."""
    changed: Any = module
    for name in ("getouterframes", "getinnerframes"):
        setattr(
            changed,
            name,
            _build_listed(_build_filtered(getattr(changed, name), lambda info: str(info.filename))),
        )


def _build_filtered(
    walk: Callable[..., Iterable[Any]], file_of: Callable[[Any], str]
) -> Callable[..., Iterator[Any]]:
    @wraps(walk)
    def filtered(*args: Any, **kwargs: Any) -> Iterator[Any]:
        return _iterate_visible(walk(*args, **kwargs), file_of)

    return filtered


def _build_listed(walk: Callable[..., Iterator[Any]]) -> Callable[..., list[Any]]:
    @wraps(walk)
    def listed(*args: Any, **kwargs: Any) -> list[Any]:
        return list(walk(*args, **kwargs))

    return listed


def patch_faulthandler() -> None:
    """Patch `faulthandler`, so that a program can enable it without effect: crashes are always written for the host.

    Functions that write the stack after some real time do nothing: time in a run is simulated, and the host has its
    limits.
    """
    on = False

    def switch(wanted: bool) -> bool:
        nonlocal on
        was = on
        on = wanted
        return was

    def enable(file: Any = None, all_threads: bool = True, **_further: Any) -> None:
        switch(True)

    def dump_traceback(file: Any = None, all_threads: bool = True, **_further: Any) -> None:
        _write(_format_stacks(sys._getframe(1), all_threads), sys.stderr if file is None else file)

    replace(faulthandler, "enable", enable)
    replace(faulthandler, "disable", lambda: switch(False), (0, 0))
    replace(faulthandler, "is_enabled", lambda: on, (0, 0))
    replace(faulthandler, "dump_traceback", dump_traceback)
    for name in ("dump_traceback_later", "cancel_dump_traceback_later"):
        replace(faulthandler, name, lambda *_args, **_named: None)
    _patch_registration()


def _patch_registration() -> None:
    """Patch the functions of `faulthandler` that register signals, so that the runtime keeps its own signals."""
    before: dict[int, Any] = {}

    def register(
        signum: int, file: Any = None, all_threads: bool = True, chain: bool = False
    ) -> None:
        if signum in _CRASHES:
            raise RuntimeError(f"signal {signum} cannot be registered, use enable() instead")
        out = sys.stderr if file is None else file

        def handle(number: int, frame: types.FrameType | None) -> None:
            if frame is not None:
                _write(_format_stacks(frame, all_threads), out)
            if chain and callable(previous := before.get(number)):
                previous(number, frame)

        was = None if signum in _OURS else set_signal(signum, handle)
        before.setdefault(signum, was)

    def unregister(signum: int) -> bool:
        if signum not in before:
            return False
        was = before.pop(signum)
        if signum not in _OURS:
            set_signal(signum, was)
        return True

    set_signal = wallclock.set_signal
    replace(faulthandler, "register", register)
    replace(faulthandler, "unregister", unregister, (1, 1))


def _format_stacks(frame: types.FrameType, all_threads: bool) -> str:
    if not all_threads:
        return _format_stack("Stack", frame)
    import threading

    frames, here = sys._current_frames(), threading.current_thread()
    others = [
        thread for thread in threading.enumerate() if thread is not here and thread.ident in frames
    ]
    others_text = [
        _format_stack(f"Thread {thread.name}", frames[thread.ident or 0]) for thread in others
    ]
    return "\n".join([_format_stack(f"Current thread {here.name}", frame), *others_text])


def _format_stack(heading: str, frame: types.FrameType) -> str:
    seen = _iterate_visible(_walk_frames(frame), lambda frame: frame.f_code.co_filename)
    lines = [
        f'  File "{own_frame.f_code.co_filename}", line {own_frame.f_lineno} in {own_frame.f_code.co_name}\n'
        for own_frame in seen
    ]
    return f"{heading} (most recent call first):\n{''.join(lines)}"


def _write(text: str, file: Any) -> None:
    """Write text to a file object or to a descriptor, as the functions of `faulthandler` do."""
    if isinstance(file, int):
        os.write(file, text.encode("utf-8", "backslashreplace"))
    else:
        file.write(text)
        file.flush()
