"""`tuisim config`, and where its settings apply."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.app import app as lab_app
from tuisim.commands import app as app_command
from tuisim.engine.runs.store import RunStore

PROGRAM = "print('Colour: 1')\n"
WORLD = 'background = "Loop"\n'


@pytest.fixture
def config(home: Path) -> Path:
    home.mkdir()
    return home / "config.toml"


def test_config_lists_every_setting_with_its_source(config: Path, here: Command) -> None:
    config.write_text("[app]\nquiet = true\n[keys]\nrun = 'f5'\n")

    done = json.loads(here("config", "--json").stdout)
    lines = here("config").stdout.splitlines()

    assert (done["file"], lines[0]) == (str(config), str(config))
    sources = {one["setting"]: (one["value"], one["from"]) for one in done["settings"]}
    assert sources["app.quiet"] == (True, "config.toml")
    assert sources["app.fps"] == (20, "default")
    # Whether there are walls is the program's to say.
    assert sources["simulation.walls"] == (True, "default, or from the program")
    assert sources["keys.run"] == ("f5", "config.toml")
    assert ["app.quiet", "true", "config.toml"] in [line.split() for line in lines]


def test_config_init_never_overwrites_an_existing_file(config: Path, here: Command) -> None:
    assert here("config", "--init").returncode == 0
    text = config.read_text()
    again = here("config", "--init")

    assert (again.returncode, config.read_text()) == (2, text)
    assert f"{config}: exists already" in again.stderr


def test_config_that_would_change_a_setting_names_the_file(here: Command) -> None:
    done = here("config", "set", "speed", "fast")
    assert (done.returncode, done.stdout) == (2, "")
    assert "config set speed fast: this command changes no setting" in done.stderr
    assert "change the setting there" in done.stderr


@cases(
    "text, problem",
    {
        "a value": ("[app]\nfps = 0", "app.fps: must be a whole number from 1 to 60"),
        "a theme": (
            "[app]\ntheme = 'lite'",
            "app.theme: no such theme 'lite' (did you mean light?)",
        ),
        "an action": ("[keys]\nrnu = 'x'", "keys.rnu: no such action (did you mean run"),
        "a key": ("[keys]\nrun = 'hyper+x'", "keys.run: no such key 'hyper+x' (a character"),
        "a key that stays": ("[keys]\nrun = 'esc'", "keys.run: esc leaves a field and cannot"),
        "the same in a terminal": ("[keys]\nrun = 'ctrl+i'", "keys.run: ctrl+i goes to the next"),
        "taken": ("[keys]\nrun = 'S'", "keys.run: S is also the key of stop (Stop the program)"),
        "both new": (
            "[keys]\nrun = 'f5'\nstop = ['S', 'f5']",
            "keys.stop: F5 is also the key of run",
        ),
    },
)
def test_a_wrong_config_file_ends_the_command_in_one_line(
    text: str, problem: str, config: Path, here: Command
) -> None:
    config.write_text(text)

    done = here("config")

    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert f"tuisim: {config}: {problem}" in done.stderr


@cases(
    "words, noise",
    {
        "applies": (["p.py"], 7),
        "a switch is above": (["p.py", "-M", "0"], 0),
        "a magic line is above": (["magic.py"], 3),
        "not in a world": (["--world", "w.toml", "p.py"], 0),
    },
)
def test_a_run_says_which_settings_of_the_user_it_takes(
    words: list[str], noise: int, config: Path, tmp_path: Path, here: Command
) -> None:
    config.write_text("[simulation]\nmotornoise = 7\n[app]\nspeed = 0.01\n")
    (tmp_path / "p.py").write_text(PROGRAM)
    (tmp_path / "magic.py").write_text(f"# %%sim_magic -M 3\n{PROGRAM}")
    (tmp_path / "w.toml").write_text(WORLD)

    done = here("run", *words)

    assert done.returncode == 0
    assert ("note: from config.toml: motornoise = 7" in done.stderr) == (noise == 7)
    assert RunStore().load_run("last").spec.world.noise.motor == noise


def test_a_run_does_not_mention_user_settings_that_equal_the_defaults(
    config: Path, tmp_path: Path, here: Command
) -> None:
    config.write_text("[simulation]\nmotornoise = 0\nprofile = 'robolab'\n")
    (tmp_path / "p.py").write_text(PROGRAM)

    assert "note" not in here("run", "p.py").stderr


def test_run_refuses_a_faulty_config_file(config: Path, tmp_path: Path, here: Command) -> None:
    config.write_text("[simulation]\nmotornoise = -1\n")
    (tmp_path / "p.py").write_text(PROGRAM)

    done = here("run", "p.py")
    assert (done.returncode, done.stdout) == (2, "")
    assert "simulation.motornoise: must be" in done.stderr


@pytest.mark.slow
def test_a_batch_ignores_the_settings_of_the_user(
    config: Path, tmp_path: Path, here: Command
) -> None:
    config.write_text("[simulation]\nmotornoise = 'wrong'\n")
    (tmp_path / "p.py").write_text(PROGRAM)
    assert here("batch", "p.py", "--seeds", "0..1").returncode == 0


@cases(
    "words, noise",
    {
        "a program": (["open", "p.py"], 7),
        "nothing": (["open"], 7),
        "a world": (["open", "w.toml"], 0),
        "goals": (["open", "--goals", "log_greys_goals.toml", "p.py"], 0),
        "a lesson": (["learn", "first-run"], 0),
    },
)
def test_the_app_opens_with_the_settings(
    words: list[str],
    noise: int,
    config: Path,
    tmp_path: Path,
    here: Command,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    config.write_text("[simulation]\nmotornoise = 7\n[app]\nspeed = 2\nfps = 5\nwrong = 1\n")
    (tmp_path / "p.py").write_text(PROGRAM)
    (tmp_path / "w.toml").write_text(WORLD)
    opened: list[Any] = []

    def run_app(settings: Any) -> int:
        opened.append(settings)
        return 0

    monkeypatch.setattr(lab_app, "run_app", run_app)
    monkeypatch.setattr(app_command, "has_terminal", lambda: True)

    here(*words)

    (settings,) = opened
    assert (settings.spec.world.noise.motor, settings.speed, settings.fps) == (noise, 2.0, 5)
    assert settings.from_config == (("motornoise = 7",) if noise else ())
