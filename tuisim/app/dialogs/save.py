"""Dialogs that write a file: its name, and whether an existing one may be replaced."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import Input, Static

from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.dialogs.question import Form, build_form_table
from tuisim.base.errors import ConfigError, TuisimError, counted, shortened
from tuisim.base.folders import user_path
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import (
    LISTED,
    check_target,
    describe_files,
    export_samples,
    export_telemetry,
)
from tuisim.terminal.app import offer


def parse_path(text: str) -> Path:
    """Return the path that was typed, with `~` expanded; the file need not exist.

    Raises:
        ConfigError: the name is impossible, for example too long.
    """
    path = user_path(text)
    why = ""
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        why = "there is no such user" if text.startswith("~") and path == Path(text) else ""
    except (OSError, ValueError) as error:
        why = (error.strerror if isinstance(error, OSError) else "") or str(error)
    if why:
        raise ConfigError(f"{shortened(text, 20)!r} cannot be the name of a file: {why}")
    return path


class FileDialog(Dialog[Path]):
    """The dialog with a field for a file name; it writes the file, and returns its path.

    Args:
        proposed: Initial text of the field.
    """

    HINT: str = "Enter writes · Escape closes"
    SUFFIXES: str = ".toml"

    def __init__(self, proposed: str) -> None:
        super().__init__()
        self._proposed = proposed
        self._agreed = ""
        """The typed path of an existing file that the next Enter replaces, as the dialog has told; empty for none."""
        self._writing = False

    def compose_content(self) -> ComposeResult:
        yield Static(f"File ({self.SUFFIXES})", markup=False)
        yield Input(self._proposed, compact=True)
        yield from self.compose_extras()
        yield Static(id="message", markup=False)

    def compose_extras(self) -> ComposeResult:
        """Return the widgets between the field and the message; the base class has none."""
        yield from ()

    def resolve_target(self, path: Path) -> Path:
        """Return the path of the file to write for a path that the user has typed.

        Raises:
            TuisimError: the file cannot be written.
        """
        return path

    def write(self, target: Path) -> None:
        """Write the file; then close the dialog, or call `report_failure`.

        Raises:
            TuisimError: the file cannot be written.
        """

    @on(Input.Changed)
    def _forget_agreement(self) -> None:
        self._agreed = ""
        self.say("")

    @on(Input.Submitted)
    def _submit(self, event: Input.Submitted) -> None:
        if self._writing:
            return
        typed = event.value.strip()
        if not typed:
            self.say(f"Type the name of a file that ends in {self.SUFFIXES}", wrong=True)
            return
        try:
            target = self.resolve_target(parse_path(typed))
            if os.path.exists(target) and self._agreed != typed:
                self._agreed = typed
                self.say(
                    f"{target.name} already exists. Press Enter again to replace it.", wrong=True
                )
                return
            self._writing = True
            self.write(target)
        except TuisimError as error:
            self.report_failure(str(error))

    def report_failure(self, text: str) -> None:
        """Show why the file was not written."""
        self._writing = False
        self.say(text, wrong=True)


def _check_no_folder(path: Path) -> None:
    if os.path.isdir(path):
        raise TuisimError(f"{path} is a folder, not a file")


class SaveDialog(FileDialog):
    """The dialog that asks where to save something, and saves it.

    Args:
        what: The subject, such as `robot`.
        proposed: Initial text of the field.
        save: Writes the file completely or not at all, or starts to write it in the background; raises TuisimError.
        suffixes: What the name may end in, in words; empty for the `SUFFIXES` of the class.
        check: Raises a TuisimError for a file that cannot be written.
        forms: Suffixes, and what they mean.
        notice: Whether to show a notice that the file is written.
    """

    def __init__(
        self,
        what: str,
        proposed: str,
        save: Callable[[Path], None],
        suffixes: str = "",
        check: Callable[[Path], object] = _check_no_folder,
        forms: Sequence[Form] = (),
        notice: bool = True,
    ) -> None:
        super().__init__(proposed)
        self._what = what
        self._save = save
        self._check = check
        self._forms = forms
        self._notice = notice
        self.SUFFIXES = suffixes or self.SUFFIXES
        self.TITLE_TEXT = f"Save the {what}"

    def resolve_target(self, path: Path) -> Path:
        """Check that a file with the typed path can be written, and return the path unchanged.

        Raises:
            TuisimError: the file cannot be written.
        """
        self._check(path)
        return path

    def compose_extras(self) -> ComposeResult:
        """Return the widgets that explain the suffixes."""
        if self._forms:
            yield build_form_table(self._forms)

    def write(self, target: Path) -> None:
        """Write the file, show a notice, and close the dialog."""
        self._save(target)
        if self._notice:
            self.app.notify(f"{self._what.capitalize()} saved to {target}")
        self.dismiss(target)


class ProgramDialog(SaveDialog):
    """The dialog that asks where to save a program, and saves it."""

    SUFFIXES: str = ".py"


_KINDS = {
    False: "Samples: what the program printed, one row each",
    True: "Telemetry: every sensor, one row per tick",
}


class ExportDialog(FileDialog):
    """The dialog that asks for a file, and writes the log of a stored run to it.

    Args:
        run_id: The run.
        program: Name of its program, used for the proposed file name.
    """

    TITLE_TEXT: str = "Export the log"
    HINT: str = "Enter writes · ctrl+t switches · Escape closes"
    SUFFIXES: str = LISTED
    BINDINGS: ClassVar[list[BindingType]] = [("ctrl+t", "switch", "Samples or telemetry")]

    def __init__(self, run_id: str, program: str) -> None:
        super().__init__(f"{Path(program).stem}.csv")
        self._run_id = run_id
        self._telemetry = False

    def compose_extras(self) -> ComposeResult:
        """Return the widgets to choose between samples and telemetry."""
        yield Static(self._describe_kind(), id="kind")

    def action_switch(self) -> None:
        self._telemetry = not self._telemetry
        self.query_one("#kind", Static).update(self._describe_kind())

    def _describe_kind(self) -> str:
        return f"[@click=screen.switch]{_KINDS[self._telemetry]}[/]"

    def resolve_target(self, path: Path) -> Path:
        """Return the path of the file to write for a typed path.

        Raises:
            TuisimError: no exporter can write such a file.
        """
        return check_target(path)

    def write(self, target: Path) -> None:
        """Write the file in the background, because it may be large."""
        self.say("Writing …")
        work = partial(_write_log, self._run_id, target, self._telemetry)
        report = partial(self._report_written, target)
        self.wait_while(work, report, lambda error: self.report_failure(str(error)))

    def _report_written(self, target: Path, rows: int) -> None:
        self.app.notify(f"{counted(rows, 'row')} saved to {describe_files(target)}")
        offer(self.app, target)
        self.dismiss(target)


def _write_log(run_id: str, target: Path, telemetry: bool) -> int:
    run = RunStore().load_run(run_id)
    return export_telemetry(run, target) if telemetry else export_samples([run], target)
