"""Functions behind the keys of the analyser: each group of the table of keys, `keys.py`, in one file."""
