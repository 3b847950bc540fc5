"""How close the drawn world comes to the true picture with each set of glyphs, and what drawing it costs."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from textual._compositor import LayoutUpdate
from textual.geometry import Region

from tests.bench.figures import Figure
from tests.bench.sampling import QUICK, Effort
from tuisim.app.setup.mat import prepare_mat
from tuisim.config.build import build_run_spec
from tuisim.config.mats import mats
from tuisim.config.options import Settings
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.spec import RobotSpec
from tuisim.errors import BackgroundError
from tuisim.scene.mat import shrink
from tuisim.scene.painter import ScenePainter, SceneState
from tuisim.scene.pen import PenTrace
from tuisim.scene.robot import COLORED, draw_robot
from tuisim.scene.view import Viewport, whole_field
from tuisim.terminal.cell_view import CellStrip
from tuisim.terminal.cells import changed_cells, changed_runs
from tuisim.terminal.fitted_cells import Cells, all_cells, fit_cells
from tuisim.terminal.frame_buffer import FrameBuffer, TextMode
from tuisim.terminal.glyphs import glyph_set
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import CellPoints, Pixels

COLS, ROWS = 74, 36
"""Cells of the world at 120 × 40."""
CELL_PX = (16, 32)
"""Columns and rows of the true picture in a cell."""
SETS = (CellSet.HALF, CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT)
HEADINGS_DEG = tuple(range(0, 360, 10))
ROBOT = RobotSpec()
MIDDLE_MM = (1181.0, 571.0)
GROUND = (16, 21, 28)

Rgb = npt.NDArray[np.float64]
Errors = npt.NDArray[np.float64]
Lab = npt.NDArray[np.float32]


def lab_of(rgb: Rgb) -> Lab:
    """Return CIE L*a*b* (D65) of sRGB values of 0 to 255."""
    light = rgb / 255
    light = np.where(light <= 0.04045, light / 12.92, ((light + 0.055) / 1.055) ** 2.4)
    xyz = (
        light
        @ np.array(
            [
                [0.4124564, 0.2126729, 0.0193339],
                [0.3575761, 0.7151522, 0.1191920],
                [0.1804375, 0.0721750, 0.9503041],
            ]
        )
        / np.array([0.95047, 1.0, 1.08883])
    )
    root = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * (29 / 6) ** 2 / 3 + 4 / 29)
    x, y, z = root[..., 0], root[..., 1], root[..., 2]
    return np.stack((116 * y - 16, 500 * (x - y), 200 * (y - z)), axis=-1).astype(np.float32)


def averaged(mat: Pixels, view: Viewport) -> Errors:
    """Return what a viewport shows of a mat: the mean over the area of each pixel, however small."""
    height_mm, width_mm = mat.shape[:2]

    def weights(first_mm: float, mm_per_px: float, count: int, size_mm: int) -> Errors:
        edges = first_mm + np.arange(count + 1) * mm_per_px
        low, high = edges[:-1, None], edges[1:, None]
        at = np.arange(size_mm)[None]
        shares: Errors = (
            np.clip(np.minimum(high, at + 1) - np.maximum(low, at), 0, None) / mm_per_px
        )
        return shares

    across = weights(view.left_mm, view.mm_per_px, view.width_px, width_mm)
    down = weights(height_mm - view.top_mm, view.mm_per_row, view.height_px, height_mm)
    shown = np.stack([down @ mat[..., channel] @ across.T for channel in range(3)], axis=-1)
    on_mat = (down.sum(axis=1)[:, None] * across.sum(axis=1)[None])[..., None]
    whole: Rgb = shown + (1 - on_mat) * np.array(GROUND)
    return whole


@lru_cache(maxsize=8)
def rasterised(cells: CellSet) -> npt.NDArray[np.bool_]:
    """Return which pixels of a cell each glyph of a set covers, shape (glyphs, pixels of the cell)."""
    glyphs = glyph_set(cells)
    down = ((np.arange(CELL_PX[1]) + 0.5) * glyphs.rows / CELL_PX[1]).astype(int)
    across = ((np.arange(CELL_PX[0]) + 0.5) * glyphs.cols / CELL_PX[0]).astype(int)
    points = (down[:, None] * glyphs.cols + across[None]).ravel()
    return glyphs.covered[:, points] > 0.5


def in_cells(picture: Rgb) -> Rgb:
    """Return the pixels of a true picture by cell, shape (cells, pixels of a cell, 3)."""
    rows, cols = len(picture) // CELL_PX[1], picture.shape[1] // CELL_PX[0]
    by_cell = picture.reshape(rows, CELL_PX[1], cols, CELL_PX[0], 3).transpose(0, 2, 1, 3, 4)
    return by_cell.reshape(rows * cols, -1, 3)


def drawn_error(cells: Cells, cell_set: CellSet, truth: Lab) -> Errors:
    """Return the mean colour difference (CIE76) of each cell."""
    glyphs, flat = glyph_set(cell_set), cells.ravel()
    which = np.searchsorted(glyphs.numbers, flat >> 48).clip(max=len(glyphs.numbers) - 1)
    colors = np.stack((flat >> 24, flat), axis=-1)[..., None] >> np.array([16, 8, 0]) & 255
    lab = lab_of(colors.astype(float))
    covered = rasterised(cell_set)[which][..., None]
    shown = np.where(covered, lab[:, None, 0], lab[:, None, 1])
    found: Errors = np.sqrt(np.square(shown - truth).sum(axis=2)).mean(axis=1)
    return found


def best_error(rgb: Rgb, truth: Lab, cell_set: CellSet) -> Errors:
    """Return the mean colour difference of each cell with its best split, every glyph tried with the mean colours."""
    best = np.full(len(rgb), np.inf, np.float64)
    for covered in rasterised(cell_set):
        error = np.zeros(len(rgb))
        for part in (covered, ~covered):
            mean = lab_of(rgb[:, part].mean(axis=1, keepdims=True))
            error += np.sqrt(np.square(truth[:, part] - mean).sum(axis=2)).sum(axis=1)
        best = np.minimum(best, error / truth.shape[1])
    return best


def errors_of(mat: Pixels, cell_set: CellSet, headings: tuple[int, ...]) -> tuple[float, float]:
    """Return the mean colour difference of a mat with the robot: as drawn, and of the best splits."""
    glyphs = glyph_set(cell_set)
    view = whole_field(COLS * glyphs.cols, ROWS * glyphs.rows, CellPoints(glyphs.cols, glyphs.rows))
    true_view = Viewport(
        COLS * CELL_PX[0],
        ROWS * CELL_PX[1],
        view.mm_per_px * glyphs.cols / CELL_PX[0],
        view.left_mm,
        view.top_mm,
        CellPoints(*CELL_PX),
    )
    truth = averaged(mat, true_view)
    ground = in_cells(truth)
    picture = shrink(mat, view, GROUND)
    cells = fit_cells(picture, glyphs, all_cells(ROWS, COLS))
    drawn, best = _compared(cells, cell_set, ground)
    totals = np.zeros(2)
    for heading in headings:
        pose = Pose(*MIDDLE_MM, heading)
        now, real = picture.copy(), np.rint(truth).astype(np.uint8)
        draw_robot(now, view, pose, outline_of(ROBOT), COLORED)
        draw_robot(
            real, true_view, pose, outline_of(ROBOT), COLORED, detail_cols=min(glyphs.cols, 2)
        )
        at = changed_cells(picture, now, glyphs)
        flat = at[0] * COLS + at[1]
        with_robot = _compared(
            fit_cells(now, glyphs, at), cell_set, in_cells(real.astype(float))[flat]
        )
        for which, (without, among) in enumerate(zip((drawn, best), with_robot, strict=True)):
            totals[which] += without.sum() - without[flat].sum() + among.sum()
    drawn_mean, best_mean = totals / len(headings) / (ROWS * COLS)
    return float(drawn_mean), float(best_mean)


def _compared(cells: Cells, cell_set: CellSet, rgb: Rgb) -> tuple[Errors, Errors]:
    """Return the colour difference of each cell as drawn, and with its best split."""
    truth = lab_of(rgb)
    best = np.zeros(len(rgb))
    uneven = np.flatnonzero(np.ptp(rgb, axis=1).max(axis=1) > 0)
    for first in range(0, len(uneven), 256):
        some = uneven[first : first + 256]
        best[some] = best_error(rgb[some], truth[some], cell_set)
    return drawn_error(cells, cell_set, truth), best


def frame_cpu_s(mat: Pixels, cell_set: CellSet, frames: int) -> float:
    """Return the CPU that drawing a frame takes while the robot drives a circle with its rays on."""
    glyphs = glyph_set(cell_set)
    view = whole_field(COLS * glyphs.cols, ROWS * glyphs.rows, CellPoints(glyphs.cols, glyphs.rows))
    painter = ScenePainter(mat, GROUND, PenTrace())
    picture = painter.paint(view, _driving(0))
    cells = fit_cells(picture, glyphs, all_cells(ROWS, COLS)).reshape(ROWS, COLS)
    began = time.process_time()
    for frame in range(1, frames + 1):
        before, picture = picture, painter.paint(view, _driving(frame))
        at = changed_cells(before, picture, glyphs)
        now = cells.copy()
        now[at] = fit_cells(picture, glyphs, at)
        changed_runs(cells, now)
        cells = now
    return (time.process_time() - began) / frames


def frame_bytes(mat: Pixels, cell_set: CellSet, frames: int) -> float:
    """Return the bytes of a frame of the world in full colour while the robot drives a circle with its rays on."""
    glyphs = glyph_set(cell_set)
    view = whole_field(COLS * glyphs.cols, ROWS * glyphs.rows, CellPoints(glyphs.cols, glyphs.rows))
    painter, buffer = ScenePainter(mat, GROUND, PenTrace()), FrameBuffer()
    picture = painter.paint(view, _driving(0))
    cells = fit_cells(picture, glyphs, all_cells(ROWS, COLS)).reshape(ROWS, COLS)
    sent = [_sent(buffer, cells)]
    for frame in range(1, frames + 1):
        before, picture = picture, painter.paint(view, _driving(frame))
        at = changed_cells(before, picture, glyphs)
        cells[at] = fit_cells(picture, glyphs, at)
        sent.append(_sent(buffer, cells))
    return sum(sent[1:]) / frames


def _sent(buffer: FrameBuffer, cells: Cells) -> int:
    update = LayoutUpdate([[CellStrip(row)] for row in cells.tolist()], Region(0, 0, COLS, ROWS))
    return len((buffer.codes(update, TextMode()) or "").encode())


def _driving(frame: int) -> SceneState:
    turn = frame * 0.03
    pose = Pose(1181 + 400 * math.cos(turn), 571 + 300 * math.sin(turn), math.degrees(turn) + 90)
    return SceneState(
        ROBOT, pose, rays=tuple((pose.heading_deg + aside, 600.0) for aside in range(-21, 22, 7))
    )


def cells(effort: Effort) -> Iterator[Figure]:
    """Yield for each set the colour error by mat, its sum, how near it is to the best splits, and the CPU a frame."""
    headings = HEADINGS_DEG if effort.repeats > QUICK.repeats else HEADINGS_DEG[::6]
    drawn, best = dict.fromkeys(SETS, 0.0), dict.fromkeys(SETS, 0.0)
    last: Pixels | None = None
    for name in mats():
        try:
            last = np.asarray(prepare_mat(build_run_spec(Settings({"background": name}))).pixels)
        except BackgroundError:
            # Its image is not part of this project.
            continue
        for cell_set in SETS:
            error, least = errors_of(last, cell_set, headings)
            drawn[cell_set] += error
            best[cell_set] += least
            yield Figure(f"{name}, {cell_set}", error, "ΔE")
    for cell_set in SETS:
        most = 0.70 if cell_set is CellSet.OCTANT else None
        yield Figure(
            f"all mats, {cell_set}, of half blocks",
            drawn[cell_set] / drawn[CellSet.HALF],
            "",
            most=most,
        )
        yield Figure(
            f"all mats, {cell_set}, of the best splits",
            drawn[cell_set] / best[cell_set],
            "",
            most=1.05,
        )
    assert last is not None
    half_bytes = frame_bytes(last, CellSet.HALF, 120)
    for cell_set in SETS:
        many = frame_bytes(last, cell_set, 120)
        yield Figure(
            f"bytes of a frame, {cell_set}, of half blocks", many / half_bytes, "", most=1.6
        )
    for cell_set in SETS:
        cpu_s = min(frame_cpu_s(last, cell_set, 100) for _ in range(effort.repeats))
        yield Figure(f"drawing a frame, {cell_set}", 1e3 * cpu_s, "ms CPU")
