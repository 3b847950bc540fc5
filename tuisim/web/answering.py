"""A web application whose requests are answered by those who their secret part belongs to."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any, Protocol

from aiohttp import web
from aiohttp.typedefs import Handler

from tuisim.web.gate import Gate
from tuisim.web.upload import MOST_FILE_BYTES

Answer = Callable[[Any, web.Request], Awaitable[web.StreamResponse]]
Routes = Sequence[tuple[str, str, Answer]]
"""GET or POST, the path after the secret part, and the function that answers, which gets the owner of that part."""
_REFUSAL = "This address leads nowhere. Students ask their tutor for their link; `tuisim serve` prints all links.\n"
_REFUSAL_PAGE = f"""\
<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>tuisim</title>
<style>:root {{ color-scheme: dark }} body {{ font: 18px/1.5 system-ui, sans-serif; margin: 20vh auto 0;
max-width: 30em; padding: 0 1em }}</style>
<p>{_REFUSAL.replace("`tuisim serve`", "<code>tuisim serve</code>").strip()}
</html>
"""


class Owner(Protocol):
    """Who answers the requests of one secret part."""

    gate: Gate

    @property
    def routes(self) -> Routes:
        """What it answers; the same for all of its class."""


def application_of(find: Callable[[], Sequence[Owner]]) -> web.Application:
    """Return an application in which everybody gets the same answer who may not see something, whatever it is.

    Args:
        find: Returns the owners; a secret part may change.
    """

    def owner_of(request: web.Request) -> Owner | None:
        # What does something is sent by a page of ours only.
        acts, origin = (
            request.path.endswith("/ws") or request.method == "POST",
            request.headers.get("Origin"),
        )
        # All are asked, so that the time does not tell which one it was.
        found = [
            one
            for one in find()
            if one.gate.admits(request.path, request.host, origin, from_a_page=acts)
        ]
        return found[0] if found else None

    def refusal(request: web.Request) -> web.HTTPForbidden:
        if "text/html" in request.headers.get("Accept", ""):
            return web.HTTPForbidden(text=_REFUSAL_PAGE, content_type="text/html")
        return web.HTTPForbidden(text=_REFUSAL)

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        if owner_of(request) is None:
            raise refusal(request)
        return await handler(request)

    async def protect(request: web.Request, response: web.StreamResponse) -> None:
        _protect(request, response, (owner_of(request) or find()[0]).gate.framed_by)

    def among(answers: Mapping[type, Answer]) -> Handler:
        async def handle(request: web.Request) -> web.StreamResponse:
            owner = owner_of(request)
            if owner is None or type(owner) not in answers:
                raise refusal(request)
            return await answers[type(owner)](owner, request)

        return handle

    application = web.Application(middlewares=[guard], client_max_size=MOST_FILE_BYTES)
    by_path: dict[tuple[str, str], dict[type, Answer]] = {}
    for owner in find():
        for method, path, answer in owner.routes:
            by_path.setdefault((method, path), {})[type(owner)] = answer
    for (method, path), answers in by_path.items():
        # The gate looks at the token, which may change.
        add = application.router.add_get if method == "GET" else application.router.add_post
        add(f"/{{token}}{path}", among(answers))
    application.on_response_prepare.append(protect)
    return application


def _protect(request: web.Request, response: web.StreamResponse, framed_by: str) -> None:
    """Let the page load nothing from elsewhere, be part of other pages only as the gate says, and tell nobody its
    address."""
    sockets = f"ws://{request.host} wss://{request.host}" if request.host else ""
    response.headers.update(
        {
            "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; "
            f"style-src 'self' 'unsafe-inline'; connect-src 'self' {sockets}; "
            f"form-action 'none'; base-uri 'none'; object-src 'none'; frame-ancestors {framed_by}",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Referrer-Policy": "no-referrer",
            "X-Content-Type-Options": "nosniff",
            "Cache-Control": "no-store",
            "Server": "tuisim",
        }
    )
