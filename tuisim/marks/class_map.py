"""Where on the mat a class missed its goals: one picture with a dot for each student and goal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tuisim.analysis.report import picture_source
from tuisim.charts.files import clean
from tuisim.config.mat_cache import mat_pixels
from tuisim.core.spec import RunSpec
from tuisim.data_class import dataclass
from tuisim.errors import LogError, listed
from tuisim.palette import MISSED
from tuisim.runs.run_folder import StoredRun, mat_files
from tuisim.scene.pictures import world_picture, world_view

_DOT_PX = 5.0
_GRID_MM = 4.0
"""Places nearer than this share a dot."""


@dataclass(frozen=True, slots=True)
class Miss:
    """Where a student's run missed a goal."""

    student: str
    goal: str
    x_mm: float
    y_mm: float
    reason: str


@dataclass(frozen=True, slots=True)
class MissesOfRun:
    """The misses of a stored run."""

    run: StoredRun
    misses: tuple[Miss, ...]

    @property
    def mat(self) -> str:
        """The mat on which it was."""
        return self.run.spec.world.background


def class_maps(found: Sequence[MissesOfRun]) -> list[str]:
    """Return a figure for each mat on which goals were missed, as HTML; the mat with the most misses first."""
    count = Counter[str]()
    for one in found:
        count[one.mat] += len(one.misses)
    return [
        _figure([one for one in found if one.mat == mat])
        for mat, number in count.most_common()
        if number
    ]


def _figure(found: Sequence[MissesOfRun]) -> str:
    first, misses = found[0].run, [miss for one in found for miss in one.misses]
    try:
        picture = world_picture(first.spec, mat_pixels(mat_files(first)))
    except LogError:
        # The reports of its runs say why there is none.
        return ""
    text = f"Where goals were missed: {len(misses)} places of {len({miss.student for miss in misses})} students"
    size = f'width="{picture.width}" height="{picture.height}"'
    image = f'<img src="{picture_source(picture)}" {size} alt="{clean(text)}">'
    return (
        f'<figure><div class="map">{image}{_dots(first.spec, misses)}</div>'
        f"<figcaption>{clean(text)}; a dot tells whose it is</figcaption></figure>"
    )


def _dots(spec: RunSpec, misses: Sequence[Miss]) -> str:
    view = world_view(spec.robot)
    places: dict[tuple[str, int, int], list[Miss]] = {}
    for miss in misses:
        key = (miss.goal, round(miss.x_mm / _GRID_MM), round(miss.y_mm / _GRID_MM))
        places.setdefault(key, []).append(miss)
    drawn = "".join(_dot(*view.to_px(same[0].x_mm, same[0].y_mm), same) for same in places.values())
    return f'<svg class="pins misses" viewBox="0 0 {view.width_px} {view.height_px}">{drawn}</svg>'


def _dot(x_px: float, y_px: float, misses: Sequence[Miss]) -> str:
    radius = _DOT_PX * len(misses) ** 0.33
    said = f"{misses[0].goal}: {listed([miss.student for miss in misses])}\n{misses[0].reason}"
    return (
        f'<circle cx="{x_px:.1f}" cy="{y_px:.1f}" r="{radius:.1f}" fill="{MISSED}66" stroke="{MISSED}" '
        f'data-goal="{clean(misses[0].goal)}"><title>{clean(said)}</title></circle>'
    )
