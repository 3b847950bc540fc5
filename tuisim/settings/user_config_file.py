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
    config_file,
    config_of_text,
    config_text,
)

_WIDTH = 100
_KEYS = ('run = ["x", "f5"]', 'theme = "ctrl+y"')
"""Examples of remapped keys."""


def template() -> str:
    """Return a file with every setting as it is without the file, in comments."""
    lines = [
        f"# Your defaults for tuisim: {see_page(PAGE)}. Remove a # to make a setting your own."
    ]
    for section in Section:
        lines += ["", *_comment(ABOUT[section]), f"[{section}]"]
        for one in SETTINGS.values():
            if one.section is section:
                lines += _comment(one.help)
                lines.append(f"#{one.name} = {toml_value(one.default)}")
        if section is Section.KEYS:
            lines += [f"#{example}" for example in _KEYS]
    return "\n".join(lines) + "\n"


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in wrap(text, _WIDTH)]


def write_template() -> Path:
    """Write the file, and return its path.

    Raises:
        ConfigError: it exists, or cannot be written.
    """
    path = config_file()
    if path.exists() or path.is_symlink():
        raise ConfigError("exists already", "to start again, delete it first", file=str(path))
    _write(path, template())
    return path


def save_setting(one: Setting, value: Scalar | None) -> None:
    """Set a setting in the file, which is made if it does not exist; comments and everything else in it stay.

    Args:
        one: The setting.
        value: None to remove it.

    Raises:
        ConfigError: the value is wrong, or the file is no TOML or cannot be read or written. It is unchanged.
    """
    path = config_file()
    text = config_text(path)
    # Not TOML: what is in it would be lost.
    config_of_text(text, path)
    changed = _changed(text, one, value)
    wrong = [error for error in config_of_text(changed, path).problems if error.key == one.path]
    if wrong:
        raise ConfigError(wrong[0].message.removeprefix(f"{path}: "), wrong[0].hint)
    _write(path, changed)


def _changed(text: str, one: Setting, value: Scalar | None) -> str:
    import tomlkit

    document: Any = tomlkit.parse(_uncommented(text, one, value) if value is not None else text)
    if value is not None:
        if one.section not in document:
            document[one.section.value] = tomlkit.table()
        document[one.section.value][one.name] = value
    elif one.name in document.get(one.section.value, {}):
        del document[one.section.value][one.name]
    return tomlkit.dumps(document)


def _uncommented(text: str, one: Setting, value: Scalar) -> str:
    """Return the text with the setting in place of its comment as `template` writes it, if it has only that."""
    head, header, rest = text.partition(f"[{one.section}]\n")
    body, next_header, after = rest.partition("\n[")
    if re.search(rf"^{one.name}\b", body, re.MULTILINE):
        return text
    line = f"{one.name} = {toml_value(value)}"
    body = re.sub(rf"^#{one.name} = .*$", lambda _: line, body, count=1, flags=re.MULTILINE)
    return head + header + body + next_header + after


def _write(path: Path, text: str) -> None:
    try:
        make_private_folder(path.parent)
        with replacing(path, owner_only=True) as file:
            file.write(text.encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None
