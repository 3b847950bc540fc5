"""The recorded runs of `tests.engine.runs`."""

from tests.engine.runs.conftest import *  # noqa: F403
