"""Keys of the group Lesson: answer, hint, and the menu with all lessons."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.tasks.lessons.progress import LessonProgress, load_progress
from tuisim.tasks.lessons.spec import QuestionCheck as LessonQuestion

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext
    from tuisim.app.panel_area import PanelArea
    from tuisim.engine.runs.recorded_run import Recording

_BEFORE = "before"
_SKIP = "skip"
_MODEL = "model"
_OVER = "over"
_OPEN = "open "


def answer(context: ActionContext) -> None:
    """Ask for the answer to the question of the lesson's step."""
    from tuisim.app.dialogs.question import AnswerPrompt

    lesson = context.lesson
    step = lesson.step
    if step is None or not isinstance(step.check, LessonQuestion):
        context.app.say(
            "This step has no question: the lesson panel says what it waits for"
            if step
            else lesson.describe_missing_step()
        )
        return
    forms = [(f"{number}", choice) for number, choice in enumerate(step.check.choices, start=1)]
    place = "The number of your choice" if forms else "Your answer"
    context.app.push_screen(
        AnswerPrompt(step.title, lesson.answer, forms=forms, placeholder=place, text=step.check.ask)
    )


def scroll(context: ActionContext, by: int) -> None:
    """Scroll the text of the lesson if not all of it is visible; else scroll the code if it has the focus.

    Args:
        context: The parts of the app.
        by: Number of pages; negative scrolls up.
    """
    area = context.panels
    if area.lesson and has_more_text(area):
        area.lesson.action_scroll_text(by)
    elif area.code and area.code.has_focus_within:
        area.code.page(by)


def accept_page_keys(area: PanelArea) -> bool:
    """Return whether the page keys scroll the code or the lesson now, so that no other widget gets them."""
    if not area.screen.is_current:
        return False
    if area.code is not None and area.code.has_focus_within:
        return not area.code.typing
    return has_more_text(area)


def has_more_text(area: PanelArea) -> bool:
    """Return whether the lesson is visible, and has more text above or below the visible rows."""
    return (
        area.screen.is_current
        and area.lesson is not None
        and area.is_shown("lesson")
        and area.lesson.reads_on
    )


def show_menu(context: ActionContext) -> None:
    """Show the menu of lessons: actions for the open lesson, such as skipping its step, and below them all lessons."""
    from tuisim.app.dialogs.chooser import ChoiceGroup, Chooser

    here = []
    if session := context.lesson.session:
        if before := session.step_before:
            here.append((_BEFORE, "Steps before", f"Read again: {before.title}"))
        if step := session.step:
            here.append((_SKIP, "Skip", f"Leave this step undone: {step.title}"))
        if session.lesson.model_answer:
            alone = "Drive without the robot of the model answer again"
            beside = "Watch the model answer drive, without its program"
            here.append((_MODEL, "Grey robot", alone if context.runs.companion else beside))
        here.append((_OVER, "Start over", f"All steps again: {session.lesson.title}"))
    progress = load_progress()
    lessons = [
        (
            f"{_OPEN}{lesson.name}",
            f"{number:2} {lesson.title}",
            progress.get(lesson.name, LessonProgress()).words(lesson),
        )
        for number, lesson in enumerate(context.lesson.list_lessons(), start=1)
    ]
    current = f"{_OPEN}{_find_current_lesson(context)}"
    groups = [ChoiceGroup("This lesson", here), ChoiceGroup("All lessons", lessons)]
    context.app.push_screen(Chooser("Lessons", groups, current), partial(_handle_choice, context))


def _find_current_lesson(context: ActionContext) -> str:
    """Return the name of the lesson to select in the menu: the open lesson or, if that is done, the next lesson.

    The name is empty if no lesson is open.
    """
    lesson = context.lesson
    if lesson.lesson is None:
        return ""
    return lesson.lesson.name if lesson.step else lesson.next_name or lesson.lesson.name


def _handle_choice(context: ActionContext, choice: str | None) -> None:
    if choice is None:
        return
    if choice == _BEFORE:
        context.lesson.show_former_step()
    elif choice == _SKIP:
        context.lesson.skip_step()
    elif choice == _MODEL:
        _switch_model(context)
    elif choice == _OVER:
        _ask_restart(context)
    else:
        name = choice.removeprefix(_OPEN)
        context.document.run_when_saved(partial(context.lesson.open, name))


def _ask_restart(context: ActionContext) -> None:
    from tuisim.app.dialogs.question import Question

    text = "All steps of this lesson are open again, with the original program. Your program is saved as a copy."
    answers = (("s", "Start over"),)

    def handle_answer(key: str | None) -> None:
        if key:
            context.document.run_when_saved(context.lesson.restart_lesson)

    context.app.push_screen(
        Question("Start over?", text, answers, "keeps the lesson as it is"), handle_answer
    )


def _switch_model(context: ActionContext) -> None:
    """Show or hide a grey robot beside the robot of each run: that of the lesson's model answer."""
    from tuisim.tasks.lessons.trial import run_model

    lesson = context.lesson.lesson
    runs = context.runs
    if lesson is None or runs.companion is not None:
        runs.set_companion(None)
        context.app.draw(force=True)
        return

    def handle_recording(recording: Recording) -> None:
        if context.lesson.lesson is lesson:
            runs.set_companion(recording)
            context.app.say(
                "The grey robot of the model answer drives along with each run: {went-wrong} goes to where "
                "yours went wrong, {earlier} hides it"
            )
            context.app.draw(force=True)

    work = partial(run_model, lesson, context.lesson.step)
    background.run(
        context.panels, work, handle_recording, context.app.complain, group="model", exclusive=True
    )
