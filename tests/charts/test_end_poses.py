"""End poses over the mat: which part of the field is drawn, and what of the poses."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.charts.end_poses import EndPoses, PoseGroup, drawing_of_poses, mat_cells, text_of_poses
from tuisim.charts.files import image_of, svg_of
from tuisim.charts.layout import Raster, Stroke
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

MAT = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)
MAT[:, :100] = 0
WHOLE = (0.0, FIELD_WIDTH_MM), (0.0, FIELD_HEIGHT_MM)


def group(x_mm: list[float], y_mm: list[float], label: str = "") -> PoseGroup:
    return PoseGroup(label, np.array(x_mm), np.array(y_mm), np.zeros(len(x_mm)))


def poses(*groups: PoseGroup) -> EndPoses:
    return EndPoses("End poses", MAT, groups)


NEAR = poses(
    group([800.0, 810, 805], [500.0, 520, 510], "noise.motor 0"),
    group([790.0, 850], [480.0, 560], "noise.motor 50"),
)
FAR = poses(group([100.0, 2000], [100.0, 1000]))
OFF = poses(group([100.0, 2500], [100.0, 1000]))
NONE = poses(group([], []))


@pytest.mark.parametrize(
    "found, limits",
    [
        pytest.param(FAR, WHOLE, id="far apart"),
        pytest.param(NONE, WHOLE, id="no poses"),
        pytest.param(poses(group([50.0], [60.0])), ((37, 63), (47, 73)), id="one pose"),
    ],
)
def test_the_part_of_the_field_holds_every_pose(found: EndPoses, limits: object) -> None:
    assert found.limits() == limits


@pytest.mark.quick_cases("size1-*")
@pytest.mark.parametrize(
    "found", [NEAR, FAR, OFF, NONE], ids=["near", "far", "off the field", "none"]
)
@pytest.mark.parametrize("size", [(960, 600), (200, 150)])
def test_end_poses_are_written_as_svg_and_png(found: EndPoses, size: tuple[int, int]) -> None:
    drawing = drawing_of_poses(found, *size)
    assert svg_of(drawing).endswith("</svg>\n")
    assert image_of(drawing).size == size


def test_the_scales_of_both_axes_are_equal() -> None:
    for found in (NEAR, FAR):
        raster = next(
            shape for shape in drawing_of_poses(found, 960, 600).shapes if isinstance(shape, Raster)
        )
        points = next(
            s.points
            for s in drawing_of_poses(found, 960, 600).shapes
            if isinstance(s, Stroke) and s.dots and len(s.points) > 1
        )
        assert (points[:, 0] >= raster.x).all() and (points[:, 0] <= raster.x + raster.width).all()
        across, up = np.abs(np.diff(points, axis=0))[0]
        one = found.groups[-1]
        assert across / up == pytest.approx(np.ptp(one.x_mm) / np.ptp(one.y_mm))


def test_runs_off_the_field_are_counted() -> None:
    assert OFF.note() == "1 run ended off the field"
    assert OFF.note() in text_of_poses(OFF, 80, 24, colors=False).plain


def test_the_mat_is_behind_the_poses() -> None:
    cells = mat_cells(MAT, (-100, 300), (0, 400), 4, 2)
    assert cells[0].tolist() == [[160] * 3, [178] * 3, [255] * 3, [255] * 3]


@pytest.mark.parametrize("size", [(80, 24), (120, 40), (40, 12)])
@pytest.mark.parametrize("colors", [True, False])
def test_text_fits_the_terminal(size: tuple[int, int], colors: bool) -> None:
    for found in (NEAR, FAR):
        lines = text_of_poses(found, *size, colors=colors).plain.split("\n")
        assert max(map(len, lines)) <= size[0]
        assert len(lines) <= size[1]


def test_groups_have_marks_of_their_own_without_colours() -> None:
    text = text_of_poses(NEAR, 80, 24, colors=False).plain
    assert "● noise.motor 0: x 805.0 ± 4.1, y 510.0 ± 8.2 mm" in text
    assert text.count("▲") == 3


def test_the_first_group_is_on_top_in_colours() -> None:
    both = poses(group([800.0], [500.0], "a"), group([800.0, 850], [500.0, 550], "b"))
    text = text_of_poses(both, 80, 24, colors=True)
    dots = {at for at, letter in enumerate(text.plain) if "\u2800" <= letter <= "\u28ff"}
    assert len({str(span.style).split(" on ")[0] for span in text.spans if span.start in dots}) == 2
