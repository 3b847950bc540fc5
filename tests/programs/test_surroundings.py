"""What is around a function."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from IPython.core.interactiveshell import InteractiveShell

import tuisim
from tests.cases import for_rows
from tuisim.base.syntax_tree import parse_expression
from tuisim.programs.function import read_function
from tuisim.programs.surroundings import compute


def run_cells(*cells: str) -> Callable[[], None]:
    """Run cells in a notebook of their own; return the function `go` that they define."""
    shell = InteractiveShell()
    for cell in cells:
        shell.run_cell(cell, store_history=True)
    go: Callable[[], None] = shell.user_ns["go"]
    return go


def test_the_classes_and_constants_of_other_cells_of_a_notebook_go_along() -> None:
    go = run_cells(
        "KP = 4\nKD = KP / 2",
        "class Half:\n    value = KD",
        "def go(): print(Half.value)",
    )
    assert "KD = KP / 2" in read_function(go).program.text
    assert tuisim.simulate(go).output == "2.0\n"


def test_using_an_instance_of_another_cell_keeps_a_functions_line_numbers() -> None:
    go = run_cells(
        "from typing import NamedTuple\n\nclass Step(NamedTuple):\n    turns: float",
        "\n\nSTEP = Step(2)",
        "# here\n\ndef go():\n    print(STEP.turns)\n    raise ValueError",
    )
    run = tuisim.simulate(go)
    assert (run.output, run.stored.end and run.stored.end.error_line) == ("2\n", 5)


VALUES: dict[str, Any] = {"KP": 4.0, "m": math, "sqrt": math.sqrt, "ask": input, "call": lambda: 1}
VALUES["array"] = np.arange(3)


@for_rows(
    "text, value",
    {
        "operators": ("KP / 8", "0.5"),
        "functions of math": ("sqrt(KP) + m.floor(m.pi)", "5.0"),
        "functions of Python": ("max(round(KP), 5)", "5"),
        "what asks": ("ask(KP)", None),
        "what the script defines": ("call()", None),
        "an attribute": ("KP.real", None),
        "what fails": ("KP / 0", None),
        "no constant": ("m", None),
        "an array": ("array * 2", None),
        "a comprehension": ("sum([KP * n for n in range(3)])", None),
        "a comprehension of constants": ("sum([KP * n for n in [1, 2]])", "12.0"),
    },
)
def test_only_expressions_of_constants_and_mathematics_are_evaluated_again(
    text: str, value: str | None
) -> None:
    assert compute(parse_expression(text).body, VALUES) == value
