"""The server of the page: on this machine alone, at an address that only who was given it knows."""

from __future__ import annotations

import asyncio
import json
import secrets
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import Route
from watchfiles import awatch

from mdlgen.errors import MdlgenError, OutputError
from mdlgen.live.guard import HOST, Guard
from mdlgen.live.page import page, policy
from mdlgen.live.session import Session

ALIVE = 15.0  # seconds between two signs of life, by which a page that has gone is noticed
UNCHANGED = 50  # ms without a change of the file, after which it is read


def listening(port: int = 0) -> socket.socket:
    """A socket of this machine alone, at a free port where none is given. Raises OutputError."""
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((HOST, port))
        made.listen(64)
    except (OSError, OverflowError) as error:
        made.close()
        raise OutputError(
            f"port {port}: cannot be opened: {getattr(error, 'strerror', None) or error}"
        ) from None
    return made


def serve(session: Session, open_socket: socket.socket, ready: Callable[[str], None]) -> None:
    """Answers until it is interrupted; `ready` is called with the address once it does.

    Raises OutputError where no process can be started that runs the scene.
    """
    token, port = secrets.token_urlsafe(24), open_socket.getsockname()[1]
    app = Guard(application(session, lambda: ready(f"http://{HOST}:{port}/{token}/")), token, port)
    options: dict[str, Any] = {"log_level": "critical", "access_log": False, "server_header": False}
    config = uvicorn.Config(app, **options, timeout_graceful_shutdown=1, lifespan="on", ws="none")
    server = _Server(config, session)
    server.run(sockets=[open_socket])
    if not server.started:
        raise OutputError("no process can be started that runs the scene")


class _Server(uvicorn.Server):
    """Ends the answers that never end by themselves before it waits for all."""

    def __init__(self, config: uvicorn.Config, session: Session):
        super().__init__(config)
        self._session = session

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        await self._session.end()
        await super().shutdown(sockets)


def application(session: Session, ready: Callable[[], None] = lambda: None) -> Starlette:
    """The routes, behind the token."""

    async def show(request: Request) -> Response:
        nonce = secrets.token_urlsafe(16)
        text = await run_in_threadpool(page, session.file.name, nonce)
        return HTMLResponse(text, headers={"content-security-policy": policy(nonce)})

    async def state(_: Request) -> Response:
        return JSONResponse(session.state())

    async def events(_: Request) -> Response:
        return StreamingResponse(_events(session), media_type="text/event-stream")

    async def controls(_: Request) -> Response:
        return JSONResponse(session.controls)

    async def text(_: Request) -> Response:
        return JSONResponse({"text": session.text})

    async def run(_: Request) -> Response:
        return Response(session.body, media_type="application/json", status_code=200 if session.body else 204)

    async def turn(request: Request) -> Response:
        asked = await request.json()
        session.turn(dict(asked["values"]), bool(asked.get("held")))
        return JSONResponse({})

    async def add(request: Request) -> Response:
        session.add(str((await request.json())["path"]))
        return JSONResponse({})

    async def write(_: Request) -> Response:
        session.write()
        return JSONResponse({})

    @asynccontextmanager
    async def life(_: Any) -> AsyncIterator[None]:
        await session.start()
        follower = asyncio.create_task(_follow(session))
        ready()
        try:
            yield
        finally:
            follower.cancel()
            await session.end()

    return Starlette(
        routes=[
            Route("/", show),
            *(Route(f"/{each.__name__}", each) for each in (state, events, controls, text, run)),
            *(Route(f"/{each.__name__}", each, methods=["POST"]) for each in (turn, add, write)),
        ],
        lifespan=life,
        exception_handlers={MdlgenError: _refused, **dict.fromkeys(_WRONG, _not_asked_so)},
    )


_WRONG = (ValueError, KeyError, TypeError)


async def _refused(_: Request, error: Exception) -> Response:
    return JSONResponse({"says": str(error)}, status_code=409)


async def _not_asked_so(_: Request, error: Exception) -> Response:
    return JSONResponse({"says": f"not a request of this page: {error}"[:200]}, status_code=400)


async def _events(session: Session) -> AsyncIterator[str]:
    """States as server-sent events."""
    states = session.states()
    while True:
        following = asyncio.ensure_future(anext(states, None))
        while not (await asyncio.wait([following], timeout=ALIVE))[0]:
            yield ": here\n\n"
        found = following.result()
        if found is None:
            return
        yield f"data: {json.dumps(found, allow_nan=False)}\n\n"


async def _follow(session: Session) -> None:
    """Reads the scene again when its file changes, or one that it names."""
    while True:
        folders = session.folders()

        def concerned(_: Any, changed: str) -> bool:
            return Path(changed).name in session.names()

        async for _ in awatch(*folders, watch_filter=concerned, step=UNCHANGED, recursive=False):
            session.look()
            if session.folders() != folders:
                break
