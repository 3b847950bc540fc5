"""The stack as the program sees it: its frames and those of the library, without those of the runtime.

Affects `traceback`, `inspect` and `faulthandler`.
"""

from __future__ import annotations

import faulthandler
import os
import sys
import types
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, NoReturn

from tuisim.base.errors import NotSimulated
from tuisim.engine.runtime.patches.replacement import replace

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
    limits. Those that write it now, or at a signal, would show frames of the runtime: they are refused.
    """
    on = False

    def switch(wanted: bool) -> bool:
        nonlocal on
        was = on
        on = wanted
        return was

    def enable(*_args: object, **_named: object) -> None:
        switch(True)

    replace(faulthandler, "enable", enable)
    replace(faulthandler, "disable", lambda: switch(False), (0, 0))
    replace(faulthandler, "is_enabled", lambda: on, (0, 0))
    for name in ("dump_traceback_later", "cancel_dump_traceback_later"):
        replace(faulthandler, name, lambda *_args, **_named: None)
    for name in ("dump_traceback", "register", "unregister"):
        replace(faulthandler, name, _build_refusal(name))


def _build_refusal(name: str) -> Callable[..., NoReturn]:
    def refuse(*_args: object, **_named: object) -> NoReturn:
        raise NotSimulated(
            f"faulthandler.{name} is not part of the simulated brick", "use traceback.print_stack"
        )

    return refuse
