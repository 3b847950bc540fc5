"""The guide in the app: its screen, and the tables of keys."""
