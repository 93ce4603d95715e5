"""Authentication: only known people reach the API and the viewer. What is open to all is listed here only."""

from __future__ import annotations

import asyncio
import ipaddress
import time

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.access.authentication import find_user, note_seen
from server.access.current_user import LOCAL_USER, CurrentUser, put_current_user
from server.access.same_origin import SAFE_METHODS
from server.app.error_handler import answer_error
from server.database import Database
from server.errors import ForbiddenError, LoginNeededError, OtherAccountError, StudioError
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

ACCOUNT_HEADER = "X-Handloom-Account"
"""The id of the account that a page was opened for."""

RECHECK_SECONDS = 5.0
"""A stream or socket that stays open ends so long after its login did, at the latest."""


class Authentication:
    """Finds out who makes a request, and refuses those who are not known."""

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
            user = await self.let_in(scope)
            _check_is_meant(scope, user)
            if method not in SAFE_METHODS and not user.may_write:
                raise ForbiddenError("This token may only read. Make one that may write on the page of your account.")
        except StudioError as error:
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 1008, "reason": "log in first"})
                return
            await answer_error(Request(scope), error)(scope, receive, send)
            return
        put_current_user(scope, user)
        if user.login_id is None and user.token_id is None:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket" or method == "GET":
            await _Stay(self, scope, receive, send).last(self.app)
        else:
            await self.app(scope, receive, send)

    async def let_in(self, scope: Scope) -> CurrentUser:
        if not self.settings.is_login_needed and not _is_near(scope):
            raise LoginNeededError("This studio has no login, so it answers only this machine.")
        headers = Headers(scope=scope)
        if not self.settings.is_login_needed and "authorization" not in headers:
            return LOCAL_USER
        database: Database = scope["app"].state.database
        user, is_unseen = await run_in_threadpool(find_user, database, headers, self.settings)
        if is_unseen:
            note = asyncio.create_task(run_in_threadpool(note_seen, database, user, self.settings))
            self._notes.add(note)
            note.add_done_callback(self._notes.discard)
        return user


class _Stay:
    """A request that may last: when its login ends, to a stream or socket it is as if the browser had gone."""

    def __init__(self, authentication: Authentication, scope: Scope, receive: Receive, send: Send) -> None:
        self._authentication, self._scope, self._receive, self._send = authentication, scope, receive, send
        self._checked = time.monotonic()
        self._has_ended = self._is_open = False

    async def last(self, app: ASGIApp) -> None:
        await app(self._scope, self.receive, self.send)
        if self._has_ended and self._is_open and self._scope["type"] == "http":
            await self._send({"type": "http.response.body", "body": b"", "more_body": False})

    async def send(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self._is_open = True
        elif message["type"] == "http.response.body":
            self._is_open = message.get("more_body", False)
        await self._send(message)

    async def receive(self) -> Message:
        waiting = asyncio.ensure_future(self._receive())
        try:
            while True:
                left = self._checked + RECHECK_SECONDS - time.monotonic()
                done, _ = await asyncio.wait({waiting}, timeout=max(0.0, left))
                if time.monotonic() - self._checked >= RECHECK_SECONDS:
                    self._checked = time.monotonic()
                    await self._authentication.let_in(self._scope)
                if done:
                    return waiting.result()
        except StudioError:
            self._has_ended = True
            if self._scope["type"] == "websocket":
                return {"type": "websocket.disconnect", "code": 1008, "reason": "log in again"}
            return {"type": "http.disconnect"}
        finally:
            waiting.cancel()


def _check_is_meant(scope: Scope, user: CurrentUser) -> None:
    """A page says whose it is: what one person did must not be stored under the name of the next one who logs in."""
    meant = Headers(scope=scope).get(ACCOUNT_HEADER)
    if meant is not None and meant != str(user.account_id):
        raise OtherAccountError(
            f"This page belongs to somebody else; {user.name} is logged in now. Log in again, or load the page."
        )


def _is_near(scope: Scope) -> bool:
    """Whether a request comes from this machine; what has no IP address (a socket file) does."""
    client = scope.get("client")
    try:
        return client is None or ipaddress.ip_address(client[0]).is_loopback
    except ValueError:
        return True
