"""The shell of the brick: syntax, commands, and what replaces `subprocess`."""
