"""The entries of a marking: each student's program with the world in which it runs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tuisim.base.errors import ConfigError, ProfileError, printable
from tuisim.base.faults import describe_fault
from tuisim.base.folders import backgrounds_folder
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.mat_image import read_pixels
from tuisim.engine.mats import background
from tuisim.programs.program_file import ProgramSource
from tuisim.programs.program_settings import ProgramSettings, build_program_settings
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings, has_world_values
from tuisim.tasks.execute import has_machine_cause
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.runs import RunEntry
from tuisim.tasks.marks.students import Student, find_outside_option


def build_entries(
    submissions: Sequence[Student], task: GoalsFile, options: Mapping[str, Any]
) -> tuple[list[RunEntry], list[Student]]:
    """Return the students whose programs can be run; and all students, with the problems that were noticed.

    Args:
        submissions: The students.
        task: The task.
        options: Settings that take precedence over the settings of the task, by path.

    Raises:
        ConfigError: the task's world, or an option, is wrong, or the profile fits none of the programs.
    """
    for world in task.worlds:
        build_run_spec(Settings.merge(world.settings, options))
    names_profile = "profile" in {**task.settings, **options}
    entries = []
    students = []
    misfits = []
    for student in submissions:
        if student.source:
            try:
                entries.append(_build_entry(student, student.source, task, options))
                student = entries[-1].student
            except ConfigError as error:
                misfits += [error] if isinstance(error, ProfileError) and names_profile else []
                student = replace(
                    student,
                    source=None,
                    problem=_describe_error(error, student),
                    is_unread=has_machine_cause(error),
                )
            except Exception as error:  # Any error concerns this student only.
                student = replace(
                    student, source=None, problem=describe_fault(error), is_unread=True
                )
        students.append(student)
    if misfits and not entries:
        raise misfits[0]
    return entries, students


def _build_entry(
    student: Student, source: ProgramSource, task: GoalsFile, options: Mapping[str, Any]
) -> RunEntry:
    every = [_resolve_settings(student, world, options) for world in task.worlds]
    specs = tuple(build_run_spec(own.settings) for own in every)
    if not has_world_values(task.settings):
        _check_background(specs[0])
    decided = every[0].decided
    program = replace(source.program, shown_ports=decided.shown_ports)
    source = replace(source, program=program)
    student = replace(student, source=source, refusal=decided.refusal)
    return RunEntry(student, specs, tuple(own.settings["press"] for own in every))


def _resolve_settings(
    student: Student, world: TrialWorld, options: Mapping[str, Any]
) -> ProgramSettings:
    """Return the settings with which a student's program runs in a world of the task.

    If the task sets the world, the options in the program's magic line are ignored. If nobody chooses a profile, the
    library that the program uses decides.

    Raises:
        ConfigError: the magic line, or a file that it names, is wrong.
        ProfileError: the profile is one for another library.
    """
    assert student.source is not None
    if has_world_values(world.settings):
        bare = replace(student.source, options={})
        return build_program_settings(bare, world.settings, options)
    if outside := find_outside_option(student):
        raise ConfigError("the first line names a file outside the folder", key=outside)
    return build_program_settings(student.source, world.settings, options)


def _check_background(spec: RunSpec) -> None:
    """Read the image of a mat that is not part of tuisim, so that a damaged one is noticed before the runs.

    Raises:
        ConfigError: the file is not an image, or it cannot be read.
    """
    image = background(spec.world.background).image
    if not image.is_relative_to(backgrounds_folder()):
        # The image is read here, as an error in a run would look like a fault of this machine.
        read_pixels(image, spec.world.background_fit)


def _describe_error(error: ConfigError, student: Student) -> str:
    """Return the text of an error, with the paths of the student's files relative to the student's folder."""
    folder = student.path if student.path.is_dir() else student.path.parent
    text = str(error)
    for place in (os.path.abspath(folder), os.path.realpath(folder), str(folder)):
        text = text.replace(f"{place}{os.sep}", "")
    return printable(text)
