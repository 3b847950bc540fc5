"""Who may use the server: whoever has the secret part of its address, from a page of its own."""

from __future__ import annotations

import re
import secrets
from dataclasses import field
from ipaddress import ip_address
from urllib.parse import urlsplit

from tuisim.base.data_class import dataclass

_HOST = re.compile(r"[\w.-]+(:\d+)?|\[[\da-fA-F:.]+\](:\d+)?", re.ASCII)
_LOCAL = frozenset({"127.0.0.1", "localhost", "::1"})
"""Names of this machine that a tunnel also uses at its other end."""


def is_any_address(host: str) -> bool:
    """Return whether a host to listen on stands for all addresses of the machine."""
    try:
        return ip_address(host).is_unspecified
    except ValueError:
        return not host


def create_token() -> str:
    """Return a token that nobody can guess."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True)
class Gate:
    """The rules that say which requests are answered and who may show the page."""

    listens_on: str
    """Host name or address that the server listens on."""
    token: str = field(default_factory=create_token)
    frames: tuple[str, ...] = ()
    """Origins of pages, such as `http://localhost:8888`, that may show the page in a frame; a proxy may pass the server
    off as a part of theirs."""

    def is_allowed(self, path: str, host: str, origin: str | None, *, from_a_page: bool) -> bool:
        """Return whether to answer a request.

        Args:
            path: Its path; must begin with the token.
            host: Its header `Host`. It must name the host that the server listens on, or this machine, so that no other
                site can pass this server off as a part of itself.
            origin: Its header `Origin`: the site whose page sends the request; None if it has none.
            from_a_page: Whether only a page may send the request, so that it must have an origin.
        """
        # In constant time: nobody can find out the token letter by letter from how long an answer takes.
        if not secrets.compare_digest(
            path.partition("/")[2].partition("/")[0].encode(), self.token.encode()
        ):
            return False
        if not self._is_ours(host):
            return False
        return (
            not from_a_page if origin is None else origin in (f"http://{host}", f"https://{host}")
        )

    @property
    def framed_by(self) -> str:
        """Who may show the page in a frame, in the words of a content security policy."""
        # 'self': behind a proxy, the page has the proxy's origin, which `frames` need not name.
        return " ".join(("'self'", *self.frames)) if self.frames else "'none'"

    def _is_ours(self, host: str) -> bool:
        if not _HOST.fullmatch(host):
            return False
        if host in {urlsplit(origin).netloc for origin in self.frames}:
            return True
        return is_any_address(self.listens_on) or urlsplit(f"//{host}").hostname in _LOCAL | {
            self.listens_on.lower()
        }
