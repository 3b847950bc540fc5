"""A long output folds to its first and last lines."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from IPython.core.interactiveshell import InteractiveShell

from tests.notebook.conftest import Cell, Shown
from tuisim.notebook.cell_output import (
    FEWEST_FOLDED,
    FIRST_LINES,
    LAST_LINES,
    MAX_FOLDED_LINES,
    fold_lines,
)


@pytest.fixture
def kernel_cell(
    cell: Cell, shell: InteractiveShell, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Cell]:
    """`cell` in a shell whose displays can be updated."""
    monkeypatch.setattr(shell, "kernel", None, raising=False)
    yield cell


def printing(count: int, words: str = "-RWH") -> str:
    return f"%%sim_magic {words}\nfor at in range({count}):\n    print('<', at)\n"


def lines(first: int, last: int) -> str:
    return "".join(f"< {at}\n" for at in range(first, last))


def test_a_long_output_shows_its_ends_and_the_rest_on_a_click(kernel_cell: Cell) -> None:
    shown = kernel_cell(printing(530))
    assert shown.out == lines(0, FIRST_LINES)
    (bundle,) = shown.bundles
    hidden = 530 - FIRST_LINES - LAST_LINES
    assert bundle["text/plain"] == f"… {hidden} more lines\n{lines(530 - LAST_LINES, 530)}".rstrip(
        "\n"
    )
    page = str(bundle["text/html"])
    assert page.count("<details>") == page.count(f"<summary>… {hidden} more lines</summary>") == 1
    assert "".join(re.findall(r"&lt; (\d+)", page)) == "".join(map(str, range(FIRST_LINES, 530)))


@pytest.mark.parametrize("count", [1, FIRST_LINES])
def test_a_cells_short_output_is_not_folded(count: int, kernel_cell: Cell) -> None:
    shown = kernel_cell(printing(count))
    assert (shown.out, shown.bundles) == (lines(0, count), ())


def test_a_few_lines_more_than_fit_a_cells_output_are_not_folded(kernel_cell: Cell) -> None:
    count = FIRST_LINES + FEWEST_FOLDED + LAST_LINES - 1
    (bundle,) = kernel_cell(printing(count)).bundles
    assert "<details>" not in str(bundle["text/html"])
    assert bundle["text/plain"] == lines(FIRST_LINES, count).rstrip("\n")
    assert (
        "… 15 more lines"
        in fold_lines(["a line"] * (FEWEST_FOLDED + LAST_LINES), FEWEST_FOLDED + LAST_LINES)[
            "text/plain"
        ]
    )


def test_in_a_terminal_a_cells_long_output_is_printed_whole(cell: Cell) -> None:
    shown = cell(printing(530))
    assert (shown.out, shown.bundles) == (lines(0, 530), ())


def test_the_picture_stands_above_a_cells_long_output(kernel_cell: Cell) -> None:
    shown: Shown = kernel_cell(printing(530, "-Rc"))
    assert ["image/png" in bundle for bundle in shown.bundles] == [True, True, False, False]


def test_an_error_after_a_cells_long_output_is_not_folded(kernel_cell: Cell) -> None:
    shown = kernel_cell(printing(530) + "1 / 0\n")
    assert "ZeroDivisionError" in shown.err


def test_a_cells_endless_output_keeps_its_newest_lines() -> None:
    page = fold_lines([f"line {at}" for at in range(MAX_FOLDED_LINES)], MAX_FOLDED_LINES + 7)[
        "text/html"
    ]
    assert "The first 7 lines of these are in the log only." in page
