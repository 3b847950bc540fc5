"""Sheet, table, page, feedback and exports as functions of students and outcomes made by hand."""

from __future__ import annotations

import math
import re
import subprocess
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from tests.running import PATIENCE_S
from tests.tasks.marks.hazards import EVIL
from tests.web.chromium import needs_chromium
from tuisim.base.errors import printable
from tuisim.base.source import Program
from tuisim.programs.program_file import ProgramSource
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.goals.spec import FinishCondition, Goal
from tuisim.tasks.marks.feedback import build_feedback, build_file_stems, write_feedback
from tuisim.tasks.marks.gradebook import Roster, write_gradebook
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.marking import Override, apply_overrides
from tuisim.tasks.marks.outcome import GoalOutcome, Outcome
from tuisim.tasks.marks.page import build_page, compute_distribution, compute_goal_statistics
from tuisim.tasks.marks.sheet import Sheet, build_sheet, export_marks
from tuisim.tasks.marks.students import Student

COLUMNS = (
    Goal("place", FinishCondition(), "Stop at the place.", 7.0, "Measure the distance."),
    Goal("wall", FinishCondition(), "Do not touch the wall.", 3.0),
)
TEXT = "drive()\nstop()  # <b>too late</b>\n"


def _student(name: str, text: str = TEXT) -> Student:
    return Student(name, Path(name), "main.py", ProgramSource(Program("main.py", text)))


def _outcome(seed: int, place: bool, wall: bool = True, **more: Any) -> Outcome:
    goals = (
        GoalOutcome("place", place, "" if place else "it stopped 40 mm away", 0 if place else 2),
        GoalOutcome("wall", wall, "" if wall else "it touched the wall"),
    )
    return replace(Outcome(seed, "finished", goals=goals), **more)


STUDENTS = (
    _student("ada"),
    _student("ben"),
    _student("cleo"),
    _student(EVIL),
    Student("empty", Path("empty"), problem="there is no Python file (main.py)"),
)
OUTCOMES = {
    "ada": [_outcome(seed, True) for seed in range(4)],
    # Not in the order of the seeds: workers finish as they please.
    "ben": [_outcome(2, True), _outcome(3, True), _outcome(1, False), _outcome(0, True)],
    "cleo": [_outcome(0, False, False, end="stalled", failure="stuck in line 1", line=1)],
    EVIL: [
        _outcome(seed, False, end="raised", failure=printable(EVIL), line=2, error=EVIL)
        for seed in range(4)
    ],
}
SHEET = build_sheet("Grey bands", COLUMNS, range(4), STUDENTS, OUTCOMES)


def test_a_students_row_has_mean_points_robustness_and_the_first_failure() -> None:
    found = {
        row.name: (row.points, row.robustness, row.reason, row.line, row.seed, row.runs)
        for row in SHEET.rows
    }
    assert found == {
        "ada": (10.0, 1.0, "", 0, 0, 4),
        "ben": (8.25, 0.75, "it stopped 40 mm away", 2, 1, 4),
        "cleo": (0.0, 0.0, "stuck in line 1", 1, 0, 1),
        EVIL: (3.0, 0.0, printable(EVIL), 2, 0, 4),
        "empty": (0.0, 0.0, "there is no Python file (main.py)", 0, 0, 0),
    }
    assert [(cell.points, cell.met) for cell in SHEET.rows[1].cells] == [(5.25, 3), (3.0, 4)]
    assert (SHEET.rows[1].source_line, SHEET.rows[2].stopped_early) == (
        "stop()  # <b>too late</b>",
        True,
    )


def test_in_a_task_without_points_a_run_is_complete_if_it_meets_every_goal() -> None:
    columns = [replace(column, points=0.0) for column in COLUMNS]
    sheet = build_sheet("", columns, range(4), STUDENTS[:2], OUTCOMES)

    assert [(row.robustness, row.reason) for row in sheet.rows] == [
        (1.0, ""),
        (0.75, "it stopped 40 mm away"),
    ]
    assert 'class="number part">0<' in build_page(sheet)


