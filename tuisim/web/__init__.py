"""The app in a browser: a server for one user, needs the extra `web`."""
