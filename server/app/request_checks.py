"""Checked before every request: the Host and Origin that it comes with. And the headers that every answer carries."""

from __future__ import annotations

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.access.same_origin import SAFE_METHODS, find_host_fault, find_origin_fault
from server.app.error_handler import answer_error
from server.settings import Settings

CONTENT_SECURITY_POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self'",
        "style-src 'self' 'unsafe-inline'",  # the app's components set styles on elements
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "connect-src 'self'",
        "worker-src 'self' blob:",
        "frame-src 'self'",  # the viewer
        "frame-ancestors 'self'",
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'self'",
    )
)
HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "SAMEORIGIN",
    "Referrer-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=(), payment=(), usb=()",
    "X-Permitted-Cross-Domain-Policies": "none",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
"""Of every answer that does not set them itself (the viewer's page needs a wider policy)."""


class RequestChecks:
    """Refuses requests to foreign hosts, and writes and sockets from foreign pages; adds the headers.

    It stands outside of all that can fail, so it also answers what nobody foresaw.
    """

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app = app
        self.settings = settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        reached = (scope.get("server") or (None,))[0]
        fault = find_host_fault(headers, self.settings, reached)
        if not fault and (scope["type"] == "websocket" or scope["method"] not in SAFE_METHODS):
            fault = find_origin_fault(headers, self.settings)
        if scope["type"] == "websocket":
            if fault:
                await send({"type": "websocket.close", "code": 1008, "reason": "forbidden"})
            else:
                await self.app(scope, receive, send)
            return

        is_answered = False

        async def send_with_headers(message: Message) -> None:
            nonlocal is_answered
            if message["type"] == "http.response.start":
                is_answered = True
                answered = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    answered.setdefault(name, value)
                if scope["path"].startswith("/api"):  # of what a person sees nothing stays in proxies and caches
                    answered.setdefault("Cache-Control", "no-store")
            await send(message)

        if fault:
            refusal = JSONResponse({"error": "ForbiddenError", "detail": fault}, 403)
            await refusal(scope, receive, send_with_headers)
            return
        try:
            await self.app(scope, receive, send_with_headers)
        except Exception as error:
            if is_answered:
                raise
            answer = answer_error(Request(scope), error)
            await answer(scope, receive, send_with_headers)
