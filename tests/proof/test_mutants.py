"""Flips of comparisons and operators: which there are, where they stand, and that a test finds one in a copy."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.cases import for_rows
from tests.conftest import ROOT
from tests.proof.__main__ import main
from tests.proof.mutants import draw_mutants, find_failure, find_mutants, find_tests


@for_rows(
    "text, flips",
    [
        ("a < b", ["a <= b", "a >= b"]),
        ("a == b", ["a != b"]),
        ("a is not b", ["a is b"]),
        ("0 <= a < b", ["0 < a < b", "0 > a < b", "0 <= a <= b", "0 <= a >= b"]),
        ("a and b and c", ["a or b or c"]),
        ("a + b * c", ["a - b * c", "b / c"]),
        ("-a", ["+a"]),
        ("f'{a < b}'", []),
        ("a | b", []),
    ],
)
def test_each_comparison_and_operator_is_flipped(text: str, flips: list[str]) -> None:
    assert [mutant.new for mutant in find_mutants("a.py", text)] == flips


def test_a_mutant_changes_only_its_operator_and_keeps_line_numbers() -> None:
    text = "x = 'ä', (1 +\n  2) * 3\ny = 4\n"
    (product, _) = find_mutants("a.py", text)
    assert (product.line, product.old, product.new) == (1, "(1 + 2) * 3", "(1 + 2) / 3")
    assert ast.unparse(ast.parse(product.text)) == "x = ('ä', (1 + 2) / 3)\ny = 4"
    assert product.text.endswith("\n)\ny = 4\n")


@pytest.mark.slow
def test_a_seed_draws_the_same_mutants() -> None:
    drawn = draw_mutants(["engine/core", "tuisim/pictures/scene"], 7, 300)
    assert (len(drawn), {mutant.room for mutant in drawn}) == (
        300,
        {"engine/core", "pictures/scene"},
    )
    assert draw_mutants(["engine/core", "pictures/scene"], 7, 300) == drawn
    assert draw_mutants(["engine/core", "pictures/scene"], 8, 300) != drawn
    place = f"{drawn[0].file}:{drawn[0].line}"
    operators = {mutant.operator for mutant in draw_mutants([place], 1, 100)}
    assert drawn[0].operator in operators


def test_the_tests_of_a_mutated_module_are_those_at_its_path() -> None:
    tests = ["tests/engine/core/test_spec.py", "tests/engine/core/test_spec_fields.py"]
    assert find_tests("engine/core/spec.py") == tests


@pytest.mark.proof
def test_a_mutants_test_that_takes_too_much_cpu_counts_as_failed(tmp_path: Path) -> None:
    test = tmp_path / "test_endless.py"
    test.write_text("def test_endless():\n    while True:\n        pass\n")
    assert find_failure([str(test)], ROOT, 10) == "CPU limit"


@pytest.mark.proof
def test_tests_find_a_mutant_planted_in_a_copy(capsys: pytest.CaptureFixture[str]) -> None:
    rows = (ROOT / "tuisim/engine/core/geometry.py").read_text().splitlines()
    line = next(number for number, row in enumerate(rows, 1) if "return pose.x_mm" in row)
    assert main(["mutants", f"engine/core/geometry.py:{line}", "--count", "1", "--seed", "1"]) == 0
    assert capsys.readouterr().out.endswith("\n1 of 1 found (seed 1)\n")
