"""The door: nobody gets to the API or to the viewer unknown. What is open to all is listed here and nowhere else."""

from __future__ import annotations

import asyncio
import ipaddress
import time

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.accounts.entry import find_visitor, note_seen
from server.accounts.same_origin import SAFE_METHODS
from server.accounts.visitor import LOCAL_VISITOR, Visitor, put_visitor
from server.app.error_handler import answer_error
from server.database import Database
from server.errors import ForbiddenError, LoginNeededError, StudioError
from server.settings import Settings

CLOSED_PREFIXES = ("/api", "/viewer")
"""All other addresses are files of the browser app, which everybody who asks for it gets."""

OPEN = frozenset(
    {
        ("GET", "/api/v1/health"),
        ("POST", "/api/v1/login"),
        ("POST", "/api/v1/login/code"),
    }
)
"""Requests that need no login."""

RECHECK_SECONDS = 30.0
"""A stream or socket that stays open ends so long after its login did, at the latest."""


class Door:
    """Finds out who makes a request, and lets nobody in who is not known."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app = app
        self.settings = settings
        self._notes: set[asyncio.Task[None]] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket") or not scope["path"].startswith(CLOSED_PREFIXES):
            await self.app(scope, receive, send)
            return
        method = scope.get("method", "GET")
        if scope["type"] == "http" and (method, scope["path"]) in OPEN:
            await self.app(scope, receive, send)
            return
        try:
            visitor = await self._let_in(scope)
            if method not in SAFE_METHODS and not visitor.may_write:
                raise ForbiddenError("This token may only read. Make one that may write on the page of your account.")
        except StudioError as error:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 1008, "reason": "log in first"})
                return
            await answer_error(Request(scope), error)(scope, receive, send)
            return
        put_visitor(scope, visitor)
        is_lasting = scope["type"] == "websocket" or method == "GET"
        if is_lasting and (visitor.login_id or visitor.token_id):
            receive = self._watch(scope, receive)
        await self.app(scope, receive, send)

    async def _let_in(self, scope: Scope) -> Visitor:
        if not self.settings.is_login_needed and not _is_near(scope):
            raise LoginNeededError("This studio asks for no login, so it answers this machine only.")
        headers = Headers(scope=scope)
        if not self.settings.is_login_needed and "authorization" not in headers:
            return LOCAL_VISITOR
        database: Database = scope["app"].state.database
        visitor, is_unseen = await run_in_threadpool(find_visitor, database, headers, self.settings)
        if is_unseen:
            note = asyncio.create_task(run_in_threadpool(note_seen, database, visitor, self.settings))
            self._notes.add(note)
            note.add_done_callback(self._notes.discard)
        return visitor

    def _watch(self, scope: Scope, receive: Receive) -> Receive:
        """`receive` for as long as the login lasts: to a stream or socket whose login ended the browser has gone."""
        checked = time.monotonic()
        gone: Message = {"type": "http.disconnect"}
        if scope["type"] == "websocket":
            gone = {"type": "websocket.disconnect", "code": 1008, "reason": "log in again"}

        async def receive_while_let_in() -> Message:
            nonlocal checked
            waiting = asyncio.ensure_future(receive())
            try:
                while True:
                    left = checked + RECHECK_SECONDS - time.monotonic()
                    done, _ = await asyncio.wait({waiting}, timeout=max(0.0, left))
                    if time.monotonic() - checked >= RECHECK_SECONDS:
                        checked = time.monotonic()
                        await self._let_in(scope)
                    if done:
                        return waiting.result()
            except StudioError:
                return gone
            finally:
                waiting.cancel()

        return receive_while_let_in


def _is_near(scope: Scope) -> bool:
    """Whether a request comes from this machine; what has no IP address (a socket file) does."""
    client = scope.get("client")
    try:
        return client is None or ipaddress.ip_address(client[0]).is_loopback
    except ValueError:
        return True
