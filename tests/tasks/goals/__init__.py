"""Tests of `tuisim.tasks.goals`."""
