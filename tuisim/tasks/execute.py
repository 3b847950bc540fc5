"""Runs one task: starts the program, waits for its end, evaluates the recording and deletes or keeps it."""

from __future__ import annotations

import math
import os
import sqlite3
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from tuisim.base.errors import LogError, TuisimError
from tuisim.base.faults import describe_fault
from tuisim.base.regular_file import of_the_machine
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.mats import background
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.handle import RunHandle, describe_falsified
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun, find_diameters
from tuisim.engine.runs.samples import list_samples
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.temporary import TemporaryRun
from tuisim.logs.magnitude import find_scale
from tuisim.programs.plugged_words import list_parts
from tuisim.tasks.goals.judgement import Judgement
from tuisim.tasks.reasons.waited_words import describe_wait
from tuisim.tasks.task import OUTPUT_CHARACTERS, Keep, Result, Task, VariableStatistics

MATS_KEPT = 20
MAX_OUTPUT_BYTES = 16 << 20
"""A failed run with more output, in bytes, is not kept: its end says what happened."""


def execute(task: Task, folder: Path) -> Result:
    """Run a task and return its result, which also says what went wrong. This blocks until the run is over.

    Args:
        task: The task.
        folder: The folder in which the recording is until the run has been judged; see
            `engine.runs.temporary.create_batch_folder`.
    """
    try:
        return _run_task(task, folder)
    except Exception as error:  # This includes faults of tuisim, which must not end other runs.
        return build_unjudged(task, describe_fault(error))


def _run_task(task: Task, folder: Path) -> Result:
    with TemporaryRun(folder) as temporary:
        try:
            handle = RunHandle(
                task.program,
                task.spec,
                _load_field_files(task.spec),
                task.options,
                temporary,
                of_many=not task.isolate,
                isolated=task.isolate,
            )
        except TuisimError as error:
            return build_unjudged(task, str(error))
        try:
            ended = _run_to_end(handle, task.real_time_limit_s)
            run = handle.stored()
            run, replayed_end = _replay_run(task, run, ended)
            judgements = _judge(task, run)
            result = _build_result(task, run, replayed_end, judgements)
            if task.returns_files:
                result = replace(result, files=temporary.read_files(ended))
        except LogError as error:
            if has_machine_cause(error):
                return build_unjudged(task, str(error))
            # The path of the recording differs from machine to machine, and results must not.
            text = error.message.replace(f"{temporary.folder}{os.sep}", "")
            return build_unknown_result(task, End.FALSIFIED, describe_falsified(text))
        finally:
            handle.close()
        return (
            replace(result, run_id=_keep(temporary, ended, task.tags))
            if _is_kept(task, run, ended, judgements)
            else result
        )


def _run_to_end(handle: RunHandle, limit_s: float) -> Ended:
    ended = handle.wait(limit_s or None)
    while ended is None and (left_s := limit_s - handle.time_used_s) > 0:
        # On a busy machine the child waits for a processor: only the time that it used counts.
        ended = handle.wait(left_s)
    if ended is None:
        handle.stop()
        ended = handle.wait()
    assert ended is not None
    return ended


@lru_cache(MATS_KEPT)
def _prepare_field(background_name: str, fit: str, diameters: frozenset[int]) -> FieldFiles:
    return FieldFiles.prepare(background(background_name).image, diameters, fit=fit)


def _load_field_files(spec: RunSpec) -> FieldFiles:
    """Return the mat of a run, prepared for its sensors; within a process, each mat is prepared once.

    If the cached files of the mat are damaged, the mat is prepared again.
    """
    mat = spec.world.background, spec.world.background_fit, find_diameters(spec)
    files = _prepare_field(*mat)
    if not files.are_sound:
        _prepare_field.cache_clear()
        files = _prepare_field(*mat)
    return files


def _replay_run(task: Task, run: StoredRun, ended: Ended) -> tuple[StoredRun, Ended]:
    """Return the run to be judged, and how it ended; if the task demands it, replay the run first.

    The commands that the program gave are then simulated again, and the result is the replayed run. If the replay
    differs from the recording, the program has falsified the recording, and the run ended with `End.FALSIFIED`.

    Raises:
        LogError: no program can have given the commands.
    """
    if not task.is_replayed or ended.end in (End.FALSIFIED, End.DISK_FULL):
        return run, ended
    # Imported on demand, as most batches do not need it.
    from tuisim.engine.runs.replay import replay_run

    run, parted = replay_run(run, task.options.actions, task.real_time_limit_s or math.inf)
    if not parted:
        return run, ended
    why = describe_falsified(f"from {parted} on, it differs from what the program did")
    return run, replace(ended, end=End.FALSIFIED, exit_code=1, summary=why)


