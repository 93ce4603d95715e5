"""Brings a session's page and socket, which listen on the loopback only, under the studio's address `/viewer/<id>/`."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re

import httpx
import msgspec.msgpack
import websockets
from starlette.responses import Response
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from server.errors import NotFoundError
from server.viewer.link import ViewerUnavailableError

log = logging.getLogger(__name__)

SUBPROTOCOL = re.compile(r"viser-v\d+(\.\d+)*[a-z0-9]*")

REFUSED_MESSAGES = frozenset({"ShareUrlRequest", "ShareUrlDisconnect"})
"""They would open a tunnel to a public server."""

MAX_MESSAGE = 8 * 1024 * 1024
"""Bytes from a browser: camera positions and clicks."""

HIDDEN_PANEL = """<style>
[data-floating-window], [data-dock-region] { display: none !important; }
div[style*="position: fixed"][style*="width: 20em"] { display: none !important; }
.mantine-Notifications-root { inset: auto 8px 8px auto !important; }
</style>"""
"""The studio's page has the controls; viser's own panel would be in the way, and its notices go to the lower right."""

CONTENT_SECURITY_POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline' 'unsafe-eval' blob:",  # the glue of its WebAssembly is made by eval
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        "connect-src 'self' data: blob:",
        "worker-src blob: data:",
        "frame-ancestors 'self'",
        "base-uri 'none'",
        "form-action 'none'",
    )
)
"""viser's page is one file with everything inline; it may talk to the studio and nobody else."""


def fetch_page(port: int, path: str) -> Response:
    """A file of viser's client."""
    parts = path.replace("\\", "/").split("/")
    if ".." in parts or "\0" in path:
        raise NotFoundError("There is no such file in the viewer.")
    try:
        with httpx.Client(trust_env=False, timeout=10.0) as client:
            answer = client.get(httpx.URL(scheme="http", host="127.0.0.1", port=port, path=f"/{path}"))
    except httpx.HTTPError as error:
        raise ViewerUnavailableError(f"The viewer does not answer: {error}. Open the view again.") from error
    if answer.status_code != 200:
        raise NotFoundError("There is no such file in the viewer.")
    content_type = answer.headers.get("content-type", "application/octet-stream")
    body = answer.content
    if content_type.startswith("text/html"):
        body = body.replace(b"</head>", HIDDEN_PANEL.encode() + b"</head>", 1)
    headers = {"Content-Security-Policy": CONTENT_SECURITY_POLICY, "Cache-Control": "no-cache"}
    return Response(body, media_type=content_type, headers=headers)


async def relay(browser: WebSocket, port: int) -> None:
    """Carry messages both ways until one side goes."""
    offered = [name for name in browser.scope.get("subprotocols", []) if SUBPROTOCOL.fullmatch(name)]
    protocols = [Subprotocol(name) for name in offered]
    try:
        upstream = await connect(
            f"ws://127.0.0.1:{port}", subprotocols=protocols or None, compression=None, max_size=None, proxy=None
        )
    except (OSError, websockets.InvalidHandshake) as error:
        log.warning("the viewer's socket does not open: %s", error)
        await browser.close(1013, "the viewer is gone")
        return
    async with upstream:
        await browser.accept(subprotocol=upstream.subprotocol)
        tasks = {asyncio.create_task(_upwards(browser, upstream)), asyncio.create_task(_downwards(browser, upstream))}
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):  # the browser may be gone
            await browser.close(upstream.close_code or 1000, upstream.close_reason or "")


async def _upwards(browser: WebSocket, upstream: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, websockets.ConnectionClosed):
        while True:
            message = await browser.receive_bytes()
            if len(message) > MAX_MESSAGE or is_refused(message):
                log.warning("a message of %d bytes to the viewer was refused", len(message))
                continue
            await upstream.send(message)


async def _downwards(browser: WebSocket, upstream: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, websockets.ConnectionClosed, RuntimeError):
        async for message in upstream:
            await (browser.send_text(message) if isinstance(message, str) else browser.send_bytes(message))


def is_refused(message: bytes) -> bool:
    """Whether a browser's message must not reach viser: one that opens a tunnel, or none that can be read."""
    try:
        content = msgspec.msgpack.decode(message)
    except msgspec.DecodeError:
        return True
    return not isinstance(content, dict) or content.get("type") in REFUSED_MESSAGES
