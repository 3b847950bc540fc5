"""Tests of `tuisim.goals`."""
