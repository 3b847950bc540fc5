"""Dates and times of day as people and programs write them: recognised, and brought to one form."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
MONTH = rf"(?:{'|'.join(_MONTHS)})"
_YEAR_FIRST = r"\d{4}[-/.]\d{1,2}[-/.]\d{1,2}"
_YEAR_LAST = r"\d{1,2}[-/.]\d{1,2}[-/.]\d{4}"
_MONTH_IN_WORDS = rf"\d{{1,2}}[-/. ]{MONTH}[a-z]*[-/. ]\d{{4}}"
_CHINESE = r"\d{4}年\d{1,2}月\d{1,2}日?"
_SHORT_YEAR = r"\d{1,2}[-/.]\d{1,2}[-/.]\d{2}"
"""Regular expression of a date whose year has two digits; it counts as a date only if a time of day follows."""
_DATE = rf"(?:{_YEAR_FIRST}|{_YEAR_LAST}|{_MONTH_IN_WORDS}|{_CHINESE})"
_GAP = r"(?:T|:|日 *| *[/,_] *| +(?:- +)?)"
"""Regular expression of the characters between a date and its time of day."""
_PART = r"(?:[.,]\d+|:\d{3})"
"""Regular expression of the fraction of a second, after a point, a comma or a colon."""
_ZONE = r"(?:Z| ?UTC| ?[+-]\d{2}(?::?\d{2})?)"
_HALF = r"(?: ?[AaPp][Mm])"
"""Regular expression of AM or PM after a time of day."""
_MINUTES = r"\d{1,2}:\d{2}\.\d+"
"""Regular expression of a time of day or a span without hours: minutes, and seconds with a fraction."""
C_TIME = rf"[A-Z][a-z]{{2}} {MONTH} {{1,2}}\d{{1,2}} \d{{2}}:\d{{2}}:\d{{2}} \d{{4}}"
"""Regular expression of a date and time as `time.ctime` writes it."""
MOMENT = (
    rf"(?:(?:{_DATE}{_GAP}|{_SHORT_YEAR} +)\d{{1,2}}:\d{{2}}(?::\d{{2}}{_PART}?)?(?:{_HALF}|{_ZONE})?"
    rf"|{_DATE}|\d{{8}}T\d{{4,6}}|\d{{1,2}}:\d{{2}}:\d{{2}}{_PART}?{_HALF}?|\d{{1,2}}:\d{{2}}{_HALF}|{_MINUTES}|{C_TIME})"
)
"""Regular expression of a date, a time of day with seconds, or both."""
_MOMENT_CELL = re.compile(rf"\s*[\[(<]?\s*{MOMENT}\s*[\])>]?\s*")
_DATE_CELL = re.compile(rf"\s*{_DATE}\s*")
_CLOCK_CELL = re.compile(rf"\s*\d{{1,2}}:\d{{2}}(?::\d{{2}}{_PART}?)?{_HALF}?\s*")

SPAN = r"^-?(?:\d+ days?,? )?\d+:\d{2}:\d{2}(?:\.\d+)?$"
"""Regular expression of a time span as pandas or Python prints it, or of hours, minutes and seconds."""
_HOURS = r"^(\d{1,2}:\d{2})$"
"""Regular expression of hours and minutes without seconds."""
CLOCK_OF_12_HOURS = rf"^\d{{1,2}}:\d{{2}}(?::\d{{2}}{_PART}?)?{_HALF}$"
WORDS = rf"{_HALF}$|{C_TIME}|{_MONTH_IN_WORDS}"
"""Regular expression of dates and times that pandas reads only with the format `mixed`, which examines each text anew.
"""
_USUAL = rf"{SPAN}|^\d{{4}}-\d{{2}}-\d{{2}}(?:$|[T ]\d{{2}}:\d{{2}}(?:$|[^,U]*$))"
"""Regular expression of dates and time spans that pandas reads without a change."""
_REWRITTEN = (
    (r"^[\[(<] *| *[\])>]$", ""),
    (r" ?UTC$", "Z"),
    (rf"^({_MINUTES})$", r"0:\1"),
    (_HOURS, r"\1:00"),
    (r"(:\d{2}:\d{2})[,:](\d+)", r"\1.\2"),
    (r"日 *(\d)", r" \1"),
    (r"^(\d{4})年(\d{1,2})月(\d{1,2})日?", r"\1-\2-\3"),
    (rf"^({_DATE}){_GAP}(\d{{1,2}}:)", r"\1 \2"),
    (r"^(\d{4})[/.](\d{1,2})[/.](\d{1,2})", r"\1-\2-\3"),
)
"""Regular expressions and their replacements, in this order, which bring dates to one form, except that a year at the
end of a date stays there.
"""
_YEAR_AT_END = r"^(?P<first>\d{1,2})[-/.](?P<second>\d{1,2})[-/.](?P<year>\d{4})"
_PADDED = (
    (r"^(\d{4})-(\d)-", r"\1-0\2-"),
    (r"^(\d{4}-\d{2})-(\d)($|\D)", r"\1-0\2\3"),
    (r"^(\d{4}-\d{2}-\d{2}) (\d):", r"\1 0\2:"),
)
_LAST_MONTH = 12


def is_moment(cell: str) -> bool:
    """Return whether a cell is a date, a time of day, or both, perhaps in brackets, or a time span."""
    return is_clock(cell) or (_MOMENT_CELL.fullmatch(cell) or re.fullmatch(SPAN, cell)) is not None


def is_date(cell: str) -> bool:
    """Return whether a cell is a date without a time of day."""
    return _DATE_CELL.fullmatch(cell) is not None


def is_clock(cell: str) -> bool:
    """Return whether a cell is a time of day without a date."""
    return _CLOCK_CELL.fullmatch(cell) is not None


def normalize_dates(texts: Any) -> Any:
    """Return texts in which each date is year-month-day, without the blanks and brackets around it.

    A date with the year at its end, such as 03/04/2024, is read with the day first. If another date among the texts has
    a second number above 12, all are read with the month first. Texts that are no dates may change, too.
    """
    texts = pc.utf8_trim_whitespace(texts)
    if not pc.any(pc.invert(pc.match_substring_regex(texts, _USUAL))).as_py():
        return texts
    texts = _replace_patterns(_expand_years(texts), _REWRITTEN)
    first, second = _find_largest_parts(texts)
    order = r"\3-\1-\2" if first <= _LAST_MONTH < second else r"\3-\2-\1"
    return _replace_patterns(texts, ((_YEAR_AT_END, order), *_PADDED))


def _expand_years(texts: Any) -> Any:
    """Return texts in which the years of dates with two digits have four.

    The year is first if the last number takes more values than the first, as the day does; else it is last.
    """
    parts: Any = pc.extract_regex(texts, r"^(?P<first>\d+)[-/.]\d+[-/.](?P<last>\d{2}) ")
    counts = [pc.count_distinct(pc.struct_field(parts, name)).as_py() for name in ("first", "last")]
    order = r"20\1-\2-\3 " if counts[1] > counts[0] else r"\1-\2-20\3 "
    return pc.replace_substring_regex(texts, r"^(\d{1,2})[-/.](\d{1,2})[-/.](\d{2}) ", order)


def describe_guess(texts: Any) -> str:
    """Return what the numbers in dates and times are taken for, such as `day, month, year`; empty if they are clear."""
    if pc.any(pc.match_substring_regex(texts, _HOURS)).as_py():
        return "hours and minutes"
    return "day, month, year" if _order_is_guessed(texts) else ""


def _order_is_guessed(texts: Any) -> bool:
    """Return whether dates such as 03/04/2024 leave open whether the day or the month is first."""
    texts = _expand_years(_replace_patterns(texts, _REWRITTEN[:1]))
    first, second = _find_largest_parts(texts)
    if not 0 < max(first, second) <= _LAST_MONTH:
        return False
    dates = pc.replace_substring_regex(texts, _YEAR_AT_END + ".*", r"\1-\2-\3")
    return bool(pc.count_distinct(dates).as_py() > 1)


def _replace_patterns(texts: Any, changes: Sequence[tuple[str, str]]) -> Any:
    for pattern, new in changes:
        texts = pc.replace_substring_regex(texts, pattern, new)
    return texts


def _find_largest_parts(texts: Any) -> tuple[int, int]:
    """Return the largest first number and the largest second number of dates with the year at the end.

    Both are 0 if no text is a date of this form.
    """
    parts: Any = pc.extract_regex(texts, _YEAR_AT_END)
    numbers = (pc.cast(pc.struct_field(parts, name), pa.int64()) for name in ("first", "second"))
    first, second = (pc.max(number).as_py() or 0 for number in numbers)
    return first, second
