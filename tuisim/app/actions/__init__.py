"""Functions behind the keys: each group of the table of keys, `table.py`, in one file."""
