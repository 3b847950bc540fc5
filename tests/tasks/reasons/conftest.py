"""Recorded runs, as the tests of runs make them."""

from tests.engine.runs.conftest import record, store

__all__ = ["record", "store"]
