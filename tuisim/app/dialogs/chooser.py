"""Choosing from a list by name, or by the path of a file; mats with a preview."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.widget import Widget
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app import background
from tuisim.app.dialogs.dialog import MOVE_KEYS, FieldDialog, name_and_title
from tuisim.app.dialogs.paths import check_numbers, complete_path, is_path, list_completions
from tuisim.app.dialogs.save import parse_path
from tuisim.app.error_words import shorten_error
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError, TuisimError
from tuisim.base.folders import user_path
from tuisim.engine import files
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.mat_image import read_pixels
from tuisim.engine.mats import find_mat
from tuisim.engine.obstacles import OBSTACLES, load_obstacles
from tuisim.logs.export import is_companion
from tuisim.pictures.scene.mat import shrink
from tuisim.pictures.scene.view import Viewport
from tuisim.programs.program_file import LOG_SUFFIXES
from tuisim.settings.profiles import load_profile
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.pixels import Pixels

if TYPE_CHECKING:
    from tuisim.app.setup.next_run import NextRun
    from tuisim.engine.mats import Background

OPENABLE = (".py", ".toml")
TABLES = (".toml", ".json")
TEXTS = (".txt", ".log")
LOGS = (*LOG_SUFFIXES, *TEXTS)
IMAGES = (".png", ".jpg", ".jpeg", ".gif", ".webp", ".bmp", ".tif", ".tiff")
"""Suffixes of the picture files that choosers of mats list in a folder."""
MAX_FILES = 200
MAX_TRIED = 50
"""Maximum number of files of the folder that are opened to check their format; further files are not listed."""


@dataclass(frozen=True, slots=True)
class ChoiceGroup:
    """Entries of a list of choices under one title."""

    title: str
    entries: Sequence[tuple[str, str, str]]
    """The entries of the group: the value that the dialog returns, the name, and the title, which may be empty."""


def list_files(
    suffixes: Iterable[str], fits: Callable[[Path], object] | None = None
) -> ChoiceGroup:
    """Return the files in the current folder with some suffixes as a group of choices, without hidden files.

    Args:
        suffixes: Suffixes of the files, with their dots.
        fits: Raises TuisimError for a file that must not be listed.
    """
    endings = tuple(suffixes)
    paths = sorted(
        path
        for path in Path.cwd().iterdir()
        if path.suffix.lower() in endings
        and not (path.name.startswith(".") or is_companion(path))
        and path.is_file()
    )
    if fits:
        paths = [path for path in paths[:MAX_TRIED] if _is_readable(fits, path)]
    return ChoiceGroup(
        f"In {Path.cwd().name or '/'}", [(str(path), path.name, "") for path in paths]
    )


def _is_readable(fits: Callable[[Path], object], path: Path) -> bool:
    try:
        fits(path)
    except TuisimError:
        return False
    return True


class ListDialog(FieldDialog[str]):
    """A dialog with a list and usually a text field; it returns the value of the chosen entry, or the typed path."""

    BINDINGS: ClassVar[list[BindingType]] = [*MOVE_KEYS]

    def on_mount(self) -> None:
        # Earlier notices would cover the lowest rows of a small window.
        self.app.clear_notifications()
        self.query_one(OptionList).focus()

    @on(OptionList.OptionSelected)
    def _handle_selection(self, event: OptionList.OptionSelected) -> None:
        self.choose(event.option.id or "")

    def choose(self, value: str) -> None:
        """Close the dialog, and return the value that was chosen."""
        self.dismiss(value)

    @on(Input.Submitted)
    def _handle_submission(self, event: Input.Submitted) -> None:
        if typed := event.value.strip():
            try:
                parse_path(typed)
                self.read(typed)
            except TuisimError as error:
                self.report_unread(error)
            else:
                self.dismiss(typed)

    def read(self, typed: str) -> object:
        """Return the object that a typed name or path means, such as the world in a file.

        Raises:
            TuisimError: there is no such object.
        """
        return typed

    def report_unread(self, error: TuisimError) -> None:
        """Show what is wrong with the typed text, which stays in the field."""
        self.app.notify(shorten_error(error), severity="error")


class Chooser(ListDialog):
    """A dialog that returns a name or a path; typed words search its list, and the field also takes a path.

    Args:
        title: Title of the dialog.
        groups: The list; empty groups are left out.
        current: The value of the entry that is selected at first.
        path_hint: What the user may type in the field besides words to search for; empty for no field.
        read: Returns the object that a name or a path means, or raises a TuisimError.
        suffixes: Suffixes of the files that a path may name, with their dots.
    """

    HINT: str = "Enter selects · Escape closes"
    LISTS_TITLES = True
    """Whether the list shows the titles of the entries; the search reads them in any case."""

    def __init__(
        self,
        title: str,
        groups: Sequence[ChoiceGroup],
        current: str = "",
        path_hint: str = "",
        read: Callable[[str], object] = str,
        suffixes: Sequence[str] = (),
    ) -> None:
        super().__init__()
        self.TITLE_TEXT = title
        if path_hint:
            self.HINT = "Enter selects · type to search, tab completes a path · Escape closes"
        self._suffixes = suffixes
        self._groups = [group for group in groups if group.entries]
        self._current = current
        self._path_hint = path_hint
        self._read = read

    def compose_content(self) -> ComposeResult:
        if self._path_hint:
            yield from self.compose_field()
        yield self.build_list()

    def compose_field(self) -> Iterable[Widget]:
        """Yield the field, and below it the line for errors in the typed text."""
        yield self.field()
        yield Static(id="message", markup=False)

    def field(self) -> Input:
        """Return a new text field for words to search for, or for a path."""
        return Input(
            placeholder=f"Search, or the {self._path_hint}", compact=True, select_on_focus=False
        )

    def build_list(self) -> OptionList:
        """Return a new list of all groups, with the current value highlighted."""
        listed = OptionList(*self._build_options(self._groups))
        names = [option.id for option in listed.options]
        if self._current in names:
            listed.highlighted = names.index(self._current)
        return listed

    def _build_options(self, groups: Iterable[ChoiceGroup]) -> list[Option | None]:
        options: list[Option | None] = []
        for group in groups:
            if options:
                options.append(None)
            if group.title:
                options.append(Option(Text(group.title, "italic"), disabled=True))
            # The names get no more width than they need, so that the titles get the rest.
            name_cells = max((len(name) for _, name, title in group.entries if title), default=0)
            options += [
                Option(
                    name_and_title(name, title, name_cells)
                    if title and self.LISTS_TITLES
                    else Text(name, "bold"),
                    id=chosen,
                )
                for chosen, name, title in group.entries[:MAX_FILES]
            ]
            if len(group.entries) > MAX_FILES:
                more = f"… and {len(group.entries) - MAX_FILES} more: type the name"
                options.append(Option(Text(more), disabled=True))
        return options

    @on(Input.Changed)
    def _search(self, event: Input.Changed) -> None:
        listed = self.query_one(OptionList)
        typed = event.value.strip()
        # A fixed height keeps the dialog in place while the list becomes shorter.
        listed.styles.height = listed.outer_size.height if typed else None
        groups = self._search_groups(typed)
        listed.clear_options()
        listed.add_options(self._build_options(groups))
        empty = "no such file here" if is_path(typed) else "nothing here has these words"
        self.say("" if groups else empty)
        if not groups:
            self.preview("")
        else:
            best = find_best_match(groups, os.path.basename(typed)) if typed else self._current
            listed.highlighted = next(
                (index for index, option in enumerate(listed.options) if option.id == best), None
            )

    @on(OptionList.OptionHighlighted)
    def _preview_highlighted(self, event: OptionList.OptionHighlighted) -> None:
        # A further letter may have removed the entry from the list before this message arrives.
        if event.option_list.highlighted == event.option_index:
            self.preview(event.option.id or "")

    def preview(self, value: str) -> None:
        """Show a preview of an entry in subclasses that have one; clear it if the value is empty."""

    def _search_groups(self, typed: str) -> Sequence[ChoiceGroup]:
        if not (self._suffixes and is_path(typed)):
            return search_groups(self._groups, typed)
        entries = list_completions(typed, self._suffixes)
        return [ChoiceGroup(f"In {os.path.dirname(typed) or '.'}", entries)] if entries else []

    def on_key(self, event: events.Key) -> None:
        """On tab, complete the typed path."""
        fields = self.query(Input)
        typed = fields.first().value if fields else ""
        if (
            event.key == "tab"
            and fields
            and fields.first().has_focus
            and self._suffixes
            and is_path(typed)
        ):
            event.stop()
            event.prevent_default()
            entries = list_completions(typed, self._suffixes)
            longer = complete_path(typed, entries)
            self._type(longer)
            if longer == typed and len(entries) > 1:
                self.say(f"{len(entries)} names begin like this: type more, or choose one")

    def _type(self, text: str) -> None:
        field = self.query_one(Input)
        field.value = text
        field.cursor_position = len(text)
        field.focus()

    def choose(self, value: str) -> None:
        """Show the content of a chosen folder; for any other value, close the dialog and return it."""
        if is_path(value) and value.endswith("/"):
            self._type(value)
        else:
            super().choose(value)

    def read(self, typed: str) -> object:
        """Return the object that a typed name or path means, from the function `read` of the dialog."""
        return self._read(typed)

    def report_unread(self, error: TuisimError) -> None:
        """If the search has highlighted an entry, choose that entry.

        Otherwise show why the typed text means nothing.
        """
        listed = self.query_one(OptionList)
        if listed.highlighted is None:
            self.say(shorten_error(error), wrong=True)
        else:
            listed.action_select()


def search_groups(groups: Iterable[ChoiceGroup], typed: str) -> list[ChoiceGroup]:
    """Return the groups with only those entries whose name or title contains every word of a text."""
    words = typed.lower().split()

    def has_words(entry: tuple[str, str, str]) -> bool:
        return all(word in f"{entry[1]} {entry[2]}".lower() for word in words)

    matches = (replace(group, entries=[*filter(has_words, group.entries)]) for group in groups)
    return [group for group in matches if group.entries]


def find_best_match(groups: Iterable[ChoiceGroup], typed: str) -> str:
    """Return the value of the first entry whose name begins with the typed text, else of the first that contains it.

    If no name contains it, return the value of the first entry of all.
    """
    entries = [entry for group in groups for entry in group.entries]
    prefix = typed.lower()
    return min(
        entries,
        key=lambda entry: (not entry[1].lower().startswith(prefix), prefix not in entry[1].lower()),
    )[0]


def build_program_chooser() -> Chooser:
    """Return the dialog with the programs, worlds, goals and logs in the current folder, and the examples."""
    from tuisim.programs.program_file import list_programs
    from tuisim.settings.worlds import WorldFile
    from tuisim.tasks.goals.files import list_examples as goals_examples

    examples = list_programs()
    goals = goals_examples()
    known = {str(path.resolve()) for path in (*(path for _, path, _ in examples), *goals)}
    here = list_files([".py"])
    own = ChoiceGroup(here.title, [entry for entry in here.entries if entry[0] not in known])
    worlds = [
        entry for entry in list_files([".toml"], WorldFile.load).entries if entry[0] not in known
    ]
    groups = [
        own,
        ChoiceGroup(
            "Worlds and goals" if own.entries else f"{here.title}: worlds and goals", worlds
        ),
        ChoiceGroup(
            "Logs",
            [*list_files(LOG_SUFFIXES).entries, *list_files(TEXTS, check_numbers).entries],
        ),
        ChoiceGroup("Examples", [(str(path), name, title) for name, path, title in examples]),
        ChoiceGroup(
            "Examples of goals", [(str(path), path.name, _read_title(path)) for path in goals]
        ),
    ]
    title = "Programs, worlds, goals and logs"
    suffixes = (*OPENABLE, *LOGS)
    hint = "path of a program, world, goals file or log"
    return Chooser(title, groups, path_hint=hint, read=_read_openable, suffixes=suffixes)


def _read_title(path: Path) -> str:
    title = files.read_file(path, ConfigError).get("title", "")
    return title if isinstance(title, str) else ""


def is_log(word: str) -> bool:
    """Return whether a path names a log file, by its suffix."""
    return Path(word).suffix.lower() in LOGS


def _read_openable(word: str) -> object:
    """Read, check and return a program, or a world with its goals; for a log, only check that its file exists.

    Raises:
        TuisimError: the file does not exist, or its content is wrong.
    """
    if is_log(word):
        if not os.path.isfile(user_path(word)):
            raise LogError("no such file", file=word)
        return word
    from tuisim.programs.program_file import find_program, read_program
    from tuisim.settings.worlds import is_world_name
    from tuisim.tasks.goals.files import load_task

    path = find_program(str(user_path(word)))
    return load_task(path) if is_world_name(word) else read_program(path)


def build_obstacle_chooser(plan: NextRun) -> Chooser:
    """Return the dialog with the sets of obstacles to choose from."""
    presets = [
        (
            name,
            name,
            "; ".join(f"{b.width_mm:g}×{b.height_mm:g} at ({b.x_mm:g}, {b.y_mm:g})" for b in boxes)
            or "none",
        )
        for name, boxes in OBSTACLES.items()
    ]
    groups = [
        ChoiceGroup("", presets),
        list_files([".toml", ".json"], lambda path: load_obstacles(str(path))),
    ]
    return Chooser(
        "Obstacles",
        groups,
        plan.words.get("obstacles", ""),
        "path of a .toml or .json file",
        load_obstacles,
        TABLES,
    )


def build_profile_chooser(plan: NextRun) -> Chooser:
    """Return the dialog with the profiles to choose from."""
    presets = [
        (
            name,
            name,
            f"{p.title}; light 0 to {p.reflected_max}, {'walls' if p.solid else 'nothing'} solid",
        )
        for name, p in PROFILES.items()
    ]
    groups = [ChoiceGroup("", presets), list_files([".toml"], lambda path: load_profile(str(path)))]
    return Chooser(
        "Profiles",
        groups,
        plan.words.get("profile", ""),
        "path of a profile's .toml file",
        load_profile,
        [".toml"],
    )


MAX_NAME_COLUMNS = 32
"""Maximum width of the list of names in columns: the names of custom files may be long."""


_STALE_S = 0.15
"""Seconds for which the previous mat's picture may stay on the screen while that of the chosen mat is read."""


