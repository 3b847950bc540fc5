"""A change of one of the user's settings in the app: it is written, and applies at once where it can."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from tuisim.config.files import Scalar
from tuisim.config.user_config import CELL_SET, THEME, Setting, load_config
from tuisim.config.user_config_file import save_setting

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext


def _theme(context: ActionContext, value: str) -> None:
    context.app.theme = value


def _rays(context: ActionContext, value: bool) -> None:
    if world := context.panels.world:
        world.show_rays = value


_APPLY: Mapping[str, Callable[[ActionContext, Any], None]] = {
    "app.speed": lambda context, value: context.runs.set_speed(value),
    "app.ultrasound": _rays,
    CELL_SET: lambda context, value: context.app.choose_cells(value),
    "app.pixels": lambda context, value: context.app.choose_pixels(value),
    THEME: _theme,
}
"""What applies a setting to the app that is open, by its path."""


def change(context: ActionContext, one: Setting, value: Scalar | None) -> None:
    """Write a setting to `config.toml`, and apply it at once where the app can.

    Raises:
        ConfigError: the value is wrong, or the file cannot be written.
    """
    save_setting(one, value)
    if apply := _APPLY.get(one.path):
        apply(context, load_config().values.get(one.path, one.default))
        context.app.situation_changed()
        context.app.draw(force=True)
