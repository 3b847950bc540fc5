"""The recorded runs of `tests.runs`."""

from tests.runs.conftest import *  # noqa: F403
