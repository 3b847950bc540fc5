"""Holding a program at a line, an instant or an event, and looking at it. Loaded when it is first wanted."""
