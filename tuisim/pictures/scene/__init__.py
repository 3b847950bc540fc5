"""The world from above, drawn once for the screen and for files: what is on the field, and the pictures of it."""
