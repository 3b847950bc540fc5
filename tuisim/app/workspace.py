"""The parts of the app that actions work on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.app.debugger import DebugController
    from tuisim.app.editor.document import Document
    from tuisim.app.lesson import LessonController
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.app.services import AppServices


@dataclass(frozen=True, slots=True)
class Workspace:
    """What the functions behind the keys get."""

    app: AppServices
    run_controller: RunController
    panel_area: PanelArea
    document: Document
    loader: Loader
    debugger: DebugController
    lesson: LessonController
