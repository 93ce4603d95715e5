"""Answers of text in fewer bytes: gzip for those who take it. Pictures are small already, streams must not wait."""

from __future__ import annotations

import gzip

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LEAST_BYTES = 1_000
"""A shorter answer fits into one packet as it is."""
MANY_BYTES = 64_000
"""From here on the packing is no work for the loop that all requests share."""
LEVEL = 5
KINDS = ("application/json", "text/html", "text/csv", "text/plain", "image/svg+xml")


def find_codings(headers: Headers) -> set[str]:
    """What the asker unpacks: names of Accept-Encoding without those it refuses (`q=0`)."""
    codings = set()
    for item in headers.get("accept-encoding", "").split(","):
        name, _, weight = item.partition(";")
        if weight.replace(" ", "") not in ("q=0", "q=0.0", "q=0.00", "q=0.000"):
            codings.add(name.strip().lower())
    return codings - {""}


class Compression:
    """Packs answers that come whole, are text, and are not packed already."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        takes_gzip = "gzip" in find_codings(Headers(scope=scope))
        held: Message | None = None

        async def pack(message: Message) -> None:
            nonlocal held
            if message["type"] == "http.response.start" and _may_be_packed(Headers(raw=message["headers"])):
                held = message
                return
            if held is not None:
                start, held = held, None
                headers = MutableHeaders(raw=start["headers"])
                headers.add_vary_header("Accept-Encoding")
                body = message.get("body", b"")
                if takes_gzip and not message.get("more_body", False) and len(body) >= LEAST_BYTES:
                    if len(body) < MANY_BYTES:
                        body = gzip.compress(body, LEVEL, mtime=0)
                    else:
                        body = await run_in_threadpool(gzip.compress, body, LEVEL, mtime=0)
                    headers["Content-Encoding"] = "gzip"
                    headers["Content-Length"] = str(len(body))
                    message = {**message, "body": body}
                await send({**start, "headers": headers.raw})
            await send(message)

        await self.app(scope, receive, pack)


def _may_be_packed(headers: Headers) -> bool:
    kind = headers.get("content-type", "").partition(";")[0]
    return kind in KINDS and "content-encoding" not in headers
