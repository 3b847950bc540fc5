"""What people look at: worlds, charts, movies and pages for browsers."""
