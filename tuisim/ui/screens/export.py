"""The export dialog: a file name, what goes in, and whether an old file may be replaced."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Input, Static

from tuisim.errors import TuisimError
from tuisim.ui.screens.dialog import Dialog

SUFFIXES = ".csv, .parquet, .jsonl or .arrow"
_KINDS = {
    False: "What the program printed: one row a sample",
    True: "Telemetry: one row a tick, every sensor",
}


class ExportDialog(Dialog[None]):
    """Writes the log of one run to a file.

    Args:
        run_id: The run.
        program: Name of its program, from which the name of the file is proposed.
    """

    TITLE_TEXT: ClassVar[str] = "Export the log"
    HINT: ClassVar[str] = "Enter writes · ctrl+t samples or telemetry · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+t", "switch", "Samples or telemetry", show=False)]

    def __init__(self, run_id: str, program: str) -> None:
        super().__init__()
        self._run_id = run_id
        self._proposed = f"{Path(program).stem}.csv"
        self._telemetry = False
        self._agreed = ""
        """The target that the user has agreed to replace."""
        self._writing = False

    def content(self) -> ComposeResult:
        """The field, what goes in, and a line for what is wrong."""
        yield Static(f"File ({SUFFIXES})", markup=False)
        yield Input(self._proposed, compact=True, select_on_focus=False)
        yield Static(id="kind")
        yield Static(id="message", markup=False)

    def on_mount(self) -> None:
        """Show what goes in."""
        self._show_kind()

    def action_switch(self) -> None:
        """Samples or telemetry."""
        self._telemetry = not self._telemetry
        self._show_kind()

    def _show_kind(self) -> None:
        self.query_one("#kind", Static).update(f"[@click=screen.switch]{_KINDS[self._telemetry]}[/]")

    @on(Input.Changed)
    def _changed(self) -> None:
        self._agreed = ""
        self._say("")

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        from tuisim.datalog.export import check_target

        if self._writing:
            return
        typed = event.value.strip()
        try:
            target = check_target(Path(typed).expanduser()) if typed else None
        except TuisimError as error:
            self._say(str(error), wrong=True)
            return
        if target is None:
            self._say(f"Type the name of a file that ends in {SUFFIXES}", wrong=True)
            return
        if target.exists() and self._agreed != typed:
            self._agreed = typed
            self._say(f"{target.name} is there already. Enter once more replaces it.", wrong=True)
            return
        self._writing = True
        self._say("Writing …")
        self.run_worker(partial(self._write, target, self._telemetry), thread=True)

    def _write(self, target: Path, telemetry: bool) -> None:
        from tuisim.datalog.export import export_samples, export_telemetry
        from tuisim.datalog.store import RunStore

        try:
            run = RunStore().load_run(self._run_id)
            export_telemetry(run, target) if telemetry else export_samples([run], target)
        except TuisimError as error:
            self.app.call_from_thread(self._failed, str(error))
            return
        self.app.call_from_thread(self._written, target)

    def _failed(self, text: str) -> None:
        self._writing = False
        self._say(text, wrong=True)

    def _written(self, target: Path) -> None:
        self.app.notify(f"The log is in {target}", markup=False)
        self.dismiss(None)

    def _say(self, text: str, wrong: bool = False) -> None:
        message = self.query_one("#message", Static)
        message.update(text)
        message.set_class(wrong, "wrong")
