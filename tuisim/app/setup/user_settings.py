"""A change of one of the user's settings in the app: it is written, and applies at once where it can."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from tuisim.config.files import Scalar
from tuisim.config.user_config import CELL_SET, THEME, Setting, load_config
from tuisim.config.user_config_file import save_setting

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace


def _theme(workspace: Workspace, value: str) -> None:
    workspace.app.theme = value


def _rays(workspace: Workspace, value: bool) -> None:
    if world := workspace.panel_area.world:
        world.show_rays = value


_APPLY: Mapping[str, Callable[[Workspace, Any], None]] = {
    "app.speed": lambda workspace, value: workspace.run_controller.set_speed(value),
    "app.ultrasound": _rays,
    CELL_SET: lambda workspace, value: workspace.app.choose_cells(value),
    "app.pixels": lambda workspace, value: workspace.app.choose_pixels(value),
    THEME: _theme,
}
"""What applies a setting to the app that is open, by its path."""


def change(workspace: Workspace, one: Setting, value: Scalar | None) -> None:
    """Write a setting to `config.toml`, and apply it at once where the app can.

    Raises:
        ConfigError: the value is wrong, or the file cannot be written.
    """
    save_setting(one, value)
    if apply := _APPLY.get(one.path):
        apply(workspace, load_config().values.get(one.path, one.default))
        workspace.app.situation_changed()
        workspace.app.draw(force=True)
