"""What the text of a program says: its first line, its robot, what it calls and asks, names that it lacks."""
