"""Dialogs of the stored runs: to open or compare them, and the differences between two."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app import background, design
from tuisim.app.branch import BRANCH_TAG
from tuisim.app.dialogs.chooser import ListDialog, find_field_view
from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.snapshot import GOOD_ENDS, end_label
from tuisim.base import palette
from tuisim.engine.protocol import End
from tuisim.engine.runs.catalogue import STUDENT_TAG, RunInfo
from tuisim.engine.runs.run_folder import format_end
from tuisim.engine.runs.store import RunStore
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.pixels import Pixels, Rgb
from tuisim.terminal.text_runs import cut

if TYPE_CHECKING:
    from tuisim.engine.runs.diff import RunDiff
    from tuisim.engine.runs.recorded_run import Recording

MAX_LISTED = 300
"""Maximum number of runs in the list; a search finds the others."""


def find_runs(runs: Iterable[RunInfo], search: str) -> list[RunInfo]:
    """Return the runs whose lines in the list contain every word of a search, the newest first.

    If the words are numbers, the runs with these numbers come first.
    """
    words = search.lower().split()
    named = words if "".join(words).isdecimal() else []
    listed = [
        run
        for run in reversed(list(runs))
        if str(run.number) in named or all(word in _collect_search_text(run) for word in words)
    ]
    return sorted(listed, key=lambda run: str(run.number) not in named)


def _collect_search_text(run: RunInfo) -> str:
    facts = (
        run.number,
        run.program,
        run.background,
        run.profile,
        run.end,
        end_label(run.end),
        run.summary,
        run.tags,
    )
    return " ".join(map(str, (*facts, _format_date(run)))).lower()


def _format_date(run: RunInfo) -> str:
    try:
        return datetime.fromisoformat(run.created).astimezone().strftime("%Y-%m-%d %H:%M")
    except ValueError:
        return run.created[:16]


_COLUMNS = {"run": 5, "when": 11, "program": 12, "mat": 10, "end": 10, "s": 6, "samples": 7}
"""Columns of the list of runs with their widths in cells; in a wide terminal, a note follows the last column."""
_MORE_CELLS = {"program": 10, "mat": 5}
"""By how many cells a column of the list is wider if the terminal has at least `_WIDE_COLUMNS` columns."""
_WIDE_COLUMNS = 120
_NUMBERS = ("run", "s", "samples")
"""Columns of the list whose texts are aligned at the right."""
_LEFT_OUT = {
    80: (),
    58: ("mat", "samples"),
    47: ("when", "mat", "samples"),
    0: ("when", "mat", "s", "samples"),
}
"""Columns that the list leaves out in a terminal with at least so many columns; the first fitting key counts."""
_MIN_NOTE_COLUMNS = 100
"""Minimum number of columns of the terminal for which a line of the list ends with a note on the run."""
_OTHER_ROWS = 15
"""Rows of the dialog around its list, including those of the selected run's path."""
_MIN_LIST_ROWS = 5


def _arrange(texts: Mapping[str, str], columns: int) -> dict[str, str]:
    """Return the cells of a row in the list of runs, by column; the columns for which there is no room are left out.

    Args:
        texts: The text of each column.
        columns: Width of the terminal in characters.
    """
    left_out = next(names for from_columns, names in _LEFT_OUT.items() if columns >= from_columns)
    more = _MORE_CELLS if columns >= _WIDE_COLUMNS else {}
    widths = {name: cells + more.get(name, 0) for name, cells in _COLUMNS.items()}
    return {
        name: f"{cut(texts[name], cells):{'>' if name in _NUMBERS else '<'}{cells}}"
        for name, cells in widths.items()
        if name not in left_out
    }


def build_header(columns: int) -> str:
    """Return the line with the headings of the list of runs, for a terminal with this number of columns."""
    names = " ".join(
        _arrange({name: name for name in _COLUMNS} | {"run": "run "}, columns).values()
    )
    return f"{names}  note" if columns >= _MIN_NOTE_COLUMNS else names


def run_line(run: RunInfo, columns: int, *, marked: bool = False) -> Text:
    """Return a run as a line of the list of runs, in the columns of `build_header`.

    In a wide terminal, the line also has the run's tags or, without tags, its failure.

    Args:
        run: The run.
        columns: Width of the terminal in characters.
        marked: Whether the user has marked the run.
    """
    student = run.find_tag(STUDENT_TAG)
    texts = {
        "run": f"{run.number}{'●' if marked else ' '}",
        "when": _format_date(run)[5:],
        "program": f"{student}/{run.program}" if student else run.program,
        "mat": Path(run.background).name,
        "end": end_label(run.end),
        "s": format_end(run.time_s or 0),
        "samples": f"{run.samples or 0:,}",
    }
    styles = {"run": "bold", "when": palette.SOFT, "program": "bold"}
    if run.end not in GOOD_ENDS:
        styles["end"] = design.RED
    line = Text(no_wrap=True, overflow="ellipsis")
    for name, text in _arrange(texts, columns).items():
        line.append(f"{' ' if line else ''}{text}", styles.get(name, ""))
    # The summary of most runs only repeats how they ended, which has its own column.
    if columns >= _MIN_NOTE_COLUMNS and (
        note := run.tags
        or ("" if run.end is End.TIME_LIMIT or run.summary == end_label(run.end) else run.summary)
    ):
        line.append(f"  {note}", palette.SOFT)
    return line


