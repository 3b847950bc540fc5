"""Where a log comes from, and the notes that are kept with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.analyser.logs import long_log, model_of
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import (
    LogRequest,
    Note,
    OpenedLog,
    find_notes_file,
    read_notes,
    write_notes,
)
from tuisim.base.errors import LogError


def test_notes_on_a_log_file_are_found_when_it_is_opened_again(tmp_path: Path, home: Path) -> None:
    file = tmp_path / "log.csv"
    file.write_text("time,value\n0,1\n")
    opened = OpenedLog(LogRequest(file=str(file)), long_log())
    model = AnalysisModel(opened)
    model.add_note("second", 2.0, 3.0, "Colour", 0)
    model.add_note("first", 1.0, 1.0, "", 0)
    assert [note.text for _, note in AnalysisModel(opened).notes] == ["first", "second"]
    file.write_text("time,value\n0,1\n1,2\n")
    assert len(AnalysisModel(opened).notes) == 2
    model.drop_note(*model.notes[0])
    assert [note.text for _, note in AnalysisModel(opened).notes] == ["second"]
    assert [path.parent for path in home.rglob("*.jsonl")] == [home / "notes"]


def test_a_log_from_a_pipe_keeps_no_notes() -> None:
    with pytest.raises(LogError, match="cannot be stored"):
        model_of(long_log()).add_note("text", 0.0, 0.0, "", 0)


def test_a_damaged_file_of_notes_is_refused_with_its_row(tmp_path: Path) -> None:
    place = tmp_path / "notes.jsonl"
    write_notes(place, [Note("ü\nx", 0.5, 1.5, "Colour")])
    assert read_notes(place) == (Note("ü\nx", 0.5, 1.5, "Colour"),)
    place.write_bytes(place.read_bytes() + b"{}\n")
    with pytest.raises(LogError, match="not a note") as caught:
        read_notes(place)
    assert "2" in str(caught.value)


def test_notes_of_a_missing_file_are_said(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        find_notes_file(tmp_path / "none.csv")
