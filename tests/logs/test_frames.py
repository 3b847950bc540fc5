"""`read_log`: exports as they were written, and files from elsewhere with the choices of the commands."""

from __future__ import annotations

import warnings
from dataclasses import fields
from inspect import signature
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pandas
import pytest

from tests.cases import cases
from tuisim.base.errors import LogError
from tuisim.commands.log import COLUMNS
from tuisim.logs import frames
from tuisim.logs.choices import WORDS, ReadChoices
from tuisim.logs.frames import read_log

FOREIGN = "a_title\nZeit;rot;blau;Wort\n100;1,5;5;a\n200;2,5;6;b\n300;3,5;7;c\n"


def test_read_log_takes_files_from_elsewhere(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FOREIGN)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        frame = read_log(path)
    assert {str(warning.message) for warning in caught} == {
        f"{path}: 1 line above the table not read (line 1)",
        f"{path}: text, not numbers: 'Wort'",
        f"{path}: the times in 'Zeit' are whole numbers in large steps: read as milliseconds (unit= selects another)",
    }
    assert (frame.index.name, frame.index.tolist()) == ("time_s", [0.1, 0.2, 0.3])
    assert frame.to_dict("list") == {
        "Zeit": [100, 200, 300],
        "rot": [1.5, 2.5, 3.5],
        "blau": [5, 6, 7],
        "Wort": ["a", "b", "c"],
    }


def test_read_log_does_not_use_line_numbers_as_times(tmp_path: Path) -> None:
    (path := tmp_path / "a.txt").write_text("Light: 12\nfoo\nLight: 13\n")
    with pytest.warns(UserWarning, match="not a sample"):
        frame = read_log(path)
    assert (frame.index.name, frame.index.tolist()) == (None, [0, 1])
    assert (frame["row"].tolist(), frame["value"].tolist()) == ([1, 3], [12, 13])


@pytest.mark.filterwarnings("ignore::UserWarning")
@cases(
    "choices, columns, times_s",
    {
        "time and unit": (
            {"time": "blau", "unit": "ms"},
            "Zeit rot blau Wort",
            [0.005, 0.006, 0.007],
        ),
        "a value": ({"value": ["rot"]}, "Zeit rot", [0.1, 0.2, 0.3]),
        "a value as a text": ({"value": "rot"}, "Zeit rot", [0.1, 0.2, 0.3]),
        "rows": ({"time": ""}, "Zeit rot blau Wort", [0, 1, 2]),
        "a heading": ({"header": 3, "time": ""}, "100 1,5 5 a", [0, 1]),
        "a separator": ({"separator": "comma", "time": ""}, "100;1 5;5;a", [0, 1]),
        "a decimal sign": ({"decimal": ",", "time": "rot"}, "Zeit rot blau Wort", [1.5, 2.5, 3.5]),
        "an encoding": ({"encoding": "utf-8", "time": ""}, "Zeit rot blau Wort", [0, 1, 2]),
    },
)
def test_read_log_takes_the_choices_of_the_commands(
    tmp_path: Path, choices: dict[str, Any], columns: str, times_s: list[float]
) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FOREIGN)
    frame = read_log(path, **choices)
    assert (list(frame), frame.index.tolist()) == (columns.split(" "), times_s)


@cases(
    "choices, message",
    {
        "separator": ({"separator": ";"}, "no separator ';'"),
        "decimal": ({"decimal": "point"}, "no decimal 'point'"),
        "unit": ({"unit": "hours"}, "no unit 'hours'"),
        "header": ({"header": 99}, "no line 99 for header="),
        "table": ({"table": 2}, "table= takes 1 to 1"),
        "encoding": ({"encoding": "none"}, "no encoding 'none'"),
        "encoding of no text": ({"encoding": "hex"}, "no encoding 'hex'"),
        "encoding of text only": ({"encoding": "rot13"}, "no encoding 'rot13'"),
        "encoding that is no text": ({"encoding": "\udcff"}, "no encoding"),
        "time": ({"time": "zeit"}, "no column 'zeit'"),
    },
)
def test_read_log_refuses_wrong_choices_with_a_reason(
    tmp_path: Path, choices: dict[str, Any], message: str
) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FOREIGN)
    with pytest.raises(LogError, match=message):
        read_log(path, **choices)


def test_read_log_has_the_options_of_the_commands() -> None:
    names = {option.name for option in COLUMNS}
    assert set(signature(read_log).parameters) - {"path"} == names
    assert {field.name for field in fields(ReadChoices)} == names


def test_type_hints_of_read_log_list_the_words_of_each_choice() -> None:
    types = get_type_hints(read_log, {**vars(frames), "pd": pandas})
    assert {name: get_args(types[name]) for name in WORDS} == {
        name: ("", *words) for name, words in WORDS.items()
    }
