"""Where on the mat a class missed its goals: one picture with a dot for each student and goal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tuisim.analysis.pins import Dot, Picture, clamp_to_picture, encode_picture
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted, listed
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.pictures.scene.pictures import build_world_view, draw_world
from tuisim.pictures.scene.view import Viewport

_DOT_PX = 5.0
_GRID_PX = 1.3
"""Places that are nearer to each other share a dot."""


@dataclass(frozen=True, slots=True)
class Miss:
    """A goal that a student's run missed, with the place at which to mark it on the map of the class."""

    student: str
    goal: str
    x_mm: float
    y_mm: float
    reason: str


@dataclass(frozen=True, slots=True)
class MissesOfRun:
    """A stored run, with the goals that it missed, for the map of the class."""

    run: StoredRun
    misses: tuple[Miss, ...]

    @property
    def mat(self) -> str:
        """The name of the run's mat, or the path of its image."""
        return self.run.spec.world.background


def build_class_maps(runs: Sequence[MissesOfRun]) -> list[Picture]:
    """Return a picture of each mat with the places where runs missed goals; the mat with the most misses first.

    A mat that can no longer be drawn is left out: the reports of the runs on it say why.
    """
    count = Counter[str]()
    for run_misses in runs:
        count[run_misses.mat] += len(run_misses.misses)
    maps = [
        _build_map([run_misses for run_misses in runs if run_misses.mat == mat])
        for mat, number in count.most_common()
        if number
    ]
    return [picture for picture in maps if picture is not None]


def _build_map(runs: Sequence[MissesOfRun]) -> Picture | None:
    first = runs[0].run
    misses = [miss for run_misses in runs for miss in run_misses.misses]
    try:
        picture = draw_world(first.spec, first.find_mat_files().read_pixels())
    except LogError:
        return None
    students = {miss.student for miss in misses}
    view = build_world_view(first.spec.robot)
    return Picture(
        f"Where goals were missed, {counted(len(misses), 'time')} by {counted(len(students), 'student')}: each dot "
        "says whose it is; a dot at the edge may be farther off the mat, and says how far",
        encode_picture(picture),
        picture.size,
        view,
        dots=_place_dots(view, misses),
    )


def _place_dots(view: Viewport, misses: Sequence[Miss]) -> tuple[Dot, ...]:
    places: dict[tuple[str, int, int], list[Miss]] = {}
    for miss in misses:
        x_px, y_px, _ = clamp_to_picture(view, miss.x_mm, miss.y_mm)
        key = (miss.goal, round(x_px / _GRID_PX), round(y_px / _GRID_PX))
        places.setdefault(key, []).append(miss)
    dots = []
    for same in places.values():
        first = same[0]
        x_px, y_px, away = clamp_to_picture(view, first.x_mm, first.y_mm)
        head = f"{first.goal}: {listed([miss.student for miss in same])}"
        text = "\n".join(filter(None, (head, first.reason, away)))
        dots.append(Dot(x_px, y_px, _DOT_PX * len(same) ** 0.33, first.goal, text))
    return tuple(dots)
