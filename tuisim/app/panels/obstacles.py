"""The obstacles panel, a list of boxes to edit; and obstacles that the mouse draws and drags in the world."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Label, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.form import EntryPanel, format_error, parse_number
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, ObstacleError
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle

if TYPE_CHECKING:
    from tuisim.app.setup.next_run import NextRun
    from tuisim.app.snapshot import Snapshot

Boxes: TypeAlias = tuple[Obstacle, ...]

_FIELDS = {"x_mm": "X", "y_mm": "Y", "width_mm": "W", "height_mm": "H"}
_NEW_SIZE_MM = 200.0
_GAP_MM = 20.0
"""The distance that new obstacles keep from each other."""
_NONE = "none: + or drag adds one"


def label_box(number: int, box: Obstacle) -> str:
    """Return an obstacle as an entry of the list: its number, its size in mm, and the position of its corner in mm."""
    return f"{number:>2}  {box.width_mm:g}×{box.height_mm:g} at {box.x_mm:g}, {box.y_mm:g}"


def add_box(boxes: Boxes) -> Boxes:
    """Return the obstacles with a new one: in the middle of the field or, if that is taken, at a free place near it."""
    half_mm = _NEW_SIZE_MM / 2
    xs_mm, ys_mm = map(_list_places_mm, (FIELD_WIDTH_MM, FIELD_HEIGHT_MM))
    places = [(x_mm, y_mm) for y_mm in ys_mm for x_mm in xs_mm]
    free = (
        (x_mm, y_mm)
        for x_mm, y_mm in places
        if find_box(boxes, x_mm + half_mm, y_mm + half_mm, half_mm) is None
    )
    return (*boxes, Obstacle(*next(free, places[0]), _NEW_SIZE_MM, _NEW_SIZE_MM))


def _list_places_mm(side_mm: float) -> list[float]:
    """Return where a new obstacle may begin along a side of the field, in mm, from its middle outwards.

    Args:
        side_mm: Length of the side.
    """
    middle_mm = (side_mm - _NEW_SIZE_MM) // 2
    step_mm = _NEW_SIZE_MM + _GAP_MM
    steps = int(middle_mm / step_mm)
    return [
        middle_mm + step_mm * step
        for step in sorted(range(-steps, steps + 1), key=lambda step: (abs(step), -step))
    ]


def _replace_box(index: int, by: Boxes, boxes: Boxes) -> Boxes:
    return (*boxes[:index], *by, *boxes[index + 1 :])


class Obstacles(EntryPanel):
    """The obstacles panel: the list of obstacles, and the four numbers of the selected one."""

    USE = "Drag to draw another"
    BINDINGS: ClassVar[list[BindingType]] = [
        ("plus,insert", "add", "Add"),
        ("delete,backspace,minus", "remove", "Remove"),
    ]

    @dataclass
    class Edited(Message):
        """Posted when the user has edited the obstacles."""

        change: Callable[[Boxes], Boxes]
        """Returns the obstacles with this edit; called with those of the plan when the message arrives."""

    @dataclass
    class Marked(Message):
        """Posted when the user has selected another obstacle."""

        index: int | None

    def __init__(self) -> None:
        super().__init__()
        self._boxes: tuple[Obstacle, ...] = ()
        self.at: int | None = None
        """Index of the selected obstacle."""

    def compose(self) -> ComposeResult:
        yield OptionList(compact=True)
        for pair in (("x_mm", "y_mm"), ("width_mm", "height_mm")):
            with Horizontal(classes="field"):
                for field in pair:
                    yield Label(_FIELDS[field], markup=False)
                    yield Input(id=field, compact=True, select_on_focus=True)
        with Horizontal(classes="links"):
            yield Static("[@click=add]+ Add[/]")
            yield Static("[@click=remove]- Remove[/]")
        with Horizontal(classes="links"):
            yield Static("[@click=app.act('obstacles')]k Sets[/]")
            yield Static("[@click=app.act('save-obstacles')]ctrl+o Save[/]")
        yield Static(self.USE, id="message", markup=False)

    def show(self, snapshot: Snapshot) -> None:
        """Do nothing: the panel shows the plan of the next run, not an instant."""

    def show_next_run(self, plan: NextRun) -> None:
        """Show the obstacles of the next run."""
        boxes = plan.spec.world.obstacles
        if not self.is_mounted or (
            boxes == self._boxes and self.query_one(OptionList).option_count
        ):
            return
        before = self._boxes
        self._boxes = boxes
        if len(boxes) > len(before) and boxes[: len(before)] == before:
            self.at = len(boxes) - 1
        elif self.at is None or self.at >= len(boxes):
            self.at = len(boxes) - 1 if boxes else None
        self._list()
        self._show_box()
        self.post_message(self.Marked(self.at))

    def begin(self) -> None:
        """Focus the list of obstacles, in which letters are still keys of the app."""
        self.query_one(OptionList).focus()
        self.post_message(self.Marked(self.at))

    def mark(self, index: int | None) -> None:
        """Select another obstacle by its index; None selects none."""
        self.query_one(OptionList).highlighted = index

    def _list(self) -> None:
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options(
            [
                Option(label_box(number, box), id=str(number))
                for number, box in enumerate(self._boxes, start=1)
            ]
        )
        if not self._boxes:
            listed.add_option(Option(_NONE, disabled=True))
        listed.highlighted = self.at

    def _show_box(self) -> None:
        box = self._boxes[self.at] if self.at is not None else None
        for field in _FIELDS:
            entry = self.query_one(f"#{field}", Input)
            entry.value = f"{getattr(box, field):g}" if box else ""
            entry.disabled = box is None
            entry.remove_class("wrong")
        self.say("")

    @on(OptionList.OptionHighlighted)
    def _mark_highlighted(self, event: OptionList.OptionHighlighted) -> None:
        event.stop()
        if self._boxes and event.option_index != self.at:
            self.at = event.option_index
            self._show_box()
            self.post_message(self.Marked(self.at))

    @on(OptionList.OptionSelected)
    def _edit_selected(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.query_one("#x_mm", Input).focus()

    def _apply(self, entry: Input) -> None:
        if self.at is None or entry.value == f"{getattr(self._boxes[self.at], entry.id or ''):g}":
            entry.remove_class("wrong")
            return
        try:
            changed = {entry.id or "": parse_number(entry.value, ObstacleError)}
            box = replace(self._boxes[self.at], **changed)
        except ConfigError as error:
            entry.add_class("wrong")
            self.say(f"{_FIELDS[entry.id or '']} {format_error(error)}")
            return
        self.post_message(self.Edited(partial(_replace_box, self.at, (box,))))

    def action_add(self) -> None:
        self.post_message(self.Edited(add_box))

    def action_remove(self) -> None:
        if self.at is None:
            self.say("No obstacle to remove")
            return
        self.post_message(self.Edited(partial(_replace_box, self.at, ())))


GRID_MM = 5.0
"""Positions and sizes set with the mouse are multiples of this."""
MIN_BOX_MM = 20.0
"""A drag smaller than this is a click."""


def _snap_mm(value_mm: float) -> float:
    return round(value_mm / GRID_MM) * GRID_MM


def find_box(boxes: Sequence[Obstacle], x_mm: float, y_mm: float, slack_mm: float) -> int | None:
    """Return the index of the topmost obstacle at a point of the field; None if there is none.

    Args:
        boxes: The obstacles; later ones are on top.
        x_mm: World x.
        y_mm: World y.
        slack_mm: Tolerance around an obstacle, which may be thinner than a cell.
    """
    for index in reversed(range(len(boxes))):
        box = boxes[index]
        right = box.x_mm + box.width_mm
        upper = box.y_mm + box.height_mm
        if (
            box.x_mm - slack_mm <= x_mm <= right + slack_mm
            and box.y_mm - slack_mm <= y_mm <= upper + slack_mm
        ):
            return index
    return None


@dataclass(frozen=True, slots=True)
class BoxGrip:
    """A drag of the mouse that moves an obstacle or draws a new one."""

    boxes: tuple[Obstacle, ...]
    """The boxes at the start of the drag."""
    index: int | None
    """The box that is dragged; None draws a new one."""
    x_mm: float
    y_mm: float

    def drag_boxes(self, x_mm: float, y_mm: float) -> tuple[tuple[Obstacle, ...], int] | None:
        """Return the obstacles after a drag to a point of the field in mm, and the index of the dragged one.

        The result is None if nothing has changed.
        """
        if self.index is None:
            box = self._draw_box(x_mm, y_mm)
            return None if box is None else ((*self.boxes, box), len(self.boxes))
        box = self.boxes[self.index]
        x = min(
            max(_snap_mm(box.x_mm + x_mm - self.x_mm), -box.width_mm / 2),
            FIELD_WIDTH_MM - box.width_mm / 2,
        )
        y = min(
            max(_snap_mm(box.y_mm + y_mm - self.y_mm), -box.height_mm / 2),
            FIELD_HEIGHT_MM - box.height_mm / 2,
        )
        moved = replace(box, x_mm=x, y_mm=y)
        return (*self.boxes[: self.index], moved, *self.boxes[self.index + 1 :]), self.index

    def _draw_box(self, x_mm: float, y_mm: float) -> Obstacle | None:
        left, right = sorted(_snap_mm(min(max(x, 0.0), FIELD_WIDTH_MM)) for x in (self.x_mm, x_mm))
        lower, upper = sorted(
            _snap_mm(min(max(y, 0.0), FIELD_HEIGHT_MM)) for y in (self.y_mm, y_mm)
        )
        if right - left < MIN_BOX_MM or upper - lower < MIN_BOX_MM:
            return None
        return Obstacle(left, lower, right - left, upper - lower)
