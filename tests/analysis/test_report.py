"""`tuisim log report`: one page that holds everything, of runs and of files."""

from __future__ import annotations

import base64
import io
import re
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from html.parser import HTMLParser
from pathlib import Path
from shutil import copytree

import pytest
from PIL import Image

from tests.cases import cases
from tests.conftest import Command
from tuisim.analysis.report import MAX_STATISTICS, list_run_facts
from tuisim.analysis.source import NOTES_FILE, Note, find_notes_file, write_notes
from tuisim.cli import run_command
from tuisim.engine.core.tree import put
from tuisim.engine.protocol import End
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.options import RUN_VALUES

VOID = {"meta", "img", "br", "link", "input"}
PROGRAM = """# %%sim_magic_preloaded -b Grey_bands
# </script><script>alert(1)</script> &amp; "ünï" \x0c \u2028 日本
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 5:
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    print('Way_mm: ' + str(tank_drive.left_motor.position))
    time.sleep(0.1)
tank_drive.off()
print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
"""


class Page(HTMLParser):
    """What stands in a page, as a browser would read it; every tag must be closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.words: list[str] = []
        self.section: dict[str, list[str]] = {}
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "h2":
            self.section[data] = []
        elif self.section and data.strip():
            next(reversed(self.section.values())).append(data)
        if data.strip() and self.open[-1:] != ["style"]:
            self.words.append(data)


@dataclass(frozen=True)
class Driven:
    """A run and the page about it."""

    run: StoredRun
    page: Page


def page_of(path: Path) -> Page:
    return Page(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """A run whose program is hostile, with a note, and its page."""
    folder = tmp_path_factory.mktemp("driven")
    program = folder / "greys.py"
    target = folder / "page.html"
    program.write_text(PROGRAM, encoding="utf-8")
    with redirect_stdout(io.StringIO()):
        assert run_command(["run", str(program)]) == 0
        run = RunStore().load_run("last")
        notes = [
            Note("the <i>first</i> white", 0.5, 1.25, "Colour"),
            Note("at once", 2.0, 2.0, "Colour"),
        ]
        write_notes(run.folder / NOTES_FILE, notes)
        assert run_command(["log", "report", run.id, "--out", str(target)]) == 0
    return Driven(run, page_of(target))


def test_a_report_of_a_run_has_its_facts_and_all_its_sections(driven: Driven) -> None:
    facts = driven.page.section["Facts"]
    run = driven.run
    told = dict(zip(facts[::2], facts[1::2], strict=True))
    assert (told["mat"], told["profile"], told["seed"]) == ("Grey_bands", "robolab", "0")
    assert (told["SHA-256"], told["end"], told["noise"]) == (
        run.program.sha256,
        "finished",
        "light 0, motor 0",
    )
    assert run.end is not None
    assert told["simulated time"] == f"{run.end.time_ns / 1e9:.3f} s, tick {run.end.tick}"
    assert list(driven.page.section)[:7] == [
        *("Facts", "World", "Chart", "Bands", "Statistics", "Notes", "Program greys.py"),
    ]
    assert any(
        "5 levels: 100.00 white (4x), 86.27 pale grey, 82.75 light grey, 50.20 grey" in text
        for text in driven.page.section["Bands"]
    )
    assert driven.page.section["Statistics"].count("Colour") == 1
    assert driven.page.section["Notes"][-6:] == [
        *("0.50 to 1.25", "Colour", "the <i>first</i> white"),
        *("2.00", "Colour", "at once"),
    ]
    assert {"Colour", "Way_mm (mm)", "time (s)", "86.27"} <= set(driven.page.section["Chart"])


def test_a_report_whose_end_equals_its_summary_says_stopped_only_once(driven: Driven) -> None:
    assert driven.run.end is not None
    stopped = replace(driven.run.end, end=End.STOPPED, summary="stopped")
    assert ("end", "stopped") in list_run_facts([replace(driven.run, end=stopped)])


CHOICES = {
    "walls": ("off", "walls false"),
    "solid": ("on", "solid true"),
    "background_fit": ("corner", "background_fit corner"),
    "pen_marks": ("on", "pen_marks true"),
    "start.x_mm": ("321", "321"),
    "start.y_mm": ("432", "432"),
    "start.heading_deg": ("77", "77"),
    "noise.light": ("12", "light 12"),
    "noise.motor": ("23", "motor 23"),
    "drift": ("typical", "drift typical"),
    "floor": ("on", "floor true"),
    "pen.color": ("blue", "pen.color blue"),
    "pen.width_mm": ("9", "pen.width_mm 9"),
    "pen.down": ("on", "pen.down true"),
    "seed": ("4711", "4711"),
}
"""A text for each value of a run, and what the facts have for it."""


def test_the_report_names_each_setting_that_changes_a_run(driven: Driven) -> None:
    assert [*CHOICES] == [*RUN_VALUES]
    for path, (text, words) in CHOICES.items():
        chosen = RUN_VALUES[path]
        spec = put(driven.run.spec, chosen.spec_path, chosen.value.parse_text(text))
        facts = list_run_facts([replace(driven.run, spec=spec)])
        assert any(words in fact[1] for fact in facts), path
    answers = {**driven.run.options, "answers": ["left"]}
    assert ("answers", "'left'") in list_run_facts([replace(driven.run, options=answers)])


def test_the_program_in_a_report_has_line_numbers(driven: Driven) -> None:
    cells = driven.page.section["Program greys.py"]
    lines = PROGRAM.replace("\x0c", "\ufffd").split("\n")
    numbered = dict(zip(cells[::2], cells[1::2], strict=False))
    assert [numbered[str(at)] for at in range(1, 11)] == lines[:10]


def test_a_report_page_loads_nothing_from_other_files_or_sites(driven: Driven) -> None:
    assert not {"script", "link", "iframe", "object", "i", "b"} & set(driven.page.tags)
    for name, value in driven.page.attributes:
        assert not name.startswith("on")
        assert name not in ("href", "srcset") and (
            name != "src" or re.match("data:image/(png|gif);base64,", value)
        )


def test_the_reports_picture_of_the_world_draws_the_robots_path(driven: Driven) -> None:
    source, _ = (value for name, value in driven.page.attributes if name == "src")
    with Image.open(io.BytesIO(base64.b64decode(source.partition(",")[2]))) as picture:
        colors = {color: count for count, color in picture.convert("RGB").getcolors(1 << 20) or ()}
    # About 1.3 m at 3 mm a pixel, two pixels wide.
    assert colors[(230, 90, 0)] > 500


def test_a_small_movie_shows_the_run(driven: Driven) -> None:
    _, source = (value for name, value in driven.page.attributes if name == "src")
    content = base64.b64decode(source.partition(",")[2])
    (said,) = [
        text for text in driven.page.section["World"] if text.startswith("Movie of the run: ")
    ]
    end_s = (driven.run.telemetry.count - 1) / 100
    assert said == f"Movie of the run: {end_s:.1f} s in real time, {len(content) / 1000:.0f} kB"
    assert len(content) < 150_000
    with Image.open(io.BytesIO(content)) as movie:
        assert (movie.format, getattr(movie, "n_frames", 1)) == (
            "GIF",
            driven.run.telemetry.count // 10 + 2,
        )


def test_a_robot_that_stands_still_has_no_movie(here: Command, home: Path, tmp_path: Path) -> None:
    (tmp_path / "still.py").write_text("print('Colour: 1')\n")
    here("run", "still.py", "--preload", "preloaded")
    here("log", "report", "last")
    assert "details" not in page_of(tmp_path / "still-report.html").tags


def test_a_report_says_where_a_run_went_wrong(here: Command, tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text("# %%sim_magic_preloaded\nprint(1 / 0)\n")
    here("run", "wrong.py")
    here("log", "report", "last", "--out", "wrong.html")
    page = (tmp_path / "wrong.html").read_text()
    assert "Where it went wrong" in page
    assert page.count("line 2: ZeroDivisionError") == 1


def test_several_runs_stand_side_by_side(here: Command, tmp_path: Path, driven: Driven) -> None:
    assert here("log", "report", driven.run.id, driven.run.id, "--out", "two.html").returncode == 0
    page = page_of(tmp_path / "two.html")
    facts = page.section["Facts"]
    assert facts[facts.index("seed") + 1 :][:2] == ["0", "0"]
    assert page.tags.count("img") == 2
    assert sum(name.startswith("Program") for name in page.section) == 1
    assert {"Colour #1", "Colour #2"} <= set(page.section["Statistics"])


@pytest.mark.slow
def test_a_run_without_samples_shows_its_telemetry(
    here: Command, home: Path, tmp_path: Path
) -> None:
    (tmp_path / "quiet.py").write_text("tank_drive.on_for_rotations(20, 20, 1)\n1/0\n")
    here("run", "quiet.py", "--preload", "preloaded")
    here("log", "report", "last", "--out", "quiet.HTML")
    page = page_of(tmp_path / "quiet.HTML")
    assert any("printed no samples" in text for text in page.words)
    assert "left_red" in page.section["Chart"]
    assert any(
        text.endswith("ZeroDivisionError: division by zero") for text in page.section["Facts"]
    )


def test_a_report_of_a_run_whose_mat_is_gone_lacks_only_the_picture(
    here: Command, home: Path, tmp_path: Path, driven: Driven
) -> None:
    folder = home / "runs" / driven.run.id
    copytree(driven.run.folder, folder)
    path = folder / "run.json"
    path.write_text(path.read_text().replace('"Grey_bands"', '"Gone"').replace(".rgb", ".gone"))
    assert here("log", "report", driven.run.id).returncode == 0
    page = page_of(tmp_path / "greys-report.html")
    assert page.section["World"][0].startswith("No picture: ")
    assert "Bands" in page.section


def test_a_report_of_a_log_file_has_no_program_and_no_world_section(
    here: Command, home: Path, tmp_path: Path
) -> None:
    log = tmp_path / "some.csv"
    log.write_text(
        "time,<b>\n" + "".join(f"{at},{50 * (at // 20)}\n" for at in range(40)) + "40,oops\n"
    )
    write_notes(find_notes_file(log), [Note("here", 3.0, 3.0)])
    assert here("log", "report", "some.csv").stderr.endswith("written: some-report.html\n")
    page = page_of(tmp_path / "some-report.html")
    assert list(page.section) == ["Facts", "Chart", "Bands", "Statistics", "Notes"]
    assert page.section["Facts"][:4] == [
        "file",
        "some.csv",
        "rows",
        "41, and 1 that could not be read",
    ]
    assert "<b>" in page.section["Chart"]
    assert "here" in page.section["Notes"]


def test_the_many_bands_of_an_oscillation_hide_no_curve(
    here: Command, home: Path, tmp_path: Path
) -> None:
    rows = "".join(f"{at},{40 + 20 * (at // 20 % 2)}\n" for at in range(20 * 150))
    (tmp_path / "some.csv").write_text(f"time,light\n{rows}")
    here("log", "report", "some.csv")
    section = page_of(tmp_path / "some-report.html").section
    assert "and 50 more" in section["Bands"]
    assert not any("shaded" in text for text in section["Chart"])


def test_statistics_of_too_many_variables_are_those_of_the_drawn_ones_and_of_the_first(
    here: Command, home: Path, tmp_path: Path
) -> None:
    rows = "".join(f"{number},v{number},{number}\n" for number in range(MAX_STATISTICS + 20))
    (tmp_path / "some.csv").write_text(f"time,variable,value\n{rows}")
    here("log", "report", "some.csv", "--variable", f"v{MAX_STATISTICS + 9}")
    section = page_of(tmp_path / "some-report.html").section["Statistics"]
    assert section[-1] == "and 20 more"
    assert f"v{MAX_STATISTICS + 9}" in section
    assert f"v{MAX_STATISTICS - 1}" not in section


def test_a_report_of_an_exported_run_names_the_runs_program_and_mat(
    here: Command, tmp_path: Path, driven: Driven
) -> None:
    here("runs", "export", driven.run.id, "--out", "x.parquet")
    here("log", "report", "x.parquet", "--variable", "Colour")
    facts = page_of(tmp_path / "x-report.html").section["Facts"]
    assert facts[facts.index("SHA-256") + 1] == driven.run.program.sha256
    assert facts[facts.index("mat") + 1] == "Grey_bands"


BAD = {
    "no log": ((), "no log given"),
    "two files": (("a.csv", "b.csv"), "takes one file, or runs"),
    "no such format": (("{log}", "--out", "x.pdf"), "a report ends in .html"),
    "no such folder": (("{log}", "--out", "gone/x.html"), "there is no folder gone"),
    "telemetry of two": (("1", "2", "--telemetry"), "takes one run"),
    "columns of a run": (("1", "--time", "x"), "are for files"),
    "as JSON": (("{log}", "--json"), "no such option: --json"),
}


@cases("words, expected", BAD)
def test_a_report_that_cannot_be_made_is_refused_in_one_line(
    here: Command, home: Path, tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    log = tmp_path / "log.csv"
    log.write_text("time,a\n0,1\n1,2\n")
    done = here("log", "report", *(word.format(log=log) for word in words))
    assert (done.returncode, done.stdout) == (2, "")
    assert expected in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not list(tmp_path.glob("*report*"))
