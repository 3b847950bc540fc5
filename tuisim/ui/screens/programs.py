"""The program picker: examples, files of the folder one is in, or a path typed in."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.widgets import Input, OptionList
from textual.widgets.option_list import Option

from tuisim.ui.screens.dialog import Dialog, name_and_title

MAX_FILES = 200


def _example(name: str, path: Path, title: str, wide: int) -> Option:
    return Option(name_and_title(name, title, wide), id=str(path))


class ProgramPicker(Dialog[str]):
    """Gives the path of the chosen program."""

    TITLE_TEXT: ClassVar[str] = "Programs"
    HINT: ClassVar[str] = "Enter opens · tab to the list · Escape closes"

    def content(self) -> ComposeResult:
        """A field for a path, and the list."""
        from tuisim.assets import programs

        examples = programs()
        shown = {Path(path).resolve() for _, path, _ in examples}
        here = sorted(path for path in Path.cwd().glob("*.py") if path.is_file() and path.resolve() not in shown)
        options: list[Option | None] = []
        if here:
            options.append(Option(Text(f"In {Path.cwd().name or '/'}", "italic"), disabled=True))
            options += [Option(Text(path.name, "bold"), id=str(path)) for path in here[:MAX_FILES]]
            if len(here) > MAX_FILES:
                options.append(Option(Text(f"… and {len(here) - MAX_FILES} more: type the name"), disabled=True))
            options.append(None)
        wide = max((len(name) for name, _, _ in examples), default=0)
        options.append(Option(Text("Examples", "italic"), disabled=True))
        options += [_example(name, Path(path), title, wide) for name, path, title in examples]
        yield Input(placeholder="Path of a program, or choose below", compact=True)
        yield OptionList(*options)

    def on_mount(self) -> None:
        """Begin in the list: most want one of those."""
        self.query_one(OptionList).focus()

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option.id)

    @on(Input.Submitted)
    def _typed(self, event: Input.Submitted) -> None:
        if event.value.strip():
            self.dismiss(event.value.strip())
