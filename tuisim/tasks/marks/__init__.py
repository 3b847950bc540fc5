"""Marks of a class: the students' programs, their runs, and sheet, page and feedback as pure functions of both."""
