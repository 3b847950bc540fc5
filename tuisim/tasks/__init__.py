"""Tasks of programs: their goals, the judgement of runs, reasons for failures, lessons and marks."""

__all__ = [
    "execute",
    "goals.files",
    "goals.judge",
    "goals.judgement",
    "goals.live",
    "goals.spec",
    "lessons.catalogue",
    "lessons.files",
    "lessons.progress",
    "lessons.session",
    "lessons.spec",
    "lessons.trial",
    "marks.marking",
    "marks.sheet",
    "marks.trial",
    "pool",
    "reasons.reason",
    "reasons.waiting",
    "task",
]