@pytest.mark.parametrize(
    "place, hit, points", [(True, False, 7), (True, True, 5), (False, True, 0)]
)
def test_deducted_points_never_make_the_total_negative(
    place: bool, hit: bool, points: float
) -> None:
    columns = (COLUMNS[0], Goal("hit", FinishCondition(), "Hit the wall.", -2.0))
    goals = (
        GoalOutcome("place", place, "" if place else "too far"),
        GoalOutcome("hit", hit, is_penalty=True),
    )
    sheet = build_sheet(
        "", columns, (0,), STUDENTS[:1], {"ada": [Outcome(0, "finished", goals=goals)]}
    )
    (row,) = sheet.rows
    assert (sheet.most_points, row.points, row.robustness) == (7, points, float(place and not hit))
    assert row.reason == ("too far" if not place else "Hit the wall." if hit else "")
    told = "[happened] Hit the wall. (-2)" if hit else "[did not happen] Hit the wall."
    assert told in build_feedback(sheet, row)
    assert f'class="number {"missed" if hit else "met"}' in build_page(sheet)


def _unjudged_sheet() -> Sheet:
    """A sheet of three students in three worlds: not known; not known and missed; met and not known."""
    place = {
        "?": GoalOutcome("place", False, "the expression is slow", is_unknown=True),
        "-": GoalOutcome("place", False, "it stopped 40 mm away"),
        "+": GoalOutcome("place", True),
    }
    wall = GoalOutcome("wall", True)
    outcomes = {
        name: [
            Outcome(0, "finished", goals=(place[state], wall), world=world)
            for state, world in zip(states, ("", "a", "b"), strict=True)
        ]
        for name, states in {"ada": "???", "ben": "?+-", "cleo": "+?+"}.items()
    }
    return build_sheet("", COLUMNS, range(1), STUDENTS[:3], outcomes, ("", "a", "b"))


def test_a_student_who_could_not_be_judged_has_no_points_but_a_question_mark() -> None:
    sheet = _unjudged_sheet()
    table = [row[1:5] for row in sheet.tabulate()[1]]
    assert table == [["?", "0%", "?", "3"], ["3", "0%", "0", "3"], ["?", "0%", "?", "3"]]
    assert sheet.summary.startswith("3 students, 1 seed: mean 3 of 10 points")
    assert "[could not be judged] Stop at the place." in build_feedback(sheet, sheet.rows[0], TEXT)
    assert sum(count for *_, count in compute_distribution(sheet)) == 1
    assert [one.mean for one in compute_goal_statistics(sheet)] == [0.0, 3.0]
    (row, *_) = apply_overrides(sheet, {"ada": Override(goals={"wall": 2.0})}).rows
    assert math.isnan(row.points)


def test_a_gradebook_has_no_number_for_what_could_not_be_judged(tmp_path: Path) -> None:
    path = tmp_path / "g.csv"
    sheet = _unjudged_sheet()
    write_gradebook(path, GradebookKind.CANVAS, sheet, [TEXT] * 3, Roster({}), goals=True)
    ends = [row.split(",")[-3:] for row in path.read_text().splitlines()[2:]]
    assert ends == [["", "", "3"], ["3", "0", "3"], ["", "", "3"]]


def test_the_table_of_marks_has_a_column_for_each_goal_and_names_the_failing_line() -> None:
    heads, rows = SHEET.tabulate()
    assert heads == ["student", "points", "robustness", "place", "wall", "reason"]
    assert rows[:3] == [
        ["ada", "10", "100%", "7", "3", ""],
        ["ben", "8.25", "75%", "5.25", "3", "line 2: it stopped 40 mm away"],
        ["cleo", "0", "0%", "0", "0", "stuck in line 1"],
    ]
    assert (
        SHEET.summary
        == "5 students, 4 seeds: mean 4.25 of 10 points; 1 with all points for every seed"
    )


LONG = "n" * 95 + "-" + "m" * 94
LONG_SHEET = build_sheet(
    "", [*COLUMNS, replace(COLUMNS[0], name="g" * 60)], range(4), [_student(LONG)], {}
)


def test_a_long_name_pushes_no_mark_off_the_table() -> None:
    heads, (row,) = LONG_SHEET.tabulate(12, 6)
    assert (heads[-2], row[0], len(row[0])) == ("ggg…gg", "nnnnnnn…mmmm", 12)
    assert len(LONG_SHEET.tabulate()[1][0][0]) == 40


GEOMETRY = """<script>
const edge = Math.max(...[...document.querySelectorAll("td.number")].map(one => one.getBoundingClientRect().right));
document.title = edge <= innerWidth ? "all in view" : "marks end at " + edge;
</script>"""


