"""What the keys do: one file a group of the table."""
