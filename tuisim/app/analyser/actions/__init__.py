"""Functions behind the keys of the analyser: each group of the table of keys, `table.py`, in one file."""
