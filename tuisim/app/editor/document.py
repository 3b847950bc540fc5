"""The text of the open program: as saved, as edited, and as it runs."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app.editor.text_file import (
    Draft,
    TextFormat,
    drop_draft,
    find_draft,
    is_example,
    is_protected,
    keep_draft,
    read_text,
    write_text,
)
from tuisim.app.editor.text_lines import LineMap, count_differing_lines
from tuisim.base.errors import ConfigError, TuisimError, counted
from tuisim.base.source import source_lines
from tuisim.programs.program_file import describe_new_file, find_wrong_names, find_wrong_option
from tuisim.settings.options import Settings

if TYPE_CHECKING:
    from tuisim.app.host import LabHost
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.base.source import Program
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.programs.program_file import Mistake

DRAFT_DELAY_S = 1.0
"""Seconds after an edit until the unsaved text is stored as a draft, in case of a crash."""
NEW_NAME = "new.py"


class Document:
    """The open program: its edited text, its file, and whether the text can run.

    Args:
        app: Shows notices and dialogs.
        run_controller: Has the program that runs next, and the run in view.
        panel_area: Has the code panel.
        loader: Gets the edited text.
    """

    def __init__(
        self, app: LabHost, run_controller: RunController, panel_area: PanelArea, loader: Loader
    ) -> None:
        self._app = app
        self._run_controller = run_controller
        self._panel_area = panel_area
        self._loader = loader
        self._program: Program | None = None
        """The program of the next run, if the text was not edited since."""
        self._name = self._path = self._text = self._saved = self._applied = ""
        """The file's name; its path; the text as edited; as in the file; and as it was when `_program` was made
        from it."""
        self._form = TextFormat()
        self._seeks_error = False
        """Whether the code panel, as soon as it is shown, must move to the line that is marked as an error."""
        self._is_file = False
        """Whether the text was read from its file or saved there, so that saving needs no question."""
        self._draft_pending = self._asking = False
        self._restored = ""
        """Path of the program whose draft is just being restored; empty for none."""
        self._error_line = 0
        """Line of the current run's text at which it ended with an error; 0 for none, or once the text has changed."""
        self._error_words = ""
        """The error at `_error_line` in words; empty if it is unknown."""
        self._ran: tuple[Recording, str] | None = None
        """The recording in view, and the text that it ran, as it was in the editor; None without a recording."""

    @property
    def name(self) -> str:
        """The file name of the open program."""
        return self._name

    @property
    def dirty(self) -> bool:
        """Whether the text of the program has unsaved changes."""
        return self._text != self._saved

    # The following methods open programs.

    def begin(self, asks: bool) -> None:
        """Show the open program at the start of the app.

        Args:
            asks: Whether to offer unsaved text from an earlier session. It is offered only if no program is open, and
                if the text belongs to a program without a file.
        """
        self.show_program()
        self.open_at_mistake()
        if self._path and not (self._text or os.path.lexists(self._path)):
            self._app.say(describe_new_file(Path(self._path)))
        elif (
            self._path
            and is_example(Path(self._path))
            and self._run_controller.timeline.recording is None
        ):
            self._app.say(
                f"the example {self._name}: {{edit}} edits it, ctrl+s then saves a copy into"
                f" {Path.cwd().name}/"
            )
        if asks and self._program is None and (draft := find_draft("")):
            self._offer(draft)

    def open_at_mistake(self) -> None:
        """If the opened program has a mistake, show the line of the mistake."""
        words = self.go_to_mistake() if self._program else ""
        # The output shows the message, too, because the frame of a narrow code panel cuts it.
        if words and (output := self._panel_area.output):
            output.note(f"— {words}")

    def show_program(self) -> None:
        """Show the program of the next run in the code panel; load its text if the panel shows another text."""
        program = self._run_controller.program
        if program is not self._program:
            same = program is not None and self._program is not None and program.path == self._path
            if not (same and program is not None and program.text == self._parse_text()):
                self._load_program(program, offers=not same)
            self._program = program
            self._applied = self._text
        self.show()

    def _load_program(self, program: Program | None, offers: bool) -> None:
        self._name, self._path = (program.name, program.path) if program else ("", "")
        self._text = self._saved = program.text if program else ""
        self._form = TextFormat()
        self._is_file = False
        self._error_line = 0
        if program is None:
            return
        if program.path:
            try:
                text, form = read_text(Path(program.path))
            except ConfigError:
                # The file is new, or missing or invalid by now: show the text that was read from it before.
                text = ""
                form = TextFormat()
            if self._parse_text(text) == program.text:
                self._text = text
                self._form = form
                self._is_file = True
                self._saved = text
        if offers and program.path and (draft := find_draft(program.path)):
            if draft.text == self._text:
                drop_draft(program.path)
            elif self._restored == program.path:
                self._text = draft.text
            else:
                self._offer(draft)

    def _parse_text(self, text: str | None = None) -> str | None:
        """Return the text that would run, without its magic line; None if the magic line is invalid.

        Args:
            text: A text as edited; None for the text in the editor.
        """
        from tuisim.programs.program_file import parse_program

        try:
            return parse_program(self._text if text is None else text, self._name).program.text
        except TuisimError:
            return None

    def show(self) -> None:
        """Show the text, the name of its program, unsaved changes and an error in the code panel."""
        if code := self._panel_area.code:
            code.set_program(self._name, self._text, self._path or self._name)
            code.set_title(self._name, self.dirty)
            self.run_changed()
            if self._error_line and not code.error_line:
                code.mark_run_error(self._error_line, self._error_words)
            self._go_to_error()
        if controls := self._panel_area.controls:
            controls.program = self._name

    def _go_to_error(self) -> None:
        if self._seeks_error and self._panel_area.code:
            self._seeks_error = False
            # A new panel has no size yet, so it cannot scroll.
            self._app.call_after_refresh(self._panel_area.code.go_to_error)

    def run_changed(self) -> None:
        """Give the code panel the text of the run in view, so that it can show differences."""
        code = self._panel_area.code
        recording = self._run_controller.timeline.recording
        if recording is None:
            self._ran = None
        elif self._ran is None or self._ran[0] is not recording:
            as_run = recording.program.text
            self._ran = (
                recording,
                self._applied if self._parse_text(self._applied) == as_run else as_run,
            )
        if code is not None and self._ran is not None:
            code.set_running(self._ran[1], self._ran[0].program.name == self._name)
        elif code is not None:
            code.set_running(None)

    def mark_failure(self, line: int, words: str = "") -> None:
        """Mark the line at which the current run ended with an error.

        Args:
            line: From 1, in the text of the run; 0 for no error.
            words: What went wrong; with them, the code panel is opened at the line.
        """
        self._error_line, self._error_words = line, words
        self._seeks_error = bool(line and words)
        code = self._panel_area.code
        if self._seeks_error and not self._panel_area.is_single:
            self._panel_area.open("code")
        if code:
            code.mark_run_error(line, words)
            self._go_to_error()

    def lines(self) -> LineMap:
        """Return the map between the lines of the current run and the lines of the edited text."""
        now = source_lines(self._text)
        return LineMap(now if self._ran is None else source_lines(self._ran[1]), now)

    # Editing

    def handle_edit(self, text: str) -> None:
        """Store the text after an edit in the code panel, and save it as a draft `DRAFT_DELAY_S` seconds later."""
        self._text = text
        self._error_line = 0
        if code := self._panel_area.code:
            code.set_title(self._name, self.dirty)
        if not self._draft_pending:
            self._draft_pending = True
            self._app.set_timer(DRAFT_DELAY_S, self.save_draft)

    def save_draft(self) -> None:
        """Store unsaved text as a draft; if all is saved, delete the draft."""
        if not self._draft_pending:
            return
        self._draft_pending = False
        if not self.dirty:
            drop_draft(self._path)
            return
        try:
            keep_draft(self._path, self._text)
        except ConfigError as error:
            self._app.complain(error)

    def _offer(self, draft: Draft) -> None:
        from tuisim.app.dialogs.question import Question

        name = self._name or NEW_NAME
        when = time.strftime("%d %b %H:%M", time.localtime(draft.written_s))
        lines = count_differing_lines(self._text, draft.text)
        text = f"{name} was edited on {when} and not saved: {counted(lines, 'line differs', 'lines differ')}."
        # No answer has a key of the app: the user may press such a key just before the question appears.
        answers = (("r", "Restore the edited text"), ("ctrl+d", "Discard it"))
        self._app.push_screen(
            Question("Unsaved work", text, answers),
            lambda answer: self._handle_offer(draft, answer),
        )

    def _handle_offer(self, draft: Draft, answer: str | None) -> None:
        if answer == "ctrl+d":
            drop_draft(draft.path)
        elif answer == "r" and self._program is None:
            self.restore(draft)
        elif answer == "r" and draft == find_draft(self._path):
            self._text = draft.text
            self.show()
            self._show_restored()

    def _show_restored(self) -> None:
        """Show the code with the restored text, and say that it is not saved yet."""
        self._panel_area.open("code")
        self._app.say("The unsaved text is back. {edit} edits it, and ctrl+s then saves it")

    def restore(self, draft: Draft) -> None:
        """Open the program of a draft, with the unsaved text of the draft."""
        if draft.path:
            self._restored = draft.path
            self._loader.open_file(draft.path)
            self._restored = ""
        else:
            self._open_new(draft.text)
            self._saved = ""
            self.show()
        self._show_restored()

    def run_when_saved(self, do: Callable[[], None]) -> None:
        """Call `do`, which replaces the text of the program, once no unsaved change would be lost.

        If the text has unsaved changes, first ask whether to save or discard them.
        """
        if not self.dirty:
            do()
            return
        from tuisim.app.dialogs.question import Question

        def handle_answer(answer: str | None) -> None:
            if answer == "s":
                self.save(do)
            elif answer == "d":
                self._discard()
                do()

        place = "" if self._has_own_file else " into a file of yours"
        answers = (("s", f"Save them{place}"), ("d", "Discard them"))
        question = Question(
            "Unsaved changes",
            f"{self._name} has changes that are not saved.",
            answers,
            "continues editing",
        )
        self._app.push_screen(question, handle_answer)

    def _discard(self) -> None:
        self._text = self._saved
        drop_draft(self._path)
        self.show()

    def apply(self) -> bool:
        """Make the edited text the program of the next run; if the text cannot run, mark and show its error.

        Returns:
            Whether the program can run.
        """
        self.show_program()
        if self._name == NEW_NAME and not self._path:
            # A new program is in no file, so it counts as unsaved once it has run.
            self._saved = ""
        is_applied = self._is_applied
        if is_applied and not self._lacks_options:
            return True
        # A typing error in the magic line must not change the mat.
        if mistake := self._find_mistake():
            self._app.complain(TuisimError(self._explain_mistake(mistake)))
            return False
        return is_applied or self._apply_text()

    def go_to_mistake(self) -> str:
        """Show the line of the mistake because of which the text cannot run, if there is one.

        Returns:
            Why the text cannot run; empty if it can. Also empty if the run in view is a run of exactly this text: the
            error of that run then says more.
        """
        self.run_changed()
        is_run = self._ran is not None and self._ran[1] == self._text
        if is_run or not (mistake := self._find_mistake()):
            return ""
        self._error_line, self._error_words = mistake.line, mistake.message
        self._seeks_error = True
        self._panel_area.open("code")
        self.show()
        return self._explain_mistake(mistake)

    def _explain_mistake(self, mistake: Mistake) -> str:
        return f"{self._name} cannot run: {mistake.message}"

    @property
    def _lacks_options(self) -> bool:
        """Whether an option or a name in the magic line is wrong; the program was then opened without it.

        A wrong name no longer counts once the user has chosen another, such as another mat.
        """
        if find_wrong_option(self._text, self._name):
            return True
        plan = self._run_controller.next_run
        chosen = plan.settings.changed(plan.words)
        return any(
            wrong.path in plan.free or chosen[wrong.path] == Settings()[wrong.path]
            for wrong in find_wrong_names(self._text, self._file, self._name, plan.settings["mats"])
        )

    @property
    def _file(self) -> Path | None:
        return Path(self._path) if self._path else None

    @property
    def _is_applied(self) -> bool:
        return self._program is None or (self._text, self._path) == (
            self._applied,
            self._program.path,
        )

    def _find_mistake(self) -> Mistake | None:
        """Return the mistake because of which the text cannot run, and mark its line; None if there is none."""
        from tuisim.programs.program_file import find_mistake

        mistake = find_mistake(
            self._text, self._name, self._run_controller.next_run.settings["mats"], self._file
        )
        if code := self._panel_area.code:
            code.mark_error(mistake.line if mistake else 0, mistake.message if mistake else "")
        return mistake

    def _apply_text(self) -> bool:
        try:
            self._loader.apply_text(self._text, self._path, self._name)
        except TuisimError as error:
            self._app.complain(error)
            return False
        return True

    def start_new(self, text: str) -> None:
        """Open a new program with a text, and start typing at its end."""
        draft = find_draft("")
        self._open_new(text)
        if draft:
            self._offer(draft)
        elif code := self._panel_area.code:
            code.start_typing(at_end=True)

    def _open_new(self, text: str) -> None:
        try:
            self._loader.open_new(text, NEW_NAME)
        except TuisimError as error:
            # The magic line of the draft is not finished: open an empty program, then put the text in.
            self._app.complain(error)
            self._loader.open_new("", NEW_NAME)
            self._text = text

    def write_mat(self, mat: str) -> None:
        """Write the name of a mat into the magic line; then save the program, unless it had unsaved changes before."""
        from tuisim.programs.program_file import replace_mat

        was_dirty = self.dirty
        try:
            self.handle_edit(replace_mat(self._text, self._name, mat))
            self.show()
            self._apply_text()
        except TuisimError as error:
            self._app.complain(error)
            return
        if not was_dirty:
            self.save_own()
        self._app.say(f"{self._name} begins with {mat}" + (", not saved yet" if self.dirty else ""))

    @property
    def named_mat(self) -> str | None:
        """The mat that the magic line of the program names; empty if the line names none.

        The result is None if the program has no magic line, or its file must not be written.
        """
        from tuisim.programs.program_file import find_magic

        if not self._text or (self._path and is_protected(Path(self._path))):
            return None
        try:
            magic = find_magic(self._text, self._name)
        except TuisimError:
            return None
        return None if magic is None else str(magic.options.get("background", ""))

    # Saving

    def save(self, then: Callable[[], None] = lambda: None) -> None:
        """Save the program to its file; if the program has no file, ask for one.

        Args:
            then: Called after the program was saved.
        """
        if self._program is None:
            self._app.say("No program to save: {open} opens one")
            return
        path = Path(self._path)
        if self._has_own_file:
            if self._try_write(path):
                self._finish_save(path, then)
            return
        from tuisim.app.dialogs.save import ProgramDialog

        def handle_saved(target: Path | None) -> None:
            if target:
                self._finish_save(target, then)

        self._app.push_screen(
            ProgramDialog("program", str(Path.cwd() / self._name), self._write), handle_saved
        )

    def run_with_file(self, do: Callable[[Path], None]) -> None:
        """Save the program if necessary, then call `do` with the path of its file."""
        if self._has_own_file and not self.dirty:
            do(Path(self._path))
        else:
            self.save(lambda: do(Path(self._path)))

    def save_own(self) -> None:
        """Save unsaved changes without asking, if the file is the student's own."""
        if self.dirty and self._has_own_file and self._try_write(Path(self._path)):
            self._mark_saved(Path(self._path))

    @property
    def _has_own_file(self) -> bool:
        """Whether the program is in a file of the student's own, and no example."""
        return bool(self._path) and self._is_file and not is_protected(Path(self._path))

    def _try_write(self, path: Path) -> bool:
        """Write the text to a file. Return whether it could be written."""
        try:
            self._write(path)
        except TuisimError as error:
            self._app.complain(error)
            return False
        return True

    def _mark_saved(self, path: Path) -> None:
        drop_draft(self._path)
        self._saved = self._text
        self._is_file = True
        self._path = str(path)
        self._name = path.name
        self._loader.note_saved(path)
        self.show()

    def _write(self, path: Path) -> None:
        if path.suffix != ".py":
            raise ConfigError(
                "is not a valid program name", "the name of a program ends in .py", file=str(path)
            )
        if is_protected(path):
            raise ConfigError(
                "is an example, or cannot be written", "choose another file", file=str(path)
            )
        write_text(path, self._text, self._form)

    def _finish_save(self, path: Path, then: Callable[[], None]) -> None:
        """After the text was saved to a file, show a notice, and call `then`.

        If the text has a mistake, the notice is an error that names the mistake.
        """
        moved = str(path) != self._path
        self._mark_saved(path)
        mistake = self._find_mistake()
        if not self._run_controller.in_run and not self._is_applied and (moved or not mistake):
            self._apply_text()
        if mistake:
            self._app.complain(
                TuisimError(f"{self._name} is saved, but cannot run: {mistake.message}")
            )
        else:
            self._app.say(f"{self._name} is saved")
        then()

    # The following methods handle changes of the file on disk.

    def check_conflict(self, path: Path) -> bool:
        """If a file that changed on disk has unsaved edits in the app, ask which version to keep.

        Returns:
            Whether it has unsaved edits.
        """
        if not self.dirty or Path(self._path) != path:
            return False
        if not self._asking:
            self._asking = True
            from tuisim.app.dialogs.question import Question

            text = f"{self._name} was changed on disk, and has unsaved changes here."
            answers = (("k", "Keep mine"), ("t", "Use the file's"))
            self._app.push_screen(Question("Two versions", text, answers), self._handle_resolution)
        return True

    def _handle_resolution(self, answer: str | None) -> None:
        self._asking = False
        if answer == "t":
            self._discard()
            self._loader.reload(Path(self._path))
