"""Work of the analyser that would hold up the keys: in a thread where there are many rows, else at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from tuisim.errors import TuisimError
from tuisim.ui.analyser.task import AT_ONCE, Task

if TYPE_CHECKING:
    from tuisim.ui.analyser.screen import Analyser

Made = TypeVar("Made")


def work(screen: Analyser, word: str, rows: int, do: Callable[[Task], Made], then: Callable[[Made], None]) -> None:
    """Do something, and then something with its result; newer work takes the place of older.

    Args:
        screen: Shows the word meanwhile.
        word: What is being done.
        rows: How many it is done with.
        do: The work; it reads the log, and changes nothing.
        then: What is done with the result, on the screen.

    Raises:
        TuisimError: what `do` raises if it is done at once; else it is told on the screen.
    """
    if rows <= AT_ONCE:
        then(do(Task(word)))
        return
    task = Task(word)
    screen.begin(task)
    screen.run_worker(partial(_aside, screen, task, do, then), thread=True, group="work")


def _aside(screen: Analyser, task: Task, do: Callable[[Task], Made], then: Callable[[Made], None]) -> None:
    try:
        made = do(task)
    except TuisimError as error:
        screen.app.call_from_thread(screen.end, task, partial(screen.complain, error))
    else:
        screen.app.call_from_thread(screen.end, task, partial(then, made))
