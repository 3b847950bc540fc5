"""Goals: what a run must achieve, read from a file, and judged on the run's recording."""
