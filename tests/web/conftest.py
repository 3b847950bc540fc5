"""What the tests of the page share with those of the session."""

from tests.web.test_session import serve

__all__ = ["serve"]
