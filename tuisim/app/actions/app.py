"""Keys of the groups Panels and App: show, hide, enlarge; help, redraw, suspend, quit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from tuisim.app.action import KeyWord, group_keys
from tuisim.app.layout.arrangement import Preset
from tuisim.app.panels import PANELS
from tuisim.engine.files import Scalar
from tuisim.settings.user_config import CELL_SET, THEME, Setting, UserConfig
from tuisim.terminal.picture_options import AUTO

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext


def toggle(context: ActionContext, panel: str) -> None:
    """Do what the key of a panel does; the panel is given by its id.

    A hidden panel is shown, and gets the focus if it can have it. A shown panel gets the focus; if it was the last
    panel to get it, or cannot have it, the panel is hidden.
    """
    area = context.panels
    was_shown = area.is_shown(panel)
    if not area.can_take_focus(panel):
        area.toggle(panel)
    if was_shown and not area.is_shown(panel) and not area.is_single:
        context.app.say(f"{PANELS[panel].title} is hidden: {{panel-{panel}}} shows it again")
    context.app.handle_situation_change()
    context.app.call_after_refresh(area.focus_opened, panel)


def enlarge(context: ActionContext) -> None:
    """Maximize the panel with the focus; if a panel is maximized, show all panels again."""
    area = context.panels
    panel = area.find_focused_panel()
    if panel or area.alone:
        area.maximize("" if area.alone else panel)
    else:
        context.app.say("No panel has the focus: press tab, or click a panel")


def undo(context: ActionContext) -> None:
    """Undo the last change by the user that can be undone; if there is none, do nothing."""
    if take_back := context.app.undo:
        context.app.offer_undo(None)
        take_back()


def copy(context: ActionContext) -> None:
    """Copy the text of the focused panel, or of the panel that was clicked, to the terminal's clipboard."""
    from tuisim.app.clipboard import describe_copy, find_copied

    panel = context.panels.find_pointed_panel() or context.panels.alone or "world"
    copied = find_copied(panel, context.panels.panels[panel])
    if not copied.text:
        context.app.say(f"{copied.name}: nothing to copy")
        return
    context.app.copy_to_clipboard(copied.text)
    context.app.say(describe_copy(panel, copied))


def choose_preset(context: ActionContext, preset: Preset) -> None:
    """Show the panels of a preset; if that preset is shown already, show the standard one."""
    preset_in_view = context.panels.choose_preset(preset)
    key = context.app.ACTIONS[f"layout-{preset}"].key_label
    _say_layout(context, "" if preset_in_view == Preset.STANDARD else f" ({key} again: standard)")


def show_next_preset(context: ActionContext) -> None:
    """Show the panels of the next preset that changes the screen; after the last preset comes the first."""
    context.panels.show_next_preset()
    _say_layout(context, context.app.fill_keys(" ({layout-next}: next, {layout-keep}: keep)"))


def _say_layout(context: ActionContext, more: str) -> None:
    area = context.panels
    if not area.is_shown(area.find_focused_panel()):
        context.app.call_after_refresh(area.focus_opened, area.front)
    context.app.say(f"Layout: {area.preset}{more}")
    context.app.handle_situation_change()


def keep_layout(context: ActionContext) -> None:
    """Store the preset and the shown panels; the next start in a terminal of this size class shows them."""
    context.panels.keep_panels()
    context.app.say(
        f"The next start in a terminal of this size shows these panels: layout {context.panels.preset}"
    )


def focus_next_panel(context: ActionContext, by: int) -> None:
    """Move the focus by `by` panels; a negative number moves it back, and after the last panel comes the first.

    In an area with room for one panel, that panel is also shown in place of the present one.
    """
    if panel := context.panels.show_next_panel(by):
        context.app.handle_situation_change()
        context.app.call_after_refresh(context.panels.focus_opened, panel)


_START = (
    "Press {open} to open an example, then {run} to run it; {stop} stops it, {pause} pauses it. {mats} selects another "
    "mat. Drag the robot with the mouse or move it with the arrow keys: the readings follow. Each line that a program "
    "prints as a name, a colon and a number, such as Colour: 86.3, is added to the log and the chart. {export} exports "
    "the log to a file."
)
_NUDGES = (
    ("← ↑ → ↓", "Move the robot 10 mm"),
    ("shift + arrow", "Move the robot 1 mm"),
    ("a f", "Turn the robot 5° to the left, to the right; also ctrl + ← →"),
)
"""The ten keys that move or turn the robot, in three rows for the key table, and what each does."""


