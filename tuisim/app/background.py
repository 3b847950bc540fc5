"""Background work: a function that runs in a thread, and its result or its error back in the app's thread."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, ParamSpec, TypeVar

from textual.app import App
from textual.dom import DOMNode
from textual.worker import get_current_worker

from tuisim.errors import TuisimError

Made = TypeVar("Made")
Given = ParamSpec("Given")


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app is shutting down: nothing may be opened any more, for it could not be drawn."""
    # Textual has no public API for it.
    return app._exit


def run(
    node: DOMNode,
    work: Callable[[], Made],
    then: Callable[[Made], None],
    failed: Callable[[TuisimError], None] | None = None,
    *,
    group: str = "default",
    exclusive: bool = False,
) -> None:
    """Run a function in a thread, and pass on what it returns. Does not block.

    Cancelled work, whose node is gone or which other work has replaced, goes on in its thread: it still passes on its
    result, but no error. Nothing is passed on while the app shuts down.

    Args:
        node: The app, screen or widget that the work belongs to.
        work: Called in the thread. It may read `textual.worker.get_current_worker().is_cancelled`.
        then: Called with the result, in the app's thread.
        failed: Called with a TuisimError that `work` has raised, in the app's thread. None if it raises none.
        group: Name of the group of the work.
        exclusive: Cancel other work of the group.
    """
    thread = partial(_in_thread, node.app, work, then, failed)
    node.run_worker(thread, thread=True, group=group, exclusive=exclusive)


def _in_thread(
    app: App[Any],
    work: Callable[[], Made],
    then: Callable[[Made], None],
    failed: Callable[[TuisimError], None] | None,
) -> None:
    try:
        made = work()
    except TuisimError as error:
        if failed is None:
            raise
        if not get_current_worker().is_cancelled:
            call(app, failed, error)
        return
    call(app, then, made)


def call(app: App[Any], function: Callable[Given, None], *args: Given.args, **kwargs: Given.kwargs) -> None:
    """Call a function in the app's thread, from a thread; without effect while the app shuts down.

    Blocks until the function has returned.
    """
    if not is_leaving(app):
        app.call_from_thread(function, *args, **kwargs)
