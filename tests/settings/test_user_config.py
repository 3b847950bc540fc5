"""`config.toml`: what is in it, what is wrong in it, and how it is written."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from tests.cases import for_rows
from tests.conftest import ROOT
from tuisim.base.errors import ConfigError
from tuisim.settings.user_config import (
    SETTINGS,
    Section,
    UserConfig,
    build_template,
    find_config_file,
    parse_config,
    write_template,
)

PATH = Path("config.toml")


@pytest.fixture(autouse=True)
def _home(home: Path) -> None:
    """Each test has its own file."""


@for_rows(
    "text, problem",
    {
        "no table": ("fps = 20", "fps: no such table (it belongs into [app]; see `tuisim guide s"),
        "no table but a value": ("app = 3", "app: must be a table of keys and values, got 3"),
        "another table": ("[apps]", "apps: no such table (did you mean app?"),
        "another name": (
            "[app]\nthem = 'light'",
            "app.them: no such setting (did you mean theme?)",
        ),
        "in the wrong table": ("[simulation]\nspeed = 2", "(it belongs into [app])"),
        "no boolean": ("[app]\nquiet = 1", "app.quiet: must be true or false, got 1"),
        "a switch's word": ("[simulation]\nwalls = 'on'", "walls: must be true or false, got 'on'"),
        "no number": ("[app]\nfps = '20'", "fps: must be a whole number from 1 to 60, got '20'"),
        "too high": ("[app]\nfps = 61", "fps: must be a whole number from 1 to 60"),
        "not 1": ("[app]\nfps = true", "fps: must be a whole number from 1 to 60, got true"),
        "another word": ("[app]\nspeed = 'fast'", "speed: must be max, or a number"),
        "none of the words": (
            "[app]\ncells = 'oct'",
            "cells: no such value 'oct' (one of auto, half",
        ),
        "no robot": ("[simulation]\nrobot = 'Foo'", "robot: no such robot 'Foo' (one of Default"),
        "no mat": ("[simulation]\nbackground = 'Lop'", "no such mat 'Lop' (did you mean Loop?"),
        "no file": ("[simulation]\nprofile = 'p.toml'", "simulation.profile: "),
        "no colour": (
            "[simulation]\npencolor = 'gren'",
            "no such colour 'gren' (did you mean green",
        ),
        "no key": ("[keys]\nrun = 3", "keys.run: must be a key or a list of keys, got 3"),
        "no keys": ("[keys]\nrun = []", "keys.run: must be a key or a list of keys, got []"),
    },
)
def test_a_wrong_setting_in_the_config_file_is_named_and_ignored(text: str, problem: str) -> None:
    found = parse_config(f"{text}\n", PATH)

    (error,) = map(str, found.problems)
    assert error.startswith("config.toml: ")
    assert problem in error
    assert dict(found.written) == {}
    with pytest.raises(ConfigError):
        found.checked()


@pytest.mark.parametrize(
    "content",
    [b"[app", b"\xff", b"[app]\nfps = 1\nfps = 2\n"],
    ids=["cut off", "no UTF-8", "twice"],
)
def test_a_damaged_config_file_is_told_and_never_overwritten(content: bytes) -> None:
    find_config_file().parent.mkdir(parents=True, exist_ok=True)
    find_config_file().write_bytes(content)

    assert len(UserConfig.load().problems) == 1
    with pytest.raises(ConfigError, match=re.escape(str(find_config_file()))):
        SETTINGS["app.theme"].save("light")
    assert find_config_file().read_bytes() == content


def test_the_template_has_every_setting_and_sets_nothing() -> None:
    assert dict(parse_config(build_template(), PATH).written) == {}
    # Every comment of a setting, taken out, sets what is usual.
    active = re.sub(r"^#(\w+ = (?!\"\"))", r"\1", build_template(), flags=re.MULTILINE)
    found = parse_config(active, PATH)
    assert found.problems == ()
    usual = {path: one.default for path, one in SETTINGS.items() if one.default != ""}
    assert dict(found.written) == usual


def test_writing_the_config_template_never_replaces_an_existing_file() -> None:
    find_config_file().parent.mkdir(parents=True, exist_ok=True)
    find_config_file().write_text("# mine\n")

    with pytest.raises(ConfigError, match="exists already"):
        write_template()
    assert find_config_file().read_text() == "# mine\n"


@pytest.mark.parametrize("path", SETTINGS)
def test_a_setting_is_written_in_place_of_its_comment_and_removed_again(path: str) -> None:
    one = SETTINGS[path]
    value = {"mats": ".", "obstacles": "default", "pencolor": "red"}.get(one.name, one.default)
    if one.name == "obstacles":
        from tuisim.engine.obstacles import OBSTACLES

        value = next(iter(OBSTACLES))
    before = write_template().read_text()

    one.save(value)
    after = find_config_file().read_text()
    assert dict(UserConfig.load().written) == {path: value}
    assert len(after.splitlines()) == len(before.splitlines())
    assert (
        sum(old != new for old, new in zip(before.splitlines(), after.splitlines(), strict=True))
        == 1
    )

    one.save(None)
    assert dict(UserConfig.load().written) == {}


def test_a_change_keeps_comments_and_what_else_is_in_the_file() -> None:
    find_config_file().parent.mkdir(parents=True, exist_ok=True)
    find_config_file().write_text("# mine\n[app]\nfps = 30 # slow link\nwrong = 1\n")

    SETTINGS["app.fps"].save(10)
    SETTINGS["simulation.robot"].save("Small_Robot")

    text = find_config_file().read_text()
    assert text.startswith("# mine\n[app]\nfps = 10 # slow link\nwrong = 1\n")
    assert tomllib.loads(text)["simulation"] == {"robot": "Small_Robot"}


def test_a_wrong_value_is_not_written_into_the_config_file() -> None:
    with pytest.raises(ConfigError, match=r"app\.fps: must be a whole number"):
        SETTINGS["app.fps"].save(100)
    assert not find_config_file().exists()


def test_a_path_in_the_config_file_is_relative_to_its_folder() -> None:
    find_config_file().parent.mkdir(parents=True, exist_ok=True)
    (find_config_file().parent / "mats").mkdir()
    find_config_file().write_text("[simulation]\nmats = 'mats'\n")

    assert UserConfig.load().values["simulation.mats"] == str(find_config_file().parent / "mats")


def test_the_guides_example_of_a_config_file_is_valid() -> None:
    page = (ROOT / "tuisim" / "guide" / "pages" / "settings.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)

    found = parse_config(example, PATH).checked()
    assert found.keys == {"run": ("x", "f5")}


def test_user_settings_are_listed_section_by_section() -> None:
    sections = [setting.section for setting in SETTINGS.values()]
    assert sections == sorted(sections, key=list(Section).index)