def show_help(context: ActionContext) -> None:
    """Open the guide at the page about the focused panel, or else at the table of all keys."""
    from tuisim.app.editor.area import EDITOR_KEYS
    from tuisim.app.guide.key_tables import EVERYWHERE, own_keys
    from tuisim.app.guide.screen import TOPICS, GuideScreen, KeyPage, Topic

    groups = group_keys(
        action for action in context.app.ACTIONS.values() if not action.id.startswith("nudge-")
    )
    groups["Robot"] += _NUDGES
    every: Mapping[str, Iterable[KeyWord]] = {**groups, "In the code": EDITOR_KEYS, "": EVERYWHERE}
    panel = context.panels.find_pointed_panel()
    widgets = (
        context.panels.list_focused_widgets()
        if panel == context.panels.find_focused_panel()
        else []
    )
    topic = TOPICS.get(panel, Topic())
    # The table of keys has a group for the code panel already.
    if panel != "code" and (own := own_keys(widgets)):
        here = f"In the panel {PANELS[panel].title}"
        every = {here: own, **every}
        topic = replace(topic, groups=(here, *topic.groups))
    keys = KeyPage("All keys", context.app.fill_keys(_START), every)
    context.app.push_screen(GuideScreen(keys, topic))


def choose_cells(context: ActionContext) -> None:
    """Show a dialog with a test picture in each set of glyphs; use and store the set that the user chooses."""
    from tuisim.app.dialogs.cells import CellsCard

    app = context.app

    def handle_choice(name: str | None) -> None:
        if name is not None:
            app.choose_cells(name)
            app.keep_setting(CELL_SET, None if name == AUTO else name)

    app.push_screen(CellsCard(app.picture_mode.chosen, app.picture_mode.best), handle_choice)


def _apply_theme(context: ActionContext, value: str) -> None:
    context.app.theme = value


def _apply_rays(context: ActionContext, value: bool) -> None:
    if world := context.panels.world:
        world.show_rays = value


_APPLY: Mapping[str, Callable[[ActionContext, Any], None]] = {
    "app.speed": lambda context, value: context.runs.set_speed(value),
    "app.ultrasound": _apply_rays,
    CELL_SET: lambda context, value: context.app.choose_cells(value),
    "app.pixels": lambda context, value: context.app.choose_pixels(value),
    THEME: _apply_theme,
}
"""Functions that apply a changed setting to the open app, by the path of the setting."""


def change_setting(context: ActionContext, setting: Setting, value: Scalar | None) -> None:
    """Write a setting to `config.toml`, and apply it to the running app where that is possible.

    Args:
        context: The parts of the app.
        setting: The setting.
        value: Its new value; None removes the setting from the file.

    Raises:
        ConfigError: the value is wrong, or the file cannot be written.
    """

    setting.save(value)
    if apply := _APPLY.get(setting.path):
        apply(context, UserConfig.load().values.get(setting.path, setting.default))
        context.app.draw(force=True)


def open_settings(context: ActionContext) -> None:
    """Open the dialog with the settings."""
    from tuisim.app.dialogs.settings import SettingsScreen

    context.app.push_screen(
        SettingsScreen(partial(change_setting, context), context.app.build_theme_chooser)
    )


def choose_theme(context: ActionContext) -> None:
    """Open the list of themes to choose from."""
    context.app.action_choose_theme()


def open_palette(context: ActionContext) -> None:
    """Open the command palette, in which the user searches for an action."""
    context.app.action_command_palette()


def leave(context: ActionContext) -> None:
    """Quit the app; if there are unsaved changes or a running program, ask the user first."""
    context.document.run_when_saved(lambda: _leave(context))


def _leave(context: ActionContext) -> None:
    if not context.runs.in_run:
        context.app.exit()
        return
    from tuisim.app.dialogs.question import LeaveQuestion

    context.app.push_screen(LeaveQuestion(), lambda yes: context.app.exit() if yes else None)


def redraw(context: ActionContext) -> None:
    """Send the whole screen to the terminal again."""
    context.app.action_redraw()


def save_screen(context: ActionContext) -> None:
    """Save a screenshot of the app as an SVG and a PNG file in the working directory."""
    context.app.action_save_screen()


def switch_pixels(context: ActionContext) -> None:
    """Switch between pictures with pixels and pictures with characters."""
    context.app.action_switch_pixels()


def suspend(context: ActionContext) -> None:
    """Suspend the app and return to the shell; `fg` resumes the app."""
    context.app.action_suspend_process()
