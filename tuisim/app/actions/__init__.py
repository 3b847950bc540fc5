"""What the keys do, one file for each group, and the table of the keys."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

from tuisim.app.reason_tour import ReasonTour
from tuisim.base.data_class import dataclass

if TYPE_CHECKING:
    from tuisim.app.debugger import DebugController
    from tuisim.app.editor.document import Document
    from tuisim.app.host import LabHost
    from tuisim.app.lesson import LessonController
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController


@dataclass(frozen=True, slots=True)
class ActionContext:
    """The controllers and panels of the app; each function that a key runs gets them as its first argument."""

    app: LabHost
    runs: RunController
    panels: PanelArea
    document: Document
    loader: Loader
    debugger: DebugController
    lesson: LessonController
    reasons: ReasonTour = field(default_factory=ReasonTour)
