"""The way from the lab into the analyser."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.ui.app import Lab


def analyse(lab: Lab) -> None:
    """Show the log of the run at hand."""
    # The analyser costs time to import, and many never ask for it.
    from tuisim.ui.analyser.screen import Analyser
    from tuisim.ui.analyser.subject import Wanted

    lab.push_screen(Analyser(Wanted(runs=(lab.bridge.run_id,))))
