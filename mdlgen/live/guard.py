"""Requests that the page's server refuses before it reads any of their content."""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

HOST = "127.0.0.1"
MOST_BODY = 1_000_000  # bytes of a request
Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

# Headers of every answer: the browser caches nothing, no other page frames it, and nothing is loaded from
# elsewhere.
HEADERS = (
    (b"cache-control", b"no-store"),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


class Guard:
    """Lets through what comes from the page itself: with the token, to the server's own name, from no other
    origin. Behind it paths stand without the token."""

    def __init__(self, app: App, token: str, port: int):
        self._app, self._token = app, token
        self._host = f"{HOST}:{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
        elif scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008})
        else:
            await self._http(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        async def with_headers(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *HEADERS]
            await send(message)

        reason, own = self.refuses(scope), f"/{self._token}"
        if reason is None and scope["path"] != own:
            await self._app({**scope, "path": scope["path"].removeprefix(own)}, receive, with_headers)
            return
        text = f"{reason or 'the address ends with /'}\n".encode()
        headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", b"%d" % len(text))]
        if reason is None:  # typed without its end, from which the page would ask elsewhere
            headers.append((b"location", f"{own}/".encode()))
        status = 403 if reason else 307
        await with_headers({"type": "http.response.start", "status": status, "headers": headers})
        await send({"type": "http.response.body", "body": text})

    def refuses(self, scope: Scope) -> str | None:
        """Why a request is refused; None where it is not."""
        found: dict[bytes, list[str]] = {}
        for name, value in scope["headers"]:
            found.setdefault(name.lower(), []).append(value.decode("latin-1"))
        if found.get(b"host") != [self._host]:  # a name that was made to lead here
            return "this server has another name"
        if any(origin != f"http://{self._host}" for origin in found.get(b"origin", ())):
            return "a request from another origin"
        opens = scope["method"] == "GET" and found.get(b"sec-fetch-mode") == ["navigate"]
        if not opens and any(s not in ("same-origin", "none") for s in found.get(b"sec-fetch-site", ())):
            return "a request from another site"
        first = scope["path"].split("/")[1] if "/" in scope["path"] else ""
        if not secrets.compare_digest(first.encode(), self._token.encode()):
            return "the address lacks its token: take the one that mdlgen live has printed"
        if scope["method"] == "POST":
            kind = found.get(b"content-type", [""])[0].partition(";")[0].strip()
            if kind != "application/json":  # which no form of another page can send
                return "not JSON"
            length = found.get(b"content-length", [""])[0]
            if not length.isdigit() or int(length) > MOST_BODY:
                return f"a body of more than {MOST_BODY} bytes, or of no known length"
        return None