class MatPicker(Chooser):
    """The dialog that returns the name of a mat, or the path of an image.

    Args:
        current: The current mat, as named in a specification.
        known: All mats by name.
        folder: The user's own folder of mats; None for the default one only.
    """

    LISTS_TITLES = False

    def __init__(self, current: str, known: Mapping[str, Background], folder: str | None) -> None:
        laid = next(
            (name for name, mat in known.items() if mat.find_spec_name() == current),
            next(iter(known), ""),
        )
        groups = [ChoiceGroup("", [(name, name, mat.title) for name, mat in known.items()])]
        find = partial(find_mat, folder=folder)
        super().__init__("Mats", groups, laid, "path of your own image", find, IMAGES)
        self._mats = known
        self._folder = folder
        self._shown = ""
        self._pictures: dict[tuple[str, Viewport], Pixels] = {}

    def compose_content(self) -> ComposeResult:
        yield from self.compose_field()
        listed = self.build_list()
        listed.styles.width = min(max(map(len, self._mats), default=0) + 5, MAX_NAME_COLUMNS)
        with Horizontal(classes="mats"):
            yield listed
            with Vertical():
                yield _MatPicture()
                yield Static(id="title", markup=False)

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)

    def on_resize(self) -> None:
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        view = self.query_one(PixelView)
        view.styles.height = max(1, round(view.size.width * FIELD_HEIGHT_MM / FIELD_WIDTH_MM / 2))
        self.call_after_refresh(self.show_again)

    def show_again(self) -> None:
        """Show the preview of the highlighted mat again, because the size of its picture has changed."""
        self.preview(self._shown)

    def preview(self, value: str) -> None:
        """Preview a mat: show its title, and its image as soon as that is decoded."""
        self._shown = value
        view = self.query_one(PixelView)
        if not (value in self._mats or Path(value).suffix.lower() in IMAGES) or not view.size:
            view.clear_picture()
            self.query_one("#title", Static).update("")
            return
        port = find_field_view(view)
        self._say_title(value, (value, port) in self._pictures)
        if (picture := self._pictures.get((value, port))) is not None:
            view.set_fine_picture(picture, view.graphics)
        else:
            self.set_timer(_STALE_S, partial(self._clear_stale, (value, port)))
            work = partial(self._decode, value, port, view.ground_rgb)
            then = partial(self._show_decoded, (value, port))
            failed = partial(self._report, value)
            background.run(self, work, then, failed, group="picture", exclusive=True)

    def _say_title(self, name: str, is_drawn: bool) -> None:
        title = self._mats[name].title if name in self._mats else Path(name).name
        self.query_one("#title", Static).update(title if is_drawn else f"{title} · loading …")

    def _clear_stale(self, key: tuple[str, Viewport]) -> None:
        """Clear the picture if the mat of `key` is still the highlighted one, and is still being decoded.

        Args:
            key: The name of the mat, and the viewport of its picture.
        """
        if self.is_attached and key[0] == self._shown and key not in self._pictures:
            self.query(PixelView).first().clear_picture()

    def _decode(self, name: str, port: Viewport, outside_rgb: tuple[int, int, int]) -> Pixels:
        mat_file = find_mat(name, self._folder)
        mat = read_pixels(mat_file.image, mat_file.fit or "stretch")
        return shrink(mat, port, outside_rgb)

    def _show_decoded(self, key: tuple[str, Viewport], picture: Pixels) -> None:
        self._pictures[key] = picture
        # A dialog that is being closed may have no view any more.
        if not self.is_attached or not self.query(PixelView) or key[0] != self._shown:
            return
        view = self.query_one(PixelView)
        if key[1] == find_field_view(view):
            self._say_title(key[0], is_drawn=True)
            view.set_fine_picture(picture, view.graphics)
        else:
            # The view got its size while the image was decoded: decode the image again for that size.
            self.show_again()

    def _report(self, name: str, error: TuisimError) -> None:
        if self.is_attached and self.query(PixelView) and name == self._shown:
            self.query_one(PixelView).clear_picture()
            self.query_one("#title", Static).update(str(error))


class _MatPicture(PixelView):
    def draw_picture(self) -> None:
        if isinstance(picker := self.screen, MatPicker):
            picker.show_again()


def find_field_view(view: PixelView) -> Viewport:
    """Return the viewport in which a widget shows the whole field, with the finest dots that the terminal can draw."""
    cell = view.choose_cell(view.graphics)
    return Viewport.fit_field(cell.cols * view.size.width, cell.rows * view.size.height, cell)
