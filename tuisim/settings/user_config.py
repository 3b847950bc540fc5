"""The user's own defaults: `config.toml`, its settings, and how they are read.

An option of the command line is a setting unless its value says otherwise (`Value.in_config`); the others are at the
end of `_EVERY`. To add a setting: do the one or the other.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from enum import StrEnum
from functools import lru_cache
from pathlib import Path
from textwrap import wrap
from typing import Any

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest, see_page
from tuisim.base.folders import user_path
from tuisim.base.regular_file import read_regular
from tuisim.engine.core.values import Value, quote
from tuisim.engine.files import (
    Location,
    Scalar,
    means_file,
    parse_toml,
    read_value,
    table,
    toml_form,
    toml_value,
)
from tuisim.settings.options import APP_PATHS, OPTIONS, Name, Settings

FILE = "config.toml"
PAGE = "settings"
MAX_FILE_BYTES = 100_000
MAX_KEYS = 10


class Section(StrEnum):
    """A table of `config.toml`: defaults of runs, defaults of the app, or keys."""

    SIMULATION = "simulation"
    APP = "app"
    KEYS = "keys"


ABOUT: Mapping[Section, str] = {
    Section.SIMULATION: "Defaults for the app and `tuisim run`; options and the program's first line take precedence. "
    "They do not apply with a world file, goals or a lesson: these are the same for everybody.",
    Section.APP: "How the app looks and sounds.",
    Section.KEYS: "Other keys for actions of the app: `tuisim guide keys` lists the actions by id.",
}
"""The purpose of each table."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A setting that `config.toml` can contain: its table and name, the values that are allowed, and its default."""

    section: Section
    name: str
    value: Value
    default: Any
    """The value without the file; an empty text where mat, robot or program decides."""
    sets: str = ""
    """The path in `Settings` that it sets; empty if there is none."""
    at_once: bool = True
    """Whether the app could apply a change at once."""

    @property
    def path(self) -> str:
        """The name of the setting's table, a dot, and the name of the setting."""
        return f"{self.section}.{self.name}"

    @property
    def help(self) -> str:
        """What the setting does, as a sentence."""
        return f"{self.value.help[0].upper()}{self.value.help[1:]}."

    @property
    def is_live(self) -> bool:
        """Whether the app applies a change of the setting immediately; otherwise at its next start."""
        return self.section is not Section.SIMULATION and self.at_once

    def save(self, value: Scalar | None) -> None:
        """Change the setting in `config.toml`, which is created if necessary; comments and all else in it are kept.

        Args:
            value: Its new value; None to remove it.

        Raises:
            ConfigError: the value is wrong, or the file is no TOML or cannot be read or written. The file is unchanged.
        """
        path = find_config_file()
        text = read_config_text(path)
        # If the file is not TOML, this raises an error, so that its contents are not overwritten.
        parse_config(text, path)
        changed = _change(text, self, value)
        wrong = [error for error in parse_config(changed, path).problems if error.key == self.path]
        if wrong:
            raise ConfigError(wrong[0].message.removeprefix(f"{path}: "), wrong[0].hint)
        _write(path, changed)


def _build_option_settings() -> Iterator[Setting]:
    for option in OPTIONS:
        if option.value.in_config and option.constant is not False:
            section = Section.APP if option.path in APP_PATHS else Section.SIMULATION
            default = toml_form(option.value, option.default)
            yield Setting(section, option.name, option.value, default, option.path, option.is_live)


THEME = f"{Section.APP}.theme"
CELL_SET = f"{Section.APP}.cells"
"""Paths of settings that are read by themselves."""
_THEME = Name("the name of a theme", "THEME", help="colours of the app; F10 lists the themes")
_EVERY = (*_build_option_settings(), Setting(Section.APP, "theme", _THEME, "textual-dark"))
SETTINGS: Mapping[str, Setting] = {
    one.path: one for section in Section for one in _EVERY if one.section is section
}
"""Every setting by its path, in the order of the file."""


