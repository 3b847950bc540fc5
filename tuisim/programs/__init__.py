"""What the text of a program says: its first line, its robot, what it calls and asks, names that it lacks."""

__all__ = [
    "constants",
    "facts",
    "function",
    "line_values",
    "moves",
    "names",
    "notebook_file",
    "plugged_words",
    "program_file",
    "program_settings",
    "uses",
]
