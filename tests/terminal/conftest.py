"""What the tests of the terminal share with those of the app: a home of their own."""

from tests.app.conftest import home

__all__ = ["home"]
