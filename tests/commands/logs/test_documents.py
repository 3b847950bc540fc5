"""`tuisim log plot`: the chart of a log as text, SVG and PNG."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image

from tests.cases import cases
from tests.conftest import Command
from tests.running import told

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """Two variables of light and one in mm, and a hostile name."""
    path = tmp_path / "four.csv"
    rows = (f"{at / 10},{at % 7},{50 + at % 5},{100 * at},{at}\n" for at in range(100))
    path.write_text("time,left,right,x_mm,<b>&\n" + "".join(rows))
    return path


def texts_of(path: Path) -> list[str]:
    """The writing in an SVG file, which must be well formed."""
    return ["".join(node.itertext()) for node in ElementTree.parse(path).iter(f"{SVG}text")]


@pytest.mark.parametrize("columns", [80, 120])
def test_log_plot_in_text_fits_the_terminal(
    here: Command, log: Path, monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    lines = here("log", "plot", str(log), "--variable", "left").stdout.splitlines()
    assert columns - 6 < max(map(len, lines)) <= columns
    assert lines[0] == str(log)[:columns].rstrip()
    assert any("6┤" in line for line in lines)
    assert lines[-1].endswith("s")
    assert "\x1b" not in "".join(lines)


def test_text_without_colours_tells_lines_apart_by_marks(here: Command, log: Path) -> None:
    said = here(
        "log", "plot", str(log), "--variable", "left", "--variable", "right", "--size", "60x15"
    ).stdout
    legend = said.splitlines()[1]
    assert legend.split() == ["[o]", "left", "[+]", "right"]
    assert said.count("o") > 10 and said.count("+") > 10
    assert len(said.splitlines()) == 16


def test_log_plot_with_facets_draws_a_chart_for_each_variable(
    here: Command, log: Path, tmp_path: Path
) -> None:
    words = ("log", "plot", str(log), "--facets", "--variable", "left", "--variable", "right")
    lines = here(*words).stdout.splitlines()
    assert [line for line in lines if line.startswith("[")] == ["[x] left", "[x] right"]
    here(*words, "--out", "two.svg")
    assert {"left", "right", "time (s)"} <= set(texts_of(tmp_path / "two.svg"))


def test_svg_is_well_formed_and_says_what_is_what(here: Command, log: Path, tmp_path: Path) -> None:
    done = here("log", "plot", str(log), "--out", "chart.svg", "--from", "2", "--to", "5")
    assert (done.returncode, done.stdout) == (0, "")
    texts = texts_of(tmp_path / "chart.svg")
    # x_mm has a scale of its own, on the right, as what would be flat beside the others.
    assert "x_mm (mm), right scale" in texts
    assert {"left", "right", "<b>&", "time (s)", "2", "5"} <= {
        text.removesuffix(".0").removesuffix(", right scale") for text in texts
    }
    root = ElementTree.parse(tmp_path / "chart.svg").getroot()
    width, height = float(root.attrib["width"]), float(root.attrib["height"])
    for path in root.iter(f"{SVG}path"):
        points = [point.split() for point in path.attrib["d"][1:].split("L")]
        assert all(0 <= float(x) <= width and 0 <= float(y) <= height for x, y in points)


@pytest.mark.parametrize("name", ["chart.png", "chart.PNG"])
def test_png_has_its_size_and_is_not_blank(
    here: Command, log: Path, tmp_path: Path, name: str
) -> None:
    here("log", "plot", str(log), "--out", name, "--size", "640x300")
    with Image.open(tmp_path / name) as picture:
        assert (picture.format, picture.size) == ("PNG", (640, 300))
        assert len(picture.getcolors(1 << 20) or ()) > 20


def test_log_plot_of_a_path_has_the_same_scale_on_both_axes(here: Command, tmp_path: Path) -> None:
    (tmp_path / "way.csv").write_text(
        "time,x_mm,y_mm\n0,0,0\n1,1000,0\n2,1000,500\n3,0,500\n4,0,0\n"
    )
    here("log", "plot", "way.csv", "--variable", "y_mm", "--against", "x_mm", "--out", "way.svg")
    path = list(ElementTree.parse(tmp_path / "way.svg").iter(f"{SVG}path"))[-1].attrib["d"]
    xs, ys = zip(*(map(float, point.split()) for point in path[1:].split("L")), strict=True)
    assert max(xs) - min(xs) == pytest.approx(2 * (max(ys) - min(ys)), abs=0.3)
    said = here(
        "log", "plot", "way.csv", "--variable", "y_mm", "--against", "x_mm", "--size", "60x12"
    ).stdout
    assert "y_mm against x_mm" in said


def test_a_plot_names_the_variables_that_it_leaves_out(here: Command, log: Path) -> None:
    log.write_text("time,a,b,c,d,e\n0,1,2,3,4,5\n1,2,3,4,5,6\n")
    assert "not drawn: e; --variable NAME" in here("log", "plot", str(log)).stderr
    assert told(here("log", "plot", str(log), "--variable", "e")) == []


BAD = {
    "no such format": (("--out", "x.gif"), "a chart ends in .svg, .png, .txt"),
    "no such folder": (("--out", "gone/x.svg"), "there is no folder gone"),
    "two against one": (
        ("--variable", "left", "--variable", "right", "--against", "x_mm"),
        "got 2",
    ),
    "a size": (("--size", "big"), "width and height, 20x8 to 1000x500"),
    "a size of no picture": (("--size", "10x10", "--out", "x.png"), "200x150 to 6000x6000"),
    "time that runs back": (("--from", "5", "--to", "1"), "--from must be less than --to"),
    "nothing then": (("--from", "50", "--to", "60"), "they are between 0 s and 9.9 s"),
    "as JSON": (("--json",), "no such option: --json"),
}


@cases("words, expected", BAD)
def test_a_plot_that_cannot_be_made_is_refused_in_one_line(
    here: Command, log: Path, tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    done = here("log", "plot", str(log), *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert expected in done.stderr
    assert len(told(done)) == 1
    assert list(tmp_path.iterdir()) == [log]


@pytest.mark.parametrize(
    "times", ["1e20 100000000000000016384", "1e20 1e20", "0 5e-324"], ids=["two", "one", "tiny"]
)
def test_log_plot_draws_times_too_near_each_other_without_an_error(
    here: Command, tmp_path: Path, times: str
) -> None:
    path = tmp_path / "a.csv"
    path.write_text(
        "time,red\n" + "".join(f"{time},{at}\n" for at, time in enumerate(times.split()))
    )
    for words in (("plot", "--size", "60x12"), ("plot", "--out", str(tmp_path / "a.svg"))):
        done = here("log", words[0], str(path), *words[1:])
        assert done.returncode == 0
        assert not [line for line in told(done) if not line.startswith("written: ")]
