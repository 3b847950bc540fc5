"""Lessons: Markdown files with tasks, what checks each step, and the progress of the student."""