@dataclass(frozen=True, slots=True)
class UserConfig:
    """The contents of `config.toml`: the settings in it, and its faults."""

    path: Path
    written: Mapping[str, Scalar] = field(default_factory=dict)
    """The valid values, by path of the setting."""
    values: Mapping[str, Any] = field(default_factory=dict)
    """The valid values as settings, by path of the setting."""
    keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """The keys of actions by id, as they are written; whether they fit the actions is not checked."""
    problems: tuple[ConfigError, ...] = ()
    """The faults; wrong entries count as missing."""

    def checked(self) -> UserConfig:
        """Return the configuration itself if it has no faults.

        Raises:
            ConfigError: the first fault.
        """
        if self.problems:
            raise self.problems[0]
        return self

    def value(self, path: str) -> Scalar:
        """Return the value of a setting in the file, or the setting's default."""
        return self.written.get(path, SETTINGS[path].default)

    def layer(self, section: Section) -> dict[str, Any]:
        """Return the settings of a table of the file by path, as a layer for `Settings.merge`.

        The setting of the glyphs is left out, because it depends on the terminal.
        """
        return {
            setting.sets: self.values[path]
            for path, setting in SETTINGS.items()
            if setting.section is section
            and setting.sets
            and path in self.values
            and path != CELL_SET
        }

    def keep_section(self, section: Section) -> UserConfig:
        """Return a copy of the configuration that has only the settings of the table `section`."""
        return replace(
            self,
            written={
                path: value
                for path, value in self.written.items()
                if SETTINGS[path].section is section
            },
            values={
                path: value
                for path, value in self.values.items()
                if SETTINGS[path].section is section
            },
        )

    def list_effective(self, *above: Mapping[str, Any]) -> list[str]:
        """Return a line `NAME = VALUE` for each setting of `[simulation]` in the file that no other layer sets.

        Args:
            above: The layers that take precedence over the file, such as the command line: settings by path.
        """
        return [
            f"{setting.name} = {quote(self.written[path])}"
            for path, setting in SETTINGS.items()
            if setting.section is Section.SIMULATION
            and path in self.written
            and not any(setting.sets in layer for layer in above)
        ]

    @classmethod
    def load(cls) -> UserConfig:
        """Return the configuration in `config.toml`, with its faults in `problems`; defaults if it is missing."""
        path = find_config_file()
        try:
            stamp = path.stat()
        except OSError:
            return cls(path)
        return _load(path, stamp.st_mtime_ns, stamp.st_size)


def find_config_file() -> Path:
    """Return the path of `config.toml`; the file may not exist."""
    return config_folder() / FILE


@lru_cache(maxsize=1)
def _load(path: Path, _changed_ns: int, _size: int) -> UserConfig:
    # The result is cached, as the app reads the file several times at its start.
    try:
        return parse_config(read_config_text(path), path)
    except ConfigError as error:
        return UserConfig(path, problems=(error,))


def read_config_text(path: Path) -> str:
    """Return the text of `config.toml`, empty if the file does not exist.

    Raises:
        ConfigError: the file cannot be read.
    """
    try:
        return read_regular(path, MAX_FILE_BYTES, follow_links=True).decode()
    except FileNotFoundError:
        return ""
    except UnicodeDecodeError:
        raise ConfigError("is not text in UTF-8", file=str(path)) from None
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(path)) from None


def parse_config(text: str, path: Path) -> UserConfig:
    """Return the configuration in a text; faults other than TOML syntax are in its `problems`.

    Args:
        text: The contents of `config.toml`.
        path: The file, for errors; paths in it are relative to its folder.

    Raises:
        ConfigError: the text is not TOML.
    """
    data = parse_toml(text, str(path), ConfigError)
    location = Location(str(path))
    problems: list[ConfigError] = []
    written: dict[str, Scalar] = {}
    values: dict[str, Any] = {}
    keys: dict[str, tuple[str, ...]] = {}
    for name, value, here in _parse_entries(data, location, problems):
        try:
            if here.key.startswith(f"{Section.KEYS}."):
                keys[name] = _parse_keys(value, here)
            else:
                setting = SETTINGS[here.key]
                written[here.key], values[here.key] = (
                    value,
                    _resolve(setting, read_value(value, setting.value, here), path),
                )
        except ConfigError as error:
            problems.append(error)
    if Section.SIMULATION in data:
        problems += list(_drop_wrong_names(written, values, location))
    return UserConfig(path, written, values, keys, tuple(problems))


def _parse_entries(
    data: Any, location: Location, problems: list[ConfigError]
) -> Iterator[tuple[str, Any, Location]]:
    """Yield name, value and location of each known setting in a file.

    Add an error to `problems` for each unknown one.
    """
    names = {
        section: [setting.name for setting in SETTINGS.values() if setting.section is section]
        for section in Section
    }
    for section, content in data.items():
        here = location.at(section)
        try:
            if section not in names:
                raise here.wrong(
                    "no such table", f"{_build_hint(section, names)}; {see_page(PAGE)}"
                )
            table(content, here)
        except ConfigError as error:
            problems.append(error)
            continue
        for name, value in content.items():
            if section != Section.KEYS and name not in names[section]:
                problems.append(
                    here.at(name).wrong("no such setting", _build_hint(name, names[section]))
                )
            else:
                yield name, value, here.at(name)


def _build_hint(name: str, known: Any) -> str:
    """Return the hint for a name that is unknown in its table.

    If another table has a setting of that name, the hint names this table; else the names in `known` that are similar.
    """
    elsewhere = [setting.section for setting in SETTINGS.values() if setting.name == name]
    return f"it belongs into [{elsewhere[0]}]" if elsewhere else nearest(name, known)


