"""Tests of `tuisim.reasons`."""
