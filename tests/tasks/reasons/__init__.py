"""Tests of `tuisim.tasks.reasons`."""
