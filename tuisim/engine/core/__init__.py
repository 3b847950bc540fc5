"""The simulation: pure Python, no files, no wall clock, no printing."""