def _parse_keys(value: object, location: Location) -> tuple[str, ...]:
    listed = value if isinstance(value, list) else [value]
    if (
        not listed
        or len(listed) > MAX_KEYS
        or not all(isinstance(key, str) and key for key in listed)
    ):
        raise location.wrong(
            f"must be a key or a list of keys, got {quote(value)}",
            'such as "x" or ["ctrl+x", "f5"]',
        )
    return tuple(listed)


_NAMES = ("mats", "background", "robot", "obstacles", "profile")
"""Settings that are names or paths; `mats` first, since the mat may be in there."""


def _resolve(setting: Setting, value: Any, path: Path) -> Any:
    """Return the value of a setting as it is used: a path is made relative to the folder of `config.toml`.

    Any other value is returned unchanged.

    Args:
        setting: The setting.
        value: The value in the file.
        path: The path of `config.toml`.
    """
    if setting.name not in _NAMES:
        return value
    word = user_path(value)
    is_path = (
        setting.name == "mats"
        or means_file(value)
        or (setting.name == "background" and bool(word.suffix))
    )
    return str(path.parent / word) if is_path else value


def _drop_wrong_names(
    written: dict[str, Scalar], values: dict[str, Any], location: Location
) -> Iterator[ConfigError]:
    """Remove names of mats, robots, obstacles and profiles that do not exist; yield an error for each.

    Args:
        written: The values as they are in the file, by name.
        values: The values with resolved paths, by name.
        location: The file, for errors.
    """
    from tuisim.settings.build import build_run_spec

    for name in _NAMES:
        path = f"{Section.SIMULATION}.{name}"
        if path not in values:
            continue
        try:
            build_run_spec(
                Settings({"mats": values.get(f"{Section.SIMULATION}.mats"), name: values[path]})
            )
        except ConfigError as error:
            del written[path], values[path]
            where = "" if error.file else f"{error.key}: "
            yield location.at(path).wrong(error.message.removeprefix(where), error.hint)


_WIDTH = 100
_KEYS = ('run = ["x", "f5"]', 'theme = "ctrl+y"')
"""Examples of remapped keys."""


def build_template() -> str:
    """Return the text of a `config.toml` with every setting and its default as a comment."""
    lines = [
        f"# Your defaults for tuisim: {see_page(PAGE)}. Remove a # to make a setting your own."
    ]
    for section in Section:
        lines += ["", *_format_comment(ABOUT[section]), f"[{section}]"]
        for setting in SETTINGS.values():
            if setting.section is section:
                lines += _format_comment(setting.help)
                lines.append(f"#{setting.name} = {toml_value(setting.default)}")
        if section is Section.KEYS:
            lines += [f"#{example}" for example in _KEYS]
    return "\n".join(lines) + "\n"


def _format_comment(text: str) -> list[str]:
    return [f"# {line}" for line in wrap(text, _WIDTH)]


def write_template() -> Path:
    """Write a `config.toml` with every setting as a comment, and return its path.

    Raises:
        ConfigError: the file exists already, or cannot be written.
    """
    path = find_config_file()
    if path.exists() or path.is_symlink():
        raise ConfigError("exists already", "to start again, delete it first", file=str(path))
    _write(path, build_template())
    return path


def _change(text: str, setting: Setting, value: Scalar | None) -> str:
    import tomlkit

    document: Any = tomlkit.parse(_uncomment(text, setting, value) if value is not None else text)
    if value is not None:
        if setting.section not in document:
            document[setting.section.value] = tomlkit.table()
        document[setting.section.value][setting.name] = value
    elif setting.name in document.get(setting.section.value, {}):
        del document[setting.section.value][setting.name]
    return tomlkit.dumps(document)


def _uncomment(text: str, setting: Setting, value: Scalar) -> str:
    """Return the text of `config.toml` with a setting in place of its comment.

    If the setting is in its table already, the text is unchanged.

    Args:
        text: The text.
        setting: The setting.
        value: The value that it gets.
    """
    head, header, rest = text.partition(f"[{setting.section}]\n")
    body, next_header, after = rest.partition("\n[")
    if re.search(rf"^{setting.name}\b", body, re.MULTILINE):
        return text
    line = f"{setting.name} = {toml_value(value)}"
    body = re.sub(rf"^#{setting.name} = .*$", lambda _: line, body, count=1, flags=re.MULTILINE)
    return head + header + body + next_header + after


def _write(path: Path, text: str) -> None:
    try:
        make_private_folder(path.parent)
        with replacing(path, owner_only=True) as file:
            file.write(text.encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None


def config_folder() -> Path:
    """Return the folder of `config.toml`: `TUISIM_HOME`, or the platform's folder for the user's configuration."""
    if home := os.environ.get("TUISIM_HOME"):
        return Path(home)
    import platformdirs

    return platformdirs.user_config_path("tuisim")
