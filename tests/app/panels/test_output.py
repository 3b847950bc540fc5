"""The panels of text: lines of the output, and the program's code."""

from __future__ import annotations

from textual.app import App, ComposeResult
from textual.widget import Widget

from tests.app.app_help import until
from tests.cases import for_rows
from tuisim.app.panels.output import KEPT_LINES, MAX_LINE_CHARS, Log, split_row
from tuisim.engine.runs.records import OutputRow, Stream


def row(text: str, stream: Stream = Stream.STDOUT) -> OutputRow:
    return OutputRow(text, 0, 0, 1, stream)


class Frame(App[None]):
    def __init__(self, content: Widget) -> None:
        super().__init__()
        self.content = content

    def compose(self) -> ComposeResult:
        yield self.content


def lines(app: App[None]) -> list[str]:
    strips = app.screen._compositor.render_strips()
    return ["".join(segment.text for segment in strip).rstrip() for strip in strips]


@for_rows(
    "text, stream, width, expected",
    [
        ("", Stream.STDOUT, 10, [""]),
        ("Colour: 1", Stream.STDOUT, 10, ["Colour: 1"]),
        ("hello there", Stream.STDOUT, 10, ["hello ", "there"]),
        ("x" * 25, Stream.STDOUT, 10, ["x" * 10, "x" * 10, "x" * 5]),
        ('File "programs/typo.py", line', Stream.STDERR, 20, ['File "programs/', 'typo.py", line']),
        ("you mean reflected_light?", Stream.NOTE, 20, ["you mean ", "reflected_light?"]),
        ("— error at 0.00 s", Stream.NOTE, 12, ["— error at ", "0.00 s"]),
        (
            "print(colorLeft.reflected_light)",
            Stream.STDERR,
            20,
            ["print(colorLeft.", "reflected_light)"],
        ),
        ("hi", Stream.SPEECH, 20, ["says: hi"]),
        ("[beep]", Stream.SPEECH, 20, ["[beep]"]),
        ("42", Stream.INPUT, 20, ["> 42"]),
        ("a\tb\x1b[31m", Stream.STDERR, 20, ["a   b·[31m"]),
        ("漢字漢字", Stream.STDOUT, 5, ["漢字", "漢字"]),
    ],
)
def test_each_printed_row_is_wrapped_to_the_width_of_the_panel(
    text: str, stream: Stream, width: int, expected: list[str]
) -> None:
    assert split_row(row(text, stream), width) == expected


def test_an_endless_line_is_cut_and_says_so() -> None:
    assert "".join(split_row(row("y" * (MAX_LINE_CHARS + 7)), 80)).endswith("… (7 more characters)")


async def test_the_output_follows_the_newest_line_until_scrolled_up() -> None:
    async with Frame(Log()).run_test(size=(30, 5)) as pilot:
        log = pilot.app.query_one(Log)
        log.add([row(f"line {n}") for n in range(20)])
        await pilot.pause()
        assert lines(pilot.app)[-1].startswith("line 19")
        log.focus()
        await pilot.press("up", "up")
        log.add([row("line 20")])
        await pilot.pause()
        assert lines(pilot.app)[-1].startswith("line 17")
        await pilot.press("end")
        log.add([row("line 21")])
        await pilot.pause()
        assert lines(pilot.app)[-1].startswith("line 21")


async def test_carets_are_left_out_where_they_would_point_elsewhere() -> None:
    async with Frame(Log()).run_test(size=(30, 8)) as pilot:
        log = pilot.app.query_one(Log)
        texts = ["    print(left.red_light_of_it)", "          ^^^^", "    x = y", "        ^"]
        log.add([row(text, Stream.STDERR) for text in texts])
        await pilot.pause()
        assert [line for line in lines(pilot.app) if line] == [
            "    print(left.red_light_of_",
            "it)",
            "    x = y",
            "        ^",
        ]


async def test_carets_do_not_hide_the_line_of_an_error_in_a_low_panel() -> None:
    async with Frame(Log()).run_test(size=(30, 4)) as pilot:
        log = pilot.app.query_one(Log)
        texts = [
            '  File "a.py", line 3, in mean',
            "    return a / b",
            "           ~~^~~",
            "Error: 0",
        ]
        log.add([row(text, Stream.STDERR) for text in texts])
        await pilot.pause()
        assert "~" not in "".join(lines(pilot.app))
        assert "    return a / b" in lines(pilot.app)


async def test_carets_whose_line_is_out_of_view_are_left_out() -> None:
    async with Frame(Log()).run_test(size=(30, 8)) as pilot:
        log = pilot.app.query_one(Log)
        log.add(
            [row(text, Stream.STDERR) for text in ("    x = y", "        ^", "SyntaxError: no", "")]
        )
        await pilot.pause()
        height = log.size.height
        assert lines(pilot.app)[0] == "    x = y"
        log.add([row("— error", Stream.NOTE)] * (height - 3))
        await pilot.pause()
        assert [line.strip() for line in lines(pilot.app)][:2] == ["", "SyntaxError: no"]


async def test_only_the_newest_lines_are_kept_and_the_others_counted() -> None:
    async with Frame(Log()).run_test(size=(50, 4)) as pilot:
        log = pilot.app.query_one(Log)
        log.add([row(f"line {n}") for n in range(KEPT_LINES + 500)], skipped=1000)
        log.focus()
        await pilot.press("home")
        await pilot.pause()
        assert lines(pilot.app)[0].startswith("… 1,500 earlier lines are in the log")
        assert lines(pilot.app)[1].startswith("line 500")


async def test_lines_wrap_anew_when_the_panel_gets_narrower() -> None:
    async with Frame(Log()).run_test(size=(40, 6)) as pilot:
        pilot.app.query_one(Log).add([row("one two three four five six")])
        await pilot.pause()
        assert lines(pilot.app)[0] == "one two three four five six"
        await pilot.resize_terminal(16, 6)
        await until(pilot, lambda: lines(pilot.app)[:2] == ["one two three", "four five six"])
