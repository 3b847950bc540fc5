"""Tasks: what a program is to do, whether its runs did it, why not, and lessons and marks made of that."""
