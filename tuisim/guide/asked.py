"""Questions that people ask, in words that the guide need not have, and the passages that answer them.

To add one: a line in `questions.toml`.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path


@cache
def asked_questions() -> Mapping[str, Mapping[str, tuple[str, ...]]]:
    """Return by page the questions that it answers, by a text that is in the passage which answers them."""
    text = (Path(__file__).parent / "questions.toml").read_text(encoding="utf-8")
    return {
        page: {key: tuple(asks) for key, asks in of.items()}
        for page, of in tomllib.loads(text).items()
    }
