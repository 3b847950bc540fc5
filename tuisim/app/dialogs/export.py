"""The export dialog: a file name, and which part of the log to write."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tuisim.app import background
from tuisim.app.dialogs.save import FileDialog
from tuisim.logs.export import LISTED

_KINDS = {
    False: "What the program printed: one row a sample",
    True: "Telemetry: one row a tick, every sensor",
}


class ExportDialog(FileDialog):
    """Writes the log of one run to a file.

    Args:
        run_id: The run.
        program: Name of its program, used for the proposed file name.
    """

    TITLE_TEXT: str = "Export the log"
    HINT: str = "Enter writes · ctrl+t samples or telemetry · Escape closes"
    SUFFIXES: ClassVar[str] = LISTED
    BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+t", "switch", "Samples or telemetry", show=False)]

    def __init__(self, run_id: str, program: str) -> None:
        super().__init__(f"{Path(program).stem}.csv")
        self._run_id = run_id
        self._telemetry = False

    def more(self) -> ComposeResult:
        """Return the choice of what to write."""
        yield Static(self._kind(), id="kind")

    def action_switch(self) -> None:
        """Switch between samples and telemetry."""
        self._telemetry = not self._telemetry
        self.query_one("#kind", Static).update(self._kind())

    def _kind(self) -> str:
        return f"[@click=screen.switch]{_KINDS[self._telemetry]}[/]"

    def checked(self, path: Path) -> Path:
        """Raise a TuisimError for a file that no exporter can write."""
        from tuisim.logs.export import check_target

        return check_target(path)

    def write(self, target: Path) -> None:
        """Write the file in the background: it may be large."""
        self.say("Writing …")
        work = partial(_write, self._run_id, target, self._telemetry)
        background.run(self, work, self._written, lambda error: self.failed(str(error)))

    def _written(self, target: Path) -> None:
        self.app.notify(f"The log is in {target}", markup=False)
        self.dismiss(target)


def _write(run_id: str, target: Path, telemetry: bool) -> Path:
    from tuisim.logs.export import export_samples, export_telemetry
    from tuisim.runs.store import RunStore

    run = RunStore().load_run(run_id)
    export_telemetry(run, target) if telemetry else export_samples([run], target)
    return target
