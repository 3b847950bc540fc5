"""Keys of the app: help, redraw, suspend, quit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.app.app import LabApp


def show_help(lab: LabApp) -> None:
    """Show every key."""
    from tuisim.app.keys.app_help import HelpScreen

    lab.push_screen(HelpScreen())


def redraw(lab: LabApp) -> None:
    """Redraw the whole screen."""
    lab.action_redraw()


def suspend(lab: LabApp) -> None:
    """Suspend the app as a shell job; a live run is paused first."""
    lab.action_suspend_process()


def leave(lab: LabApp) -> None:
    """Quit; with unsaved changes or a running program, ask first."""
    lab.work.when_safe(lambda: _leave(lab))


def _leave(lab: LabApp) -> None:
    if not lab.bridge.in_run:
        lab.exit()
        return
    from tuisim.app.dialogs.question import LeaveQuestion

    lab.push_screen(LeaveQuestion(), lambda yes: lab.exit() if yes else None)
