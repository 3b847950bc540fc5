"""What one may go on with: unsaved texts first, then programs that are still there, then runs."""

from __future__ import annotations

from pathlib import Path

from tests.running import over
from tuisim.app.editor.text_file import drop_draft, keep_draft
from tuisim.app.setup.recent import Kind, list_recent
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings


def kinds() -> list[tuple[Kind, str]]:
    return [(one.kind, one.name) for one in list_recent("new.py")]


def test_a_new_home_offers_no_recent_programs_or_runs() -> None:
    assert kinds() == []


def test_a_start_offers_unsaved_texts_before_programs_and_runs(tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    path.write_text("import time\ntime.sleep(0.1)\n")
    spec = build_run_spec(Settings())
    over(start_run(Program("mine.py", path.read_text(), "none", str(path)), spec, RunOptions()))
    assert kinds() == [(Kind.PROGRAM, "mine.py"), (Kind.RUN, "Run 1")]
    keep_draft("", "x")
    keep_draft(str(path), "y")
    assert kinds() == [(Kind.DRAFT, "mine.py"), (Kind.DRAFT, "new.py"), (Kind.RUN, "Run 1")]
    drop_draft(str(path))
    path.unlink()
    assert kinds() == [(Kind.DRAFT, "new.py"), (Kind.RUN, "Run 1")]


def test_an_unsaved_text_says_in_which_folder_it_belongs(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text("print(1)\n")
    keep_draft("", "x")
    keep_draft(str(tmp_path / "mine.py"), "y")
    titles = [one.title for one in list_recent("new.py")]
    assert [title.endswith(f", in {tmp_path}") for title in titles] == [True, False]


def test_a_start_offers_five_recent_things_and_always_the_last_run(tmp_path: Path) -> None:
    for number in range(4):
        path = tmp_path / f"{number}.py"
        path.write_text("import time\ntime.sleep(0.1)\n")
        over(
            start_run(
                Program(path.name, path.read_text(), "none", str(path)),
                build_run_spec(Settings()),
                RunOptions(),
            )
        )
    assert [name for _, name in kinds()] == ["3.py", "2.py", "1.py", "Run 4", "Run 3"]
    keep_draft("", "x")
    keep_draft(str(tmp_path / "0.py"), "y")
    assert [name for _, name in kinds()] == ["0.py", "new.py", "3.py", "2.py", "Run 4"]
