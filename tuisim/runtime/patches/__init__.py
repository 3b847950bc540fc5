"""What programs find instead of functions of Python: clocks, threads, alarms, randomness, waits for files."""
