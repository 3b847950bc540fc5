"""Many runs: tasks as plain values, the processes that run them, and their results as a table."""

__all__ = [
    "parameters",
    "plan",
    "rounds",
    "sweep",
    "table",
]
