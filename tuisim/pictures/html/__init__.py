"""Pages for browsers: their templates, and their style."""
