"""The guide in the app: the keys first, the page of the panel with the focus, contents, search; by keyboard alone."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from threading import Event
from typing import Any

import pytest
from rich.text import Text
from textual.pilot import Pilot
from textual.widgets import Input, Tree

from tests.app.app_help import lab, open_lab, screen_text, until, until_shown
from tests.cases import cases
from tests.guide.documents import NARROW_PAGE_COLUMNS
from tests.running import PATIENCE_S
from tuisim.app.guide.answers import STANDS_OUT, AnswerList
from tuisim.app.guide.screen import KEYS, TOPICS, GuideScreen
from tuisim.app.panels import PANELS
from tuisim.guide.catalogue import load_pages
from tuisim.guide.excerpt import draw_excerpt, flatten_passage
from tuisim.guide.search import SearchResult, search

SMALL = (80, 24)
MEDIUM = (120, 40)
DOWN_TO_PAGE = ["down"] * 2
"""From the keys past the first part to its first page."""


def guide(pilot: Pilot[Any]) -> GuideScreen:
    screen = pilot.app.screen
    assert isinstance(screen, GuideScreen)
    return screen


def page_text(pilot: Pilot[Any]) -> str:
    """The words in sight of the page, without the contents beside it."""
    page = guide(pilot)._page.region
    rows = screen_text(lab(pilot)).splitlines()[page.y : page.bottom]
    return " ".join(" ".join(row[page.x : page.right] for row in rows).split())


async def asked(pilot: Pilot[Any], question: str) -> list[SearchResult]:
    """Type a question, and return the answers in view."""
    screen = guide(pilot)
    await pilot.press("slash")
    screen.query_one(Input).value = question
    await until(pilot, lambda: screen.answers != [])
    return [*screen.answers]


def first_words(one: SearchResult) -> str:
    """How an answer begins in the list."""
    return "".join(text for text, _ in draw_excerpt(one, 33, 1)[0]).removesuffix(" …")


@asynccontextmanager
async def open_guide(
    *keys: str, text: str | None = None, size: tuple[int, int] = SMALL
) -> AsyncIterator[tuple[Pilot[Any], GuideScreen]]:
    """Press keys in the app and open the guide."""
    async with open_lab(text, size=size) as (pilot, app):
        await pilot.press(*keys, "f1")
        await until(pilot, lambda: isinstance(app.screen, GuideScreen) and app.screen.is_ready)
        yield pilot, guide(pilot)


def test_every_panel_has_a_topic_of_the_guide() -> None:
    assert set(TOPICS) == set(PANELS)
    assert {topic.page for topic in TOPICS.values()} - {""} <= set(load_pages())


@pytest.mark.quick_cases("small")
@pytest.mark.parametrize("size", [SMALL, MEDIUM], ids=["small", "medium"])
async def test_the_guide_begins_with_the_keys_and_enter_opens_a_page(size: tuple[int, int]) -> None:
    async with open_guide(size=size) as (pilot, screen):
        assert screen.place == KEYS
        await until_shown(pilot, "Run the program")
        await pilot.press("tab", *DOWN_TO_PAGE, "enter")
        await until(pilot, lambda: screen.place == ("first-steps", ""))
        await until_shown(pilot, "This page takes you from the first start")
        await pilot.press("escape")
        await until(pilot, lambda: not isinstance(pilot.app.screen, GuideScreen))


@pytest.mark.slow
async def test_the_guide_opens_a_new_page_at_its_top_after_scrolling() -> None:
    async with open_guide() as (pilot, _):
        await until_shown(pilot, "Run the program")
        await pilot.press("end")
        await until_shown(pilot, "Leave a field")
        await pilot.press("tab", *DOWN_TO_PAGE, "enter")
        await until_shown(pilot, "First steps")


@pytest.mark.slow_cases("settings")
@cases(
    "panel, place, words",
    {
        "debug": ("G", "stepping", ("Debugging", "Step through a program")),
        "brick": ("K", "the-brick", ("The brick",)),
        "settings": ("Z", "options", ("Options",)),
    },
)
async def test_the_guide_opens_at_the_page_of_the_panel_with_the_focus(
    panel: str, place: str, words: tuple[str, ...]
) -> None:
    async with open_guide(panel, text="print(1)", size=MEDIUM) as (pilot, screen):
        assert screen.place == (place, "")
        for word in words:
            await until_shown(pilot, word)


@pytest.mark.slow
async def test_the_scroll_bar_covers_no_letter() -> None:
    async with open_guide("G") as (pilot, screen):
        page = screen._page
        await until(
            pilot,
            lambda: (
                page.max_scroll_y > 0 and page.scrollable_content_region.width == page.drawn_columns
            ),
        )
        assert page.drawn_columns == NARROW_PAGE_COLUMNS


@pytest.mark.slow
async def test_a_page_is_drawn_again_when_only_its_own_width_changes() -> None:
    async with open_guide(size=MEDIUM) as (pilot, screen):
        page = screen._page
        await until(pilot, lambda: page.scrollable_content_region.width == page.drawn_columns > 0)
        before = page.drawn_columns
        screen._contents.styles.width = 30
        await until(
            pilot, lambda: before < page.scrollable_content_region.width == page.drawn_columns
        )


@pytest.mark.slow
async def test_a_new_search_in_the_guide_replaces_the_old_words() -> None:
    async with open_guide() as (pilot, screen):
        await pilot.press("slash", *"noise", "enter", "slash", *"black")
        assert screen.query_one(Input).value == "black"


@pytest.mark.slow
async def test_escape_in_the_guide_first_leaves_the_search() -> None:
    async with open_guide() as (pilot, screen):
        await pilot.press("slash", "q", "j", "x", "v", "k")
        await until_shown(pilot, "No page has these words")
        await pilot.press("escape")
        assert lab(pilot).screen is screen
        await until_shown(pilot, "Tutorials")
        await pilot.press("escape")
        await until(pilot, lambda: not isinstance(pilot.app.screen, GuideScreen))


@pytest.mark.slow
async def test_escape_goes_from_a_page_to_the_answers_and_from_these_to_the_contents() -> None:
    async with open_guide() as (pilot, screen):
        answers = await asked(pilot, "save the program")
        await pilot.press("down", "down", "enter")
        await until(pilot, lambda: screen._page.has_focus)
        assert screen.place == (answers[2].name, answers[2].heading)
        await until_shown(pilot, f"Guide · {load_pages()[answers[2].name].title}")
        await pilot.press("escape")
        await until_shown(pilot, first_words(answers[0]))
        await pilot.press("escape")
        await until_shown(pilot, "Tutorials")
        assert lab(pilot).screen is screen


@pytest.mark.slow
async def test_choosing_a_section_in_the_guides_contents_scrolls_to_it() -> None:
    async with open_guide() as (pilot, screen):
        await pilot.press("tab", *DOWN_TO_PAGE, "space", "down", "down", "enter")
        second = load_pages()["first-steps"].list_headings()[1]
        await until(pilot, lambda: screen.place == ("first-steps", second))
        await until(
            pilot,
            lambda: (
                screen_text(lab(pilot)).find(second)
                < screen_text(lab(pilot)).find("The world is in")
            ),
        )
        await until(pilot, lambda: "This page takes you" not in screen_text(lab(pilot)))


@pytest.mark.quick_cases("40x12", "80x24")
@pytest.mark.parametrize(
    "size", [(40, 12), (60, 18), SMALL, MEDIUM, (200, 60)], ids=lambda size: f"{size[0]}x{size[1]}"
)
async def test_no_title_is_cut_off(size: tuple[int, int]) -> None:
    async with open_guide(size=size) as (pilot, screen):
        await pilot.press("tab")
        tree = screen.query_one(Tree)
        await until(pilot, lambda: tree.has_focus and tree.size.width > 0)
        titles = [*(page.title for page in load_pages().values()), "All keys"]
        assert [
            title for title in titles if len(title) + 4 > tree.scrollable_content_region.width
        ] == []


@pytest.mark.slow_cases("brick")
@cases(
    "panel, first, then",
    {
        "brick": ("K", "Press this button of the brick", "The brick"),
        "chart": ("c", "Previous trace", "Pause or resume"),
        "fields": ("X", "Type the place", "Move the robot to its start pose"),
    },
)
async def test_the_guide_lists_the_keys_of_the_focused_panel_first(
    panel: str, first: str, then: str
) -> None:
    async with open_guide(panel) as (pilot, _):
        await until_shown(pilot, first)
        await until_shown(pilot, then)
        text = screen_text(lab(pilot))
        assert text.find("In the panel") < text.find(first) < text.find(then)


@pytest.mark.slow
async def test_a_slow_search_of_the_guide_says_that_it_is_searching_beside_the_whole_page(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    go_on = Event()

    def search_slowly(question: str) -> list[SearchResult]:
        assert go_on.wait(PATIENCE_S)
        return search(question)

    monkeypatch.setattr("tuisim.app.guide.screen.search", search_slowly)
    async with open_guide(size=SMALL) as (pilot, screen):
        columns = screen.query_one("#page").size.width
        await pilot.press("slash", *"save", "space", *"the", "space", *"program")
        await until(pilot, lambda: "searching …" in screen_text(lab(pilot)))
        assert screen.query_one("#page").size.width == columns
        go_on.set()
        await until(pilot, lambda: screen.answers != [])
        await until(pilot, lambda: "searching …" not in screen_text(lab(pilot)))


@pytest.mark.slow
@pytest.mark.parametrize("size", [(40, 12), SMALL, (200, 60)], ids=["40x12", "80x24", "200x60"])
async def test_the_best_answers_are_in_sight_below_each_other(size: tuple[int, int]) -> None:
    async with open_guide(size=size) as (pilot, _):
        answers = await asked(pilot, "save the program")
        await until_shown(pilot, first_words(answers[0]))
        shown = [one for one in answers if first_words(one) in screen_text(lab(pilot))]
        assert shown == answers[: len(shown)] and len(shown) >= (3 if size != (40, 12) else 1)


@pytest.mark.quick_cases("row")
@cases(
    "question, passage",
    {
        "paragraph": ("How do I make the robot slower?", "With a smaller number"),
        "row": ("leave a trace behind the robot", "Pen up or down"),
        "first": ("colours look wrong in my terminal", "does not announce"),
    },
)
async def test_the_passage_of_an_answer_is_in_sight_on_its_page(
    question: str, passage: str
) -> None:
    async with open_guide() as (pilot, _):
        answers = await asked(pilot, question)
        downs = next(
            at for at, one in enumerate(answers) if passage in flatten_passage(one.passage)
        )
        await pilot.press(*["down"] * downs, "enter")
        await until(pilot, lambda: guide(pilot)._page.has_focus)
        await until(pilot, lambda: passage in page_text(pilot))


@pytest.mark.slow
async def test_page_keys_in_the_guides_search_field_go_to_further_answers() -> None:
    async with open_guide() as (pilot, _):
        answers = await asked(pilot, "where is my data saved, and how do I read it in Python")
        listed = guide(pilot).query_one(AnswerList)
        # A list that is not laid out has no pages.
        await until(pilot, lambda: listed.size.height > 1)
        await pilot.press("pagedown")
        await until(pilot, lambda: listed.has_focus and (listed.highlighted or 0) > 1)
        await pilot.press("pageup", "pageup")
        await until(pilot, lambda: listed.highlighted == 0)
        assert len(answers) > 3


@pytest.mark.slow
async def test_answers_of_the_guide_are_laid_out_again_after_a_resize() -> None:
    async with open_guide() as (pilot, _):
        (first, *_) = await asked(pilot, "How do I make the robot slower?")
        words = flatten_passage(first.passage)
        await until_shown(pilot, words[:60])
        assert words[:90] not in screen_text(lab(pilot))
        await pilot.resize_terminal(150, 40)
        await until_shown(pilot, words[:90])


@pytest.mark.slow
async def test_answers_of_the_guide_show_words_of_the_question_in_bold() -> None:
    async with open_guide() as (pilot, _):
        answers = await asked(pilot, "colours of the sensor")
        listed = guide(pilot).query_one(AnswerList)
        first, second = (listed.get_option_at_index(at).prompt for at in range(2))
        assert isinstance(first, Text) and isinstance(second, Text)
        bold = {
            str(first)[one.start : one.end].lower()
            for one in first.spans
            if one.style == STANDS_OUT
        }
        assert bold <= {"colour", "color", "colours", "sensor", "sensors"} and bold
        same = (answers[0].name, answers[0].heading) == (answers[1].name, answers[1].heading)
        assert str(second).startswith("• ") == same


async def test_typing_a_letter_in_the_guide_begins_a_search() -> None:
    async with open_lab("x = 1\n", size=SMALL) as (pilot, _):
        await pilot.press("question_mark")
        await until_shown(pilot, "Guide")
        await pilot.press(*"grey")
        await until(pilot, lambda: guide(pilot).query_one(Input).value == "grey")
