"""Tests of marking: a class of students' programs with their expected marks."""
