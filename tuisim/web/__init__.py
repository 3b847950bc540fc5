"""The app in a browser: a server for one user, needs the extra `web`."""

__all__ = [
    "gate",
    "server",
    "session",
    "visit",
]
