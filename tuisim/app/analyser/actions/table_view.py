"""Keys of the group Table: columns, sorting, filters and search."""

from __future__ import annotations

from functools import partial

from tuisim.analysis.model import Model
from tuisim.analysis.table import TableTask, TableView, conditions_of
from tuisim.app.analyser.screen import LogScreen
from tuisim.core.comparison import spelled
from tuisim.errors import LogError

_FILTERS = (
    ("value > 50", f"the rows for which that is true; {spelled()}"),
    ("variable ~ col", "the rows whose text contains col"),
    ("value > 50 and time < 3", "the rows for which both are true"),
    ("(nothing)", "all rows"),
)


def choose(screen: LogScreen, step: int) -> None:
    """Select another column."""
    screen.model.rows.choose(step)
    screen.update()


def sort(screen: LogScreen) -> None:
    """Sort by the selected column: ascending, descending, not at all."""
    model, rows = screen.model, screen.model.rows
    if rows.sorted_by != rows.chosen:
        order = rows.chosen, False
    else:
        order = ("", False) if rows.descending else (rows.chosen, True)
    screen.work("sorting …", len(rows), lambda _: rows.sorted(*order), partial(_arrange, screen, model))


def _arrange(screen: LogScreen, model: Model, arrangement: TableView) -> None:
    """Show filtered and sorted rows, the cursor among them."""
    if screen.model is not model:
        return
    rows = model.rows
    rows.arrange(arrangement)
    if rows.conditions and len(rows):
        model.go_to_row(rows.row(rows.place(model.row)))
    screen.update()


def select(screen: LogScreen) -> None:
    """Ask for a filter."""

    def keep(text: str) -> None:
        model = screen.model
        conditions = tuple(conditions_of(text, model.log.table.column_names)) if text else ()
        then = partial(_arrange, screen, model)
        screen.work("filtering …", model.log.rows, lambda _: model.rows.filtered(conditions), then)

    screen.ask("Filter", keep, " and ".join(map(str, screen.model.rows.conditions)), _FILTERS)


def show_all(screen: LogScreen) -> None:
    """Show every row and every column, in the order of the log."""
    screen.give_up()
    rows = screen.model.rows
    rows.sort("", False)
    rows.filter(())
    rows.show_all()
    screen.update()


def search(screen: LogScreen) -> None:
    """Ask for a search text."""

    def go(text: str) -> None:
        screen.searched = text
        if text:
            find(screen, 1)

    screen.ask("Search", go, screen.searched)


def find(screen: LogScreen, step: int) -> None:
    """Go to the next or previous match; may search in the background.

    Raises:
        LogError: there is no match, if that is known at once.
    """
    model, text = screen.model, screen.searched
    if not text:
        search(screen)
        return
    rows = model.rows
    here = rows.place(model.row)

    def match(task: TableTask) -> int:
        place = rows.find(text, here, step, task)
        if place is None:
            raise LogError(f"{text!r} was not found", "in the rows and columns that are shown")
        return place

    def found(place: int) -> None:
        if screen.model is model:
            screen.pane.turn_to("table")
            model.go_to_row(rows.row(place))
            model.follow_cursor()
            screen.update()

    screen.work("searching …", len(rows), match, found)


def hide(screen: LogScreen) -> None:
    """Hide the selected column."""
    screen.model.rows.hide()
    screen.update()


def freeze(screen: LogScreen) -> None:
    """Freeze the selected column at the left, or release it."""
    screen.model.rows.freeze()
    screen.update()
