"""Keys of the group Panels: show, hide, enlarge, zoom."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.panels import PANELS

if TYPE_CHECKING:
    from tuisim.app.panels.world import World
    from tuisim.app.workspace import Workspace


def toggle(workspace: Workspace, panel: str) -> None:
    """Show a panel and focus it, or hide it."""
    workspace.panel_area.toggle(panel)
    workspace.app.situation_changed()
    workspace.app.call_after_refresh(workspace.panel_area.attend, panel)


def enlarge(workspace: Workspace) -> None:
    """Maximize the panel with the focus, or restore the layout."""
    focused = workspace.panel_area.screen.focused
    panel = next(
        (
            name
            for name, widget in workspace.panel_area.panels.items()
            if focused and widget in focused.ancestors_with_self
        ),
        "",
    )
    if panel or workspace.panel_area.alone:
        workspace.panel_area.maximize("" if workspace.panel_area.alone else panel)
    else:
        workspace.app.say("No panel has the focus: tab or a click gives it to one")


def _world(workspace: Workspace) -> World | None:
    if workspace.panel_area.shown("world"):
        return workspace.panel_area.world
    workspace.app.say(f"The world is hidden: {PANELS['world'].key} shows it")
    return None


def rays(workspace: Workspace) -> None:
    """Switch the ultrasonic rays on or off."""
    if world := _world(workspace):
        world.show_rays = not world.show_rays
        workspace.app.draw(force=True)


def zoom(workspace: Workspace) -> None:
    """Switch the world to the next zoom."""
    if world := _world(workspace):
        world.cycle_zoom()
        workspace.app.draw(force=True)
