"""Brackets in what somebody has written are shown as they are: no list or dialog takes them for markup."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from textual.app import App
from textual.screen import Screen

from tests.cases import cases
from tuisim.app.dialogs.entries import BreaksDialog, SavedPoses, WatchesDialog
from tuisim.app.dialogs.runs import Differences
from tuisim.app.setup.poses import save_pose
from tuisim.engine.breakpoints import Breakpoint
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.diff import RowDifference, RunDiff

RUN = RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"])


def _poses() -> Screen[Any]:
    save_pose("door [/x]", Pose(1.0, 2.0, 3.0))
    return SavedPoses(Pose(0.0, 0.0, 0.0))


def _differences() -> Screen[Any]:
    row = RowDifference(1, "[/x]", "[beep]", (0.0, 0.1))
    return Differences(
        "Run 1",
        "run 2",
        RunDiff((("[a]", "[b]", "1"),), ("-a[i]",), False, None, None, row, None, None),
    )


DIALOGS: dict[str, tuple[Callable[[], Screen[Any]], tuple[str, ...]]] = {
    "poses": (_poses, ("door [/x]",)),
    "breaks": (
        lambda: BreaksDialog((Breakpoint.parse("print matches [/b]"),), RUN, lambda _: None),
        ("[/b]",),
    ),
    "watches": (
        lambda: WatchesDialog(("table[row]",), RUN, lambda _: None),
        ("table[row]",),
    ),
    "differences": (_differences, ("'[/x]' at 0.000 s | '[beep]' at 0.100 s", "[b] | 1", "-a[i]")),
}


@cases("make, shown", DIALOGS)
async def test_brackets_in_names_are_not_taken_for_markup(
    make: Callable[[], Screen[Any]], shown: tuple[str, ...]
) -> None:
    app: App[None] = App()
    async with app.run_test(size=(100, 40)) as pilot:
        app.push_screen(make())
        await pilot.pause()
        text = "\n".join(strip.text for strip in app.screen._compositor.render_strips())
        for words in shown:
            assert words in text