def _judge(task: Task, run: StoredRun) -> tuple[Judgement, ...]:
    if not task.goals:
        return ()
    # Imported on demand: most batches have no goals.
    from tuisim.tasks.goals.judge import judge

    return judge(task.goals, run)


def _is_kept(task: Task, run: StoredRun, ended: Ended, judgements: Sequence[Judgement]) -> bool:
    if task.keep is Keep.FAILED:
        if run.output.length > MAX_OUTPUT_BYTES:
            return False
        is_good = ended.end is End.FINISHED and not ended.exit_code
        return not is_good or not all(judgement.is_good for judgement in judgements)
    return task.keep is Keep.ALL


def _keep(temporary: TemporaryRun, ended: Ended, tags: Sequence[str]) -> str:
    """Store a finished run and return its id; return "" if the program damaged the recording after the run was judged.

    Raises:
        LogError: this machine cannot store the run, for example because the disk is full.
    """
    try:
        temporary.write_end(ended)
        return RunStore().add_folder(temporary.folder, tags).id
    except LogError as error:
        if has_machine_cause(error) or isinstance(error.__cause__, sqlite3.Error):
            raise
        return ""


def build_unjudged(task: Task, why: str) -> Result:
    """Return the result of a run that could not be judged for a reason that is not the program's fault.

    Args:
        task: The task of the run.
        why: The reason, as a sentence.
    """
    return Result(task.index, task.parameters, "", 2, why, why)


def build_unknown_result(task: Task, end: End, why: str) -> Result:
    """Return the result of a run without a recording.

    Args:
        task: The task of the run.
        end: How the run ended.
        why: Why there is no recording, as a sentence.
    """
    return Result(task.index, task.parameters, end.value, 1, why, why)


def _build_result(
    task: Task, run: StoredRun, ended: Ended, judgements: tuple[Judgement, ...]
) -> Result:
    last = run.telemetry.last()
    pose = last.pose if last else run.spec.world.start
    rows = run.output.read_all_rows()
    return Result(
        index=task.index,
        parameters=task.parameters,
        end=ended.end.value,
        exit_code=ended.exit_code,
        summary=ended.summary,
        error=ended.error,
        error_line=ended.error_line,
        ticks=ended.tick,
        time_s=run.time_s,
        x_mm=pose.x_mm,
        y_mm=pose.y_mm,
        heading_deg=pose.heading_deg,
        variables=compute_statistics(rows),
        judgements=judgements,
        output=_read_beginning(rows),
        waited_for=describe_wait(run),
        plugged=list_parts(run.plugged),
    )


def compute_statistics(rows: Iterable[OutputRow]) -> dict[str, VariableStatistics]:
    """Return statistics of the samples among the rows of a run's output, by the name of the variable."""
    values: dict[str, list[float]] = {}
    for sample in list_samples(rows):
        values.setdefault(sample.name, []).append(sample.value)
    return {name: _compute_variable(samples) for name, samples in values.items()}


def _compute_variable(values: Sequence[float]) -> VariableStatistics:
    count = len(values)
    low = min(values)
    high = max(values)
    scale = find_scale(low, high)
    scaled = [value / scale for value in values]
    # `fsum` is exact, so the order of values does not matter. The limits undo rounding out of the values' range.
    mean = min(max(math.fsum(scaled) / count, min(scaled)), max(scaled))
    std = math.sqrt(math.fsum((value - mean) ** 2 for value in scaled) / max(count - 1, 1))
    return VariableStatistics(values[-1], count, mean * scale, std * scale, low, high)


def _read_beginning(rows: Iterable[OutputRow]) -> str:
    text = []
    size = 0
    for row in rows:
        if row.stream is Stream.STDOUT and size < OUTPUT_CHARACTERS:
            text.append(row.text)
            size += len(row.text) + 1
    return "\n".join(text)[:OUTPUT_CHARACTERS]


def has_machine_cause(error: BaseException) -> bool:
    """Return whether the direct cause of an error is an `OSError` of this machine, such as a full disk.

    See `base.regular_file.of_the_machine`.
    """
    cause = error.__cause__
    return isinstance(cause, OSError) and of_the_machine(cause)
