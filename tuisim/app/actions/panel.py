"""Keys of the group Panels: show, hide, enlarge, zoom."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.panels import PANELS

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.panels.world import World


def toggle(lab: LabApp, panel: str) -> None:
    """Show a panel and focus it, or hide it."""
    lab.panel_area.toggle(panel)
    lab.situation_changed()
    lab.call_after_refresh(lab.attend, panel)


def enlarge(lab: LabApp) -> None:
    """Maximize the panel with the focus, or restore the layout."""
    focused = lab.focused
    panel = next(
        (name for name, widget in lab.panel_area.panels.items() if focused and widget in focused.ancestors_with_self),
        "",
    )
    if panel or lab.panel_area.alone:
        lab.panel_area.give_all("" if lab.panel_area.alone else panel)
    else:
        lab.say("No panel has the focus: tab or a click gives it to one")


def _world(lab: LabApp) -> World | None:
    if lab.panel_area.shown("world"):
        return lab.panel_area.world
    lab.say(f"The world is hidden: {PANELS['world'].key} shows it")
    return None


def rays(lab: LabApp) -> None:
    """Switch the ultrasonic rays on or off."""
    if world := _world(lab):
        world.show_rays = not world.show_rays
        lab.draw(force=True)


def zoom(lab: LabApp) -> None:
    """Switch the world to the next zoom."""
    if world := _world(lab):
        world.cycle_zoom()
        lab.draw(force=True)
