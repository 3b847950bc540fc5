"""Mats that a seed draws: always the same, each another, and as their authors are told."""

from __future__ import annotations

import hashlib
import tomllib
from itertools import pairwise

import numpy as np
import pytest

from tuisim.commands.drawn_mats import DRAWN_MATS, generate_mat
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

SEEDS = range(12)
BANDS_OF_0 = "8a4511ccfc22"


@pytest.mark.parametrize("kind", DRAWN_MATS)
def test_a_seed_draws_the_same_mat_and_another_one_another(kind: str) -> None:
    found = [generate_mat(kind, seed) for seed in SEEDS]
    assert all(mat.pixels.shape == (FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3) for mat in found)
    digests = [hashlib.sha256(mat.pixels.tobytes()).hexdigest() for mat in found]
    assert len(set(digests)) == len(digests)
    assert digests[0] == hashlib.sha256(generate_mat(kind, 0).pixels.tobytes()).hexdigest()
    assert kind != "bands" or digests[0].startswith(BANDS_OF_0)


def test_bands_of_a_drawn_mat_have_the_stated_edges_and_greys() -> None:
    for seed in SEEDS:
        mat = generate_mat("bands", seed)
        row = mat.pixels[FIELD_HEIGHT_MM - 500, :, 0].astype(int)
        edges = np.flatnonzero(np.diff(row)) + 1
        assert edges.tolist() == [
            edge for left_mm, right_mm, _ in mat.bands for edge in (left_mm, right_mm)
        ]
        assert [level for *_, level in mat.bands] == [
            round(100 * row[int(left_mm)] / 255, 1) for left_mm, *_ in mat.bands
        ]
        assert mat.bands[-1][2] == 0 and 3 <= len(mat.bands) <= 5
        # A disc of 20 mm fits on each and between them.
        assert np.diff(edges).min() > 40


@pytest.mark.slow
def test_the_line_of_a_drawn_mat_is_unbroken_and_stays_on_the_mat() -> None:
    for seed in SEEDS:
        mat = generate_mat("line", seed)
        black = mat.pixels[:, :, 0] == 0
        rows = [np.flatnonzero(black[:, column]) for column in range(160, 2190)]
        assert all(len(found) and np.diff(found).max() == 1 for found in rows)
        assert (
            min(found[0] for found in rows) > 100
            and max(found[-1] for found in rows) < FIELD_HEIGHT_MM - 100
        )
        # No bend is a corner.
        middles = [found.mean() for found in rows]
        assert max(abs(after - before) for before, after in pairwise(middles)) < 3
        x_mm, y_mm, _ = mat.start
        assert black[int(FIELD_HEIGHT_MM - y_mm), int(x_mm)]


@pytest.mark.parametrize("kind", DRAWN_MATS)
def test_a_drawn_mats_printed_lines_are_a_valid_world_of_a_task(kind: str) -> None:
    lines = generate_mat(kind, 7).format_world_lines("m.png")
    (found,) = tomllib.loads("\n".join(lines))["also"]
    assert (found["background"], found["hidden"]) == ("m.png", True)
    # The goal of the bands is a remark: its name is the author's.
    remarks = [
        line.removeprefix("# ")
        for line in lines
        if line.startswith("# ") and "band from" not in line
    ]
    goals = tomllib.loads("\n".join([*lines, *remarks]))["also"][0].get("goal", [])
    assert [goal["log"]["levels"][-1] for goal in goals] == ([0] if kind == "bands" else [])
