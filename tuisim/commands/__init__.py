"""What the shell commands do: one file a command, loaded when it is called.

Each has `add_arguments(parser)` and `execute(arguments) -> exit code`.
"""
