"""Who is admitted."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.web.gate import Gate, create_token

HERE = "127.0.0.1:8000"
REQUESTS: dict[str, tuple[str, str, str, str | None, bool, bool]] = {
    # listens on, path, host, origin, only a page can send it: whether it is admitted
    "a page by its address": ("127.0.0.1", "/token/", HERE, None, False, True),
    "a page from itself": ("127.0.0.1", "/token/", HERE, f"http://{HERE}", False, True),
    "a socket of its page": ("127.0.0.1", "/token/ws", HERE, f"http://{HERE}", True, True),
    "through a tunnel": (
        "127.0.0.1",
        "/token/ws",
        "localhost:9000",
        "http://localhost:9000",
        True,
        True,
    ),
    "through a tunnel with encryption": (
        "127.0.0.1",
        "/token/ws",
        "localhost",
        "https://localhost",
        True,
        True,
    ),
    "IPv6": ("::1", "/token/ws", "[::1]:8000", "http://[::1]:8000", True, True),
    "by name": ("Lab.local", "/token/", "lab.local:8000", None, False, True),
    "any address": ("0.0.0.0", "/token/", "lab.local:8000", None, False, True),
    "no token": ("127.0.0.1", "/", HERE, None, False, False),
    "no path": ("127.0.0.1", "", HERE, None, False, False),
    "another token": ("127.0.0.1", "/other/", HERE, None, False, False),
    "a longer token": ("127.0.0.1", "/tokens/", HERE, None, False, False),
    "no ASCII in the token": ("127.0.0.1", "/tökén/", HERE, None, False, False),
    "the token elsewhere": ("127.0.0.1", "/static/token/", HERE, None, False, False),
    "a socket of no page": ("127.0.0.1", "/token/ws", HERE, None, True, False),
    "a socket of another site": (
        "127.0.0.1",
        "/token/ws",
        HERE,
        "http://evil.example",
        True,
        False,
    ),
    "a socket of another port": (
        "127.0.0.1",
        "/token/ws",
        HERE,
        "http://127.0.0.1:8001",
        True,
        False,
    ),
    "a socket of a file": ("127.0.0.1", "/token/ws", HERE, "null", True, False),
    "a page for another site": ("127.0.0.1", "/token/", HERE, "http://evil.example", False, False),
    "this machine under another name": (
        "127.0.0.1",
        "/token/",
        "evil.example:8000",
        None,
        False,
        False,
    ),
    "another name, consistently": (
        "127.0.0.1",
        "/token/ws",
        "evil.example",
        "http://evil.example",
        True,
        False,
    ),
    "a host that is none": ("0.0.0.0", "/token/", "a b;c", None, False, False),
    "no host": ("0.0.0.0", "/token/", "", None, False, False),
}


@for_rows("listens_on, path, host, origin, from_a_page, admitted", REQUESTS)
def test_only_the_address_and_its_own_pages_are_admitted(
    listens_on: str, path: str, host: str, origin: str | None, from_a_page: bool, admitted: bool
) -> None:
    assert (
        Gate(listens_on, "token").is_allowed(path, host, origin, from_a_page=from_a_page)
        is admitted
    )


def test_each_access_token_of_the_server_is_new_and_32_characters_long() -> None:
    tokens = {create_token() for _ in range(100)}
    assert (len(tokens), min(map(len, tokens))) == (100, 32)
