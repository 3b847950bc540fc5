"""The shell commands, imported when they are called."""
