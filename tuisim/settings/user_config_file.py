"""Writing `config.toml`: the commented file with everything in it, and a change of one setting."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import wrap
from typing import Any

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.errors import ConfigError, see_page
from tuisim.engine.files import Scalar, toml_value
from tuisim.settings.user_config import (
    ABOUT,
    PAGE,
    SETTINGS,
    Section,
    Setting,
    find_config_file,
    parse_config,
    read_config_text,
)

_WIDTH = 100
_KEYS = ('run = ["x", "f5"]', 'theme = "ctrl+y"')
"""Examples of remapped keys."""


def build_template() -> str:
    """Return the text of a `config.toml` with every setting at its default, in comments."""
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
    """Write `config.toml` with every setting in comments, and return its path.

    Raises:
        ConfigError: it exists, or cannot be written.
    """
    path = find_config_file()
    if path.exists() or path.is_symlink():
        raise ConfigError("exists already", "to start again, delete it first", file=str(path))
    _write(path, build_template())
    return path


def save_setting(setting: Setting, value: Scalar | None) -> None:
    """Set a setting in the file, which is made if it does not exist; comments and everything else in it stay.

    Args:
        setting: The setting.
        value: None to remove it.

    Raises:
        ConfigError: the value is wrong, or the file is no TOML or cannot be read or written. It is unchanged.
    """
    path = find_config_file()
    text = read_config_text(path)
    # Not TOML: what is in it would be lost.
    parse_config(text, path)
    changed = _change(text, setting, value)
    wrong = [error for error in parse_config(changed, path).problems if error.key == setting.path]
    if wrong:
        raise ConfigError(wrong[0].message.removeprefix(f"{path}: "), wrong[0].hint)
    _write(path, changed)


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
    """Return the text with a setting in place of its comment, if the table does not have the setting yet."""
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
