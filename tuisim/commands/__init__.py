"""The shell commands: one file per command, imported when the command is called.

Each has `add_arguments(parser)` and `execute(arguments) -> exit code`.
"""
