"""Keys of the group Lesson: answer, hint, and the menu with all lessons."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from tuisim.lessons.progress import LessonProgress, load_progress
from tuisim.lessons.spec import QuestionCheck as LessonQuestion

if TYPE_CHECKING:
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.workspace import Workspace

_BEFORE, _SKIP, _OVER, _OPEN = "before", "skip", "over", "open "


def answer(workspace: Workspace) -> None:
    """Ask for the answer to the question of the step."""
    from tuisim.app.dialogs.question import AnswerPrompt

    lesson = workspace.lesson
    step = lesson.step
    if step is None or not isinstance(step.check, LessonQuestion):
        words = (
            "The lesson is done: {lesson-menu} opens another"
            if lesson.lesson
            else "No lesson is open: {lesson-menu} opens one"
        )
        workspace.app.say("This step has no question: the lesson panel says what it waits for" if step else words)
        return
    forms = [(f"{number}", choice) for number, choice in enumerate(step.check.choices, start=1)]
    place = "The number of your choice" if forms else "Your answer"
    workspace.app.push_screen(
        AnswerPrompt(step.title, lesson.answer, forms=forms, placeholder=place, text=step.check.ask)
    )


def hint(workspace: Workspace) -> None:
    """Show the next hint of the step."""
    workspace.lesson.hint()


def scroll(workspace: Workspace, by: int) -> None:
    """Scroll the text of the lesson by rows; if all of it is in view, the code if it has the focus."""
    area = workspace.panel_area
    if area.lesson and reads_on(area):
        area.lesson.action_scroll_text(by)
    elif area.code and area.code.has_focus_within:
        area.code.page(by)


def takes_pages(area: PanelArea) -> bool:
    """Return whether the page keys are for the lesson, or the code, whatever has the focus."""
    if not area.screen.is_current:
        return False
    if area.code is not None and area.code.has_focus_within:
        return not area.code.typing
    return reads_on(area)


def reads_on(area: PanelArea) -> bool:
    """Return whether the lesson is in sight, with more of its text above or below."""
    return area.screen.is_current and area.lesson is not None and area.shown("lesson") and area.lesson.reads_on


def menu(workspace: Workspace) -> None:
    """Offer to read earlier steps again, to skip the step, to start over, and all lessons."""
    from tuisim.app.dialogs.chooser import ChoiceGroup, Chooser

    lesson = workspace.lesson
    here = []
    if before := lesson.step_before:
        here.append((_BEFORE, "Steps before", f"Read again: {before.title}"))
    if step := lesson.step:
        here.append((_SKIP, "Skip", f"Leave this step undone: {step.title}"))
    if lesson.lesson:
        here.append((_OVER, "Start over", f"All steps again: {lesson.lesson.title}"))
    progress = load_progress()
    lessons = [
        (f"{_OPEN}{one.name}", f"{number:2} {one.title}", progress.get(one.name, LessonProgress()).words(one))
        for number, one in enumerate(lesson.lessons(), start=1)
    ]
    current = f"{_OPEN}{_wanted(workspace)}"
    groups = [ChoiceGroup("This lesson", here), ChoiceGroup("All lessons", lessons)]
    workspace.app.push_screen(Chooser("Lessons", groups, current), partial(_chosen, workspace))


def _wanted(workspace: Workspace) -> str:
    """Return the name of the lesson that is selected first: the next one after the end of this one."""
    lesson = workspace.lesson
    if lesson.lesson is None:
        return ""
    return lesson.lesson.name if lesson.step else lesson.next_name or lesson.lesson.name


def _chosen(workspace: Workspace, choice: str | None) -> None:
    if choice is None:
        return
    if choice == _BEFORE:
        workspace.lesson.show_step_before()
    elif choice == _SKIP:
        workspace.lesson.skip_step()
    elif choice == _OVER:
        _ask_to_start_over(workspace)
    else:
        name = choice.removeprefix(_OPEN)
        workspace.document.when_safe(partial(workspace.lesson.open, name))


def _ask_to_start_over(workspace: Workspace) -> None:
    from tuisim.app.dialogs.question import Question

    text = "All steps of this lesson are open again, and its program is as at first. A copy of yours is kept."
    answers = (("s", "Start over"),)

    def answered(key: str | None) -> None:
        if key:
            workspace.document.when_safe(workspace.lesson.start_over)

    workspace.app.push_screen(Question("Start over?", text, answers, "goes on as it is"), answered)