@pytest.mark.slow
@needs_chromium
@pytest.mark.parametrize("width", [800, 1400])
def test_a_long_name_pushes_no_mark_off_the_page(tmp_path: Path, width: int) -> None:
    (tmp_path / "marks.html").write_text(
        build_page(LONG_SHEET).replace("</body>", f"{GEOMETRY}</body>")
    )
    command = [
        "chromium",
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={tmp_path}/browser",
    ]
    words = [f"--window-size={width},800", "--dump-dom", str(tmp_path / "marks.html")]
    done = subprocess.run(
        [*command, *words], capture_output=True, text=True, check=True, timeout=PATIENCE_S
    )
    assert "<title>all in view</title>" in done.stdout


TAGS = {
    "html",
    "head",
    "meta",
    "title",
    "style",
    "body",
    "header",
    "h1",
    "h2",
    "p",
    "section",
    "div",
    "table",
    "thead",
    "tbody",
    "tr",
    "th",
    "td",
    "br",
    "a",
    "code",
    "details",
    "summary",
    "pre",
    "ul",
    "li",
    "meter",
    "i",
    "script",
}


class _Elements(HTMLParser):
    """Every element of a page with its attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))


def test_text_of_a_student_is_escaped_in_the_page_of_marks() -> None:
    links = {(EVIL, "", 0): 'class-runs/"><script>.html'}
    page = build_page(SHEET, links, ignored=("<script>alert(3)</script>.doc",))
    elements = _Elements(page).found
    tags = {tag for tag, _ in elements}
    assert tags <= TAGS and [tag for tag, _ in elements].count("script") == 1
    assert not [name for _, attributes in elements for name in attributes if name.startswith("on")]
    assert [attributes["href"] for tag, attributes in elements if tag == "a"] == [
        "class-runs/%22%3E%3Cscript%3E.html"
    ]
    # Its text is there, without what controls a terminal.
    assert "&lt;script&gt;alert(1)" in page and not re.search(r"[\x00-\x08\x0b-\x1f\x7f]", page)


def test_the_page_of_marks_shows_each_student_and_the_failing_line() -> None:
    page = build_page(SHEET)
    assert all(f'scope="row">{name}<' in page for name in ("ada", "ben", "cleo", "empty"))
    assert "line 2: <code>stop()  # &lt;b&gt;too late&lt;/b&gt;</code>" in page
    assert page.count("not run with further seeds") == 1


def test_seeds_with_equal_recordings_share_a_link_in_the_page_of_marks() -> None:
    links = {
        ("ben", "", seed): f"runs/{'first' if seed in (0, 1, 3) else 'other'}.html"
        for seed in range(4)
    }
    page = build_page(SHEET, links)
    assert '<a href="runs/first.html">0–1, 3</a>, <a href="runs/other.html">2</a>' in page


def test_a_students_feedback_says_which_goals_were_met_or_missed_and_why() -> None:
    text = build_feedback(SHEET, SHEET.rows[1], TEXT)
    assert text.splitlines() == [
        "ben: 8.25 of 10 points",
        "======================",
        "",
        "Grey bands",
        "",
        "Your program ran 4 times, each time with different random numbers: 3 of 4 runs met every",
        "goal.",
        "",
        "[met in part] Stop at the place. (5.25 of 7)",
        "    Met in 3 of 4 runs; missed with seed 1.",
        "    Why: it stopped 40 mm away",
        "    Line 2: stop()  # <b>too late</b>",
        "    Hint: Measure the distance.",
        "",
        "[met] Do not touch the wall. (3 of 3)",
    ]


def test_feedback_of_a_program_that_could_not_be_run_says_so() -> None:
    text = build_feedback(SHEET, SHEET.rows[4])
    assert "did not run to its end: there is no Python file" in " ".join(text.split())


def test_feedback_says_only_once_why_a_program_does_not_compile() -> None:
    row = replace(
        SHEET.rows[3],
        failure="SyntaxError: '(' was never closed (line 2)",
        cells=tuple(
            replace(cell, reason="The program does not compile: '(' was never closed.", line=2)
            for cell in SHEET.rows[3].cells
        ),
    )
    text = build_feedback(SHEET, row, TEXT)
    assert text.count("was never closed") == 1 and "Line 2:" not in text and "[missed]" in text
    assert "times, each time" not in text


def test_feedback_names_an_error_without_control_characters() -> None:
    text = build_feedback(SHEET, SHEET.rows[3], TEXT)
    assert "did not run to its end: \ufffd[2J" in text and not re.search(
        r"[\x00-\x08\x0b-\x1f\x7f]", text
    )


def test_each_student_has_a_feedback_file_of_a_plain_name(tmp_path: Path) -> None:
    write_feedback(tmp_path / "feedback", SHEET, [TEXT] * len(STUDENTS))
    names = sorted(path.name for path in (tmp_path / "feedback").iterdir())
    assert len(names) == len(STUDENTS) and {"ada.txt", "ben.txt", "cleo.txt", "empty.txt"} < set(
        names
    )
    assert build_file_stems(["ada", "ada.py", "Ada", "a/b", "\x1b[2J", "..", ""]) == [
        "ada",
        "ada.py",
        "Ada-2",
        "a_b",
        "_[2J",
        "student",
        "student-2",
    ]


def test_no_other_name_takes_the_name_of_a_students_file() -> None:
    assert build_file_stems(["ada ", "ada", "b?", "b_", "ben", "ben-2", "ben."]) == [
        "ada-2",
        "ada",
        "b_-2",
        "b_",
        "ben",
        "ben-2",
        "ben-3",
    ]


def test_files_of_the_longest_name_can_be_written(tmp_path: Path) -> None:
    sheet = build_sheet("", COLUMNS, range(1), [_student("\U0001f40d" * 63)], {})
    write_feedback(tmp_path, sheet, [TEXT])
    (written,) = tmp_path.iterdir()
    assert len(f"{written.stem}-seed-{2**63 - 1}.html".encode()) <= 255


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_exported_marks_do_not_depend_on_the_order_of_runs(tmp_path: Path, suffix: str) -> None:
    backwards = {name: list(reversed(found)) for name, found in OUTCOMES.items()}
    again = build_sheet("Grey bands", COLUMNS, range(4), STUDENTS, backwards)
    for name, sheet in (("first", SHEET), ("second", again)):
        export_marks(sheet, tmp_path / f"{name}{suffix}")
    first, second = ((tmp_path / f"{name}{suffix}").read_bytes() for name in ("first", "second"))
    assert first == second and len(first) > 100


def test_the_frame_of_marks_has_a_row_for_each_student_and_a_column_for_each_goal() -> None:
    frame = SHEET.build_frame()
    assert list(frame.columns) == [
        "student",
        "program",
        "points",
        "robustness",
        "runs",
        "goal_place",
        "goal_wall",
        "reason",
        "line",
        "source_line",
        "seed",
        "earned",
        "comment",
    ]
    assert frame.loc[1, ["student", "points", "goal_place"]].tolist() == ["ben", 8.25, 5.25]


def test_an_interrupted_marking_lists_students_without_runs_as_not_run() -> None:
    sheet: Sheet = build_sheet("", COLUMNS, range(4), STUDENTS[:2], {"ada": OUTCOMES["ada"][:2]})
    assert [(row.points, row.runs, row.reason) for row in sheet.rows] == [
        (10.0, 2, ""),
        (0.0, 0, "not run"),
    ]


def test_a_run_that_this_machine_could_not_start_does_not_lower_a_students_mark() -> None:
    outcomes = {
        "ada": [*OUTCOMES["ada"], Outcome(4, "", "too many open files")],
        "ben": [Outcome(0, "", "no space")],
    }
    sheet: Sheet = build_sheet("", COLUMNS, range(5), STUDENTS[:2], outcomes)
    assert [(format_points(row.points), row.runs, row.reason) for row in sheet.rows] == [
        ("10", 4, ""),
        ("?", 0, "could not be judged: no space"),
    ]


@pytest.mark.parametrize(
    "missing",
    [
        Outcome(4, "disk_full", "the recording cannot grow: No space left on device"),
        Outcome(4, "", "could not be judged: OverflowError: inf"),
    ],
)
def test_a_student_whose_program_could_choose_which_runs_count_gets_no_points(
    missing: Outcome,
) -> None:
    earlier = [*OUTCOMES["ada"], Outcome(5, "", "too many open files")]
    sheet = build_sheet("", COLUMNS, range(6), STUDENTS[:1], {"ada": [*earlier, missing]})
    (row,) = sheet.rows
    why = missing.failure.removeprefix("could not be judged: ")
    assert (format_points(row.points), row.reason) == ("?", f"could not be judged: {why}")


def test_a_run_without_any_recording_gets_no_points_and_a_reason() -> None:
    sheet: Sheet = build_sheet(
        "", COLUMNS, range(1), STUDENTS[:1], {"ada": [Outcome(0, "crashed", "it is damaged")]}
    )
    assert [(row.points, row.runs, row.cells[0].reason) for row in sheet.rows] == [
        (0.0, 1, "it is damaged")
    ]
