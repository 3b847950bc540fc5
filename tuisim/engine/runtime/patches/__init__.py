"""What programs find instead of functions of Python: clocks, threads, signals, randomness, waits for files."""
