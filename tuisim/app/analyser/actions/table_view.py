"""Functions behind the keys of the table: columns, sorting, filters, search, and copying."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from tuisim.analysis.table import TableTask, TableView, conditions_of
from tuisim.app.analyser.background import work
from tuisim.app.analyser.panes import PANES
from tuisim.app.analyser.prompt import LinePrompt
from tuisim.app.dialogs.save import typed_path
from tuisim.core.comparison import spelled
from tuisim.errors import LogError, counted

if TYPE_CHECKING:
    from tuisim.analysis.model import Model
    from tuisim.app.analyser.screen import Analyser

MOST_COPIED = 10_000
"""Most rows to copy: terminals drop longer texts."""

_FILES = (("rows.csv", "text"), (".parquet .arrow .jsonl", "the same with all types and what the log says of its runs"))
_FILTERS = (
    ("value > 50", f"the rows in which that holds; {spelled()}"),
    ("variable ~ col", "those with that in their text"),
    ("value > 50 and time < 3", "those in which all holds"),
    ("(nothing)", "all rows"),
)


def choose(screen: Analyser, step: int) -> None:
    """Select another column."""
    if screen.model is not None:
        screen.model.rows.choose(step)
        screen.update()


def sort(screen: Analyser) -> None:
    """Sort by the selected column: ascending, descending, not at all."""
    if screen.model is None:
        return
    model, rows = screen.model, screen.model.rows
    if rows.sorted_by != rows.chosen:
        wanted = rows.chosen, False
    else:
        wanted = ("", False) if rows.descending else (rows.chosen, True)
    work(screen, "sorting …", len(rows), lambda _: rows.sorted(*wanted), partial(_arrange, screen, model))


def _arrange(screen: Analyser, model: Model, arrangement: TableView) -> None:
    """Show filtered and sorted rows, the cursor among them."""
    if screen.model is not model:
        return
    rows = model.rows
    rows.arrange(arrangement)
    if rows.conditions and len(rows):
        model.go_to_row(rows.row(rows.place(model.row)))
    screen.update()


def ask_filter(screen: Analyser) -> None:
    """Ask for a filter."""
    model = screen.model
    if model is None:
        return

    def keep(text: str) -> None:
        model = screen.at_hand()
        conditions = tuple(conditions_of(text, model.log.table.column_names)) if text else ()
        rows = model.rows
        work(
            screen, "filtering …", model.log.rows, lambda _: rows.filtered(conditions), partial(_arrange, screen, model)
        )

    now = " and ".join(map(str, model.rows.conditions))
    screen.app.push_screen(LinePrompt("Filter", keep, now, _FILTERS))


def show_all(screen: Analyser) -> None:
    """Show every row and every column, in the order of the log."""
    if screen.model is not None:
        screen.give_up()
        screen.model.rows.sort("", False)
        screen.model.rows.filter(())
        screen.model.rows.show_all()
        screen.update()


def ask_search(screen: Analyser) -> None:
    """Ask for a search text."""

    def go(text: str) -> None:
        screen.searched = text
        if text:
            _find(screen, 1)

    if screen.model is not None:
        screen.app.push_screen(LinePrompt("Search", go, screen.searched))


def find(screen: Analyser, step: int) -> None:
    """Go to the next or previous match."""
    if not screen.searched:
        ask_search(screen)
    else:
        try:
            _find(screen, step)
        except LogError as error:
            screen.complain(error)


def _find(screen: Analyser, step: int) -> None:
    """Go to the next or previous match; may search in the background.

    Raises:
        LogError: there is no match, if that is known at once.
    """
    model, text = screen.model, screen.searched
    if model is None:
        return
    rows = model.rows
    here = rows.place(model.row)

    def search(task: TableTask) -> int:
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

    work(screen, "searching …", len(rows), search, found)


def hide(screen: Analyser) -> None:
    """Hide the selected column."""
    if screen.model is not None:
        screen.model.rows.hide()
        screen.update()


def freeze(screen: Analyser) -> None:
    """Freeze the selected column at the left, or release it."""
    if screen.model is not None:
        screen.model.rows.freeze()
        screen.update()


def ask_export(screen: Analyser) -> None:
    """Ask for the file to export the rows of the pane to; of the table, only the columns shown."""
    pane = screen.pane.name_shown
    if screen.model is None or (pane != "table" and not PANES[pane].rows(screen.model)):
        screen.say("There are no rows here to export: t shows the table")
        return
    what = "rows" if pane == "table" else pane

    def go(text: str) -> None:
        if not text:
            raise LogError("which file?", f"such as {what}.csv")
        screen.export(typed_path(text), pane)

    screen.app.push_screen(LinePrompt(f"Export the {what} as shown", go, f"{what}.csv", _FILES))


def copy_value(screen: Analyser) -> None:
    """Copy the selected cell."""
    if screen.model is not None and screen.model.log.rows:
        rows = screen.model.rows
        screen.copy(rows.text(screen.model.row, rows.chosen), f"{rows.chosen} of row {screen.model.row + 1}")


def copy_row(screen: Analyser) -> None:
    """Copy the row of the cursor, with tabs between the cells."""
    if screen.model is not None and screen.model.log.rows:
        rows, row = screen.model.rows, screen.model.row
        screen.copy("\t".join(rows.text(row, column) for column in rows.columns), f"row {row + 1}")


def copy_pane(screen: Analyser) -> None:
    """Copy the pane: of the table all rows shown, with the header."""
    model, name = screen.model, screen.pane.name_shown
    if model is None or not model.log.rows:
        return
    if name != "table":
        pane = PANES[name]
        lines = ["\t".join(row) for row in (pane.heads, *pane.rows(model))]
        screen.copy("\n".join([*lines, *pane.below(model)]), pane.title.lower())
        return
    rows = model.rows
    if len(rows) > MOST_COPIED:
        screen.say(f"{len(rows):,} rows are too many for a clipboard: F filters, `tuisim log export` writes a file")
        return
    places = (rows.row(place) for place in range(len(rows)))
    lines = ["\t".join(rows.text(row, column) for column in rows.columns) for row in places]
    screen.copy("\n".join(["\t".join(rows.columns), *lines]), counted(len(rows), "row"))
