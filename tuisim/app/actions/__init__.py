"""Functions behind the keys: one file per group of the table."""
