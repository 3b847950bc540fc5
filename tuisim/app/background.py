"""Background work: a function that runs in a thread, and its result or its error back in the app's thread."""

from __future__ import annotations

import asyncio
import gc
import os
import sys
import time
from collections.abc import Callable, Coroutine
from contextlib import suppress
from contextvars import copy_context
from functools import partial
from threading import Thread
from typing import Any, ParamSpec, TypeVar

from textual.app import App
from textual.dom import DOMNode
from textual.worker import get_current_worker

from tuisim.base.atomic import drop_unfinished, unfinished
from tuisim.base.errors import TuisimError
from tuisim.base.memory import return_freed_blocks
from tuisim.terminal.textual_internals import is_leaving

Made = TypeVar("Made")
Given = ParamSpec("Given")

FINISHES_WITHIN_S = 1.0
"""Maximum number of seconds that the app, when the user quits, waits for files that are being written."""
COLLECT_EVERY = 50_000
"""After so many new objects, the garbage collector looks for cycles; that takes less time than a frame."""
_LOOK_S = 0.02
_threads: list[Thread] = []


def run(
    node: DOMNode,
    work: Callable[[], Made],
    then: Callable[[Made], None],
    failed: Callable[[TuisimError], None] | None = None,
    *,
    group: str = "default",
    exclusive: bool = False,
) -> None:
    """Run a function in a thread, and pass its result to `then`. This does not block.

    The function always runs to its end. If the node is removed meanwhile, or other work replaces this work, `then` is
    still called, but `failed` is not. While the app shuts down, `then` is not called either.

    Args:
        node: The app, screen or widget that the work belongs to.
        work: Called in the thread. It may read `textual.worker.get_current_worker().is_cancelled`.
        then: Called with the result, in the app's thread.
        failed: Called with a TuisimError that `work` has raised, in the app's thread. None if it raises none.
        group: Name of the group of the work.
        exclusive: Cancel other work of the group.
    """
    thread = partial(_run_in_worker, node.app, work, then, failed)
    begin(node, partial(_run_and_wait, thread), group=group, exclusive=exclusive)


def begin(
    node: DOMNode,
    work: Callable[[], Coroutine[Any, Any, None]],
    *,
    group: str = "default",
    exclusive: bool = False,
) -> None:
    """Run a coroutine function in the app's event loop until it ends or its node is removed. This does not block.

    Args:
        node: The app, screen or widget that the work belongs to.
        work: The function.
        group: Name of the group of the work.
        exclusive: Cancel other work of the group.
    """
    # The function itself is passed: a node that is being removed would never await its coroutine.
    called_later: Any = work
    node.run_worker(called_later, group=group, exclusive=exclusive)


async def _run_and_wait(work: Callable[[], None]) -> None:
    """Call a function in a thread of its own, and wait until it returns.

    The threads of asyncio are not used: they would keep the process of a closed app alive until the function returns.
    """
    loop = asyncio.get_running_loop()
    done: asyncio.Future[None] = loop.create_future()

    def settle(error: BaseException | None) -> None:
        if done.cancelled():
            return
        if error is None:
            done.set_result(None)
        else:
            done.set_exception(error)

    def run_work() -> None:
        problem: BaseException | None = None
        try:
            work()
        # Every error is passed on, and raised again where the work is awaited.
        except BaseException as error:
            problem = error
        # If the app was left meanwhile, its loop is closed, and nobody waits for the result.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(settle, problem)

    # The copied context lets the thread find its worker.
    start(partial(copy_context().run, run_work))
    await done


def start(work: Callable[[], object]) -> None:
    """Run a function in a thread, and ignore what it returns. This does not block."""
    _threads[:] = [thread for thread in _threads if thread.is_alive()]
    _threads.append(Thread(target=work, daemon=True))
    _threads[-1].start()


def enter() -> None:
    """Prepare Python's garbage collection for an app.

    Objects that exist now are never collected, and collections are rare. Large freed blocks are given back to the
    system; see `return_freed_blocks`.
    """
    gc.freeze()
    gc.set_threshold(COLLECT_EVERY)
    return_freed_blocks()


def leave(code: int) -> int:
    """Give the threads of a closed app a moment to write their files, and return the exit code `code`.

    If threads are still at work after this, end the process here with that code. Before that, list on stderr the files
    that were not written.
    """
    give_up = time.monotonic() + FINISHES_WITHIN_S
    while any(thread.is_alive() for thread in _threads):
        if not unfinished() or time.monotonic() > give_up:
            for path in drop_unfinished():
                print(
                    f"tuisim: {path} was not written: the app ended before the file was complete",
                    file=sys.stderr,
                )
            for stream in (sys.stdout, sys.stderr):
                with suppress(OSError, ValueError):
                    stream.flush()
            # A normal exit would wait for the threads, which may hold a lock of a library.
            os._exit(code)
        time.sleep(_LOOK_S)
    return code


def _run_in_worker(
    app: App[Any],
    work: Callable[[], Made],
    then: Callable[[Made], None],
    failed: Callable[[TuisimError], None] | None,
) -> None:
    try:
        result = work()
    except TuisimError as error:
        if failed is None:
            raise
        if not get_current_worker().is_cancelled:
            call(app, failed, error)
        return
    call(app, then, result)


def call(
    app: App[Any], function: Callable[Given, None], *args: Given.args, **kwargs: Given.kwargs
) -> None:
    """Call a function in the app's thread, from another thread, and wait until it returns.

    While the app shuts down, the function is not called.
    """
    if not is_leaving(app):
        app.call_from_thread(function, *args, **kwargs)