def parse_branch_root(run: RunInfo) -> int | None:
    """Return the number of the run from which a run branched off; None if the run is no branch."""
    number = run.find_tag(BRANCH_TAG)
    return int(number) if number.isdecimal() else None


def find_likeliest(listed: Sequence[RunInfo], this: RunInfo) -> int:
    """Return the index of the run in a list with which the user most likely compares the run `this`.

    The likeliest is the run from which `this` branched off, else the first run of the same program, else the first of
    all.
    """
    root = parse_branch_root(this)
    likely = [index for index, run in enumerate(listed) if run.number == root]
    likely += [index for index, run in enumerate(listed) if run.program == this.program]
    return likely[0] if likely else 0


class RunChooser(ListDialog):
    """The dialog of the stored runs; it returns the id of the chosen one.

    Args:
        compared: The run with which the user wants to compare the chosen one; None if the chosen one is to be opened.
    """

    DEFAULT_CSS = f"""
    RunChooser .heads {{ height: 1; padding-left: 1; text-wrap: nowrap; color: {palette.SOFT}; }}
    RunChooser OptionList {{ text-wrap: nowrap; text-overflow: ellipsis; }}
    RunChooser .way {{ height: 7; margin-top: 1; padding-left: 1; }}
    RunChooser PixelView {{ width: 25; height: 7; margin-right: 2; }}
    RunChooser.-low .way {{ height: 1; margin: 0; }}
    RunChooser.-low PixelView {{ display: none; }}
    """
    TITLE_TEXT: str = "Runs"
    HINT: str = "Enter opens · type to search · Escape closes"

    def __init__(self, compared: Recording | None = None) -> None:
        super().__init__()
        if compared is not None:
            self.TITLE_TEXT = f"Compare {compared.name} with …"
            self.HINT = "Enter compares · type to search · Escape closes"
        self._left_out = compared.run_id if compared else ""
        self._runs: list[RunInfo] = []
        self._looked_at = ""
        """Id of the run whose path is shown below the list."""

    def compose_content(self) -> ComposeResult:
        yield Input(
            placeholder="Search: number, program, mat, end, tag, date",
            compact=True,
            select_on_focus=False,
        )
        yield Static(build_header(self.app.size.width), markup=False, classes="heads")
        yield OptionList()
        with Horizontal(classes="way"):
            yield PixelView()
            yield Static("Loading the list …", id="message", markup=False)

    def on_mount(self) -> None:
        """Read the list of runs in the background, because there may be thousands."""
        super().on_mount()
        self.wait_while(_load_runs, self._fill, lambda error: self.say(str(error)))

    def _fill(self, runs: list[RunInfo]) -> None:
        self._runs = [run for run in runs if run.id != self._left_out]
        self._list("")
        this = next((run for run in runs if run.id == self._left_out), None)
        if this is not None and self._runs:
            listed = find_runs(self._runs, "")[:MAX_LISTED]
            options = self.query_one(OptionList)
            options.highlighted = find_likeliest(listed, this)
            # The list has its height only once it is laid out with the runs.
            options.call_after_refresh(options.scroll_to_highlight)

    def line(self, run: RunInfo) -> Text:
        """Return a run as a line of the list."""
        return run_line(run, self.app.size.width)

    def _list(self, search: str) -> None:
        matches = find_runs(self._runs, search)
        options = self.query_one(OptionList)
        options.clear_options()
        options.add_options(Option(self.line(run), id=run.id) for run in matches[:MAX_LISTED])
        options.highlighted = 0 if matches else None
        if not self._runs:
            self.say("No runs yet: every run of a program is stored here")
        elif len(matches) > MAX_LISTED:
            self.say(f"The newest {MAX_LISTED} of {len(matches):,} runs: search for the others")
        else:
            self.say(f"{len(matches):,} of {len(self._runs):,} runs")

    @on(OptionList.OptionHighlighted)
    def _look(self, event: OptionList.OptionHighlighted) -> None:
        self._looked_at = event.option.id or ""
        self._draw_way()

    def on_resize(self) -> None:
        """Fit the list to the dialog, and draw the robot's path again for its new size; a low dialog has no path."""
        options = self.query_one(OptionList)
        options.styles.max_height = max(_MIN_LIST_ROWS, self.size.height * 9 // 10 - _OTHER_ROWS)
        self.query_one(".heads", Static).update(build_header(self.size.width))
        if self._runs:
            highlighted = options.highlighted
            self._list(self.query_one(Input).value)
            options.highlighted = highlighted
        self.call_after_refresh(self._draw_way)

    def _draw_way(self) -> None:
        """Show the path of the robot in the selected run, as soon as it is drawn."""
        view = self.query_one(PixelView)
        if not view.size or not self._looked_at:
            return
        work = partial(_draw_path, self._looked_at, find_field_view(view), view.ground_rgb)
        show = partial(self._show_way, self._looked_at)
        # A path that cannot be drawn needs no message here: opening the run says what is wrong.
        background.run(self, work, show, lambda _: show(None), group="way", exclusive=True)

    def _show_way(self, run_id: str, picture: Pixels | None) -> None:
        # A dialog that is being closed may have no view any more.
        if not self.is_attached or not self.query(PixelView) or run_id != self._looked_at:
            return
        view = self.query_one(PixelView)
        if picture is None:
            view.clear_picture()
        else:
            view.set_fine_picture(picture, view.graphics)

    @on(Input.Changed)
    def _search(self, event: Input.Changed) -> None:
        self._list(event.value)

    @on(Input.Submitted)
    def _handle_submission(self, event: Input.Submitted) -> None:
        event.stop()
        # Text typed here is not a choice in itself, unlike in other lists.
        event.prevent_default()
        options = self.query_one(OptionList)
        if options.highlighted is not None:
            self.dismiss(options.get_option_at_index(options.highlighted).id)


def _draw_path(run_id: str, port: Viewport, outside_rgb: Rgb) -> Pixels:
    from tuisim.pictures.scene.pictures import draw_path

    return draw_path(RunStore().load_run(run_id), port, outside_rgb)


def _load_runs() -> list[RunInfo]:
    return RunStore().runs()


class RunsChooser(RunChooser):
    """The dialog in which the user chooses one or several stored runs; it returns their ids, separated by blanks."""

    TITLE_TEXT: str = "Open runs"
    BINDINGS: ClassVar[list[BindingType]] = [("space", "mark", "Mark")]

    def __init__(self) -> None:
        super().__init__()
        self._marked: list[str] = []
        """Ids of the runs that the user has marked, in the order in which the user marked them."""

    def on_descendant_focus(self) -> None:
        """Show in the frame the keys that mark runs: while the text field has the focus, they are `↓`, then space."""
        marks = "space" if self._receives_key("space") else "↓, then space"
        self.HINT = f"Enter opens · {marks} marks several · type to search · Escape closes"
        Dialog.on_resize(self)

    def action_move(self, action: str) -> None:
        self.query_one(OptionList).focus()
        super().action_move(action)

    def line(self, run: RunInfo) -> Text:
        """Return a run as a line of the list, with a mark if the user has marked the run."""
        return run_line(run, self.app.size.width, marked=run.id in self._marked)

    def action_mark(self) -> None:
        options = self.query_one(OptionList)
        index = options.highlighted
        run = self._find_run(options.get_option_at_index(index).id) if index is not None else None
        if index is None or run is None:
            return
        self._marked.remove(run.id) if run.id in self._marked else self._marked.append(run.id)
        options.replace_option_prompt_at_index(index, self.line(run))
        options.action_cursor_down()

    def _find_run(self, run_id: str | None) -> RunInfo | None:
        return next((run for run in self._runs if run.id == run_id), None)

    @on(OptionList.OptionSelected)
    def _open_marked(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        event.prevent_default()
        self.dismiss(" ".join(self._marked or [event.option.id or ""]))

    @on(Input.Submitted)
    def _open_named(self, event: Input.Submitted) -> None:
        """Close the dialog, and return the marked runs.

        If the user has typed several numbers of runs, such as `12 13`, return the runs with these numbers instead. Any
        other typed text searches the list.
        """
        numbers = {str(run.number): run.id for run in self._runs}
        words = event.value.split()
        named = [numbers[word] for word in words if word in numbers]
        run_ids = self._marked or (named if len(named) == len(words) > 1 else [])
        if run_ids:
            event.stop()
            event.prevent_default()
            self.dismiss(" ".join(run_ids))


class Differences(Dialog[bool]):
    """The dialog with the differences of two runs; it returns True if the user wants to go to the first difference.

    Args:
        first: Name of the first run.
        second: Name of the second run.
        diff: The differences.
        samples: Whether the user may also go to the first sample that differs, if no tick differs.
    """

    # The binding has no word, since the footer takes the word for Enter from the hint in the frame. The hint names
    # Enter only if there is a difference to go to.
    BINDINGS: ClassVar[list[BindingType]] = [("enter", "go")]

    def __init__(self, first: str, second: str, diff: RunDiff, *, samples: bool = False) -> None:
        super().__init__()
        self.TITLE_TEXT = f"{first} and {second}"
        self._goes = diff.tick is not None or (samples and diff.sample is not None)
        self.HINT = (
            "Escape closes"
            if not self._goes
            else "Enter goes to the first difference · Escape closes"
        )
        self._diff = diff

    def compose_content(self) -> ComposeResult:

        table = Table.grid(padding=(0, 2))
        table.add_column(style="bold")
        table.add_column()
        rows = [*self._diff.describe_recording(), *self._diff.describe_setup()]
        for name, what in rows:
            if name:
                table.add_row(Text(name), Text(what))
        with VerticalScroll():
            yield Static(table)
            # The lines of the programs are below the table, where they have the whole width.
            if lines := [what for name, what in rows if not name]:
                yield Static(Text("\n".join(["", *lines])))

    def action_go(self) -> None:
        self.dismiss(self._goes)
