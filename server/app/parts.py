"""What the app is put together from. A new room adds its router here, and what it starts and stops with the app."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager

from fastapi import APIRouter, FastAPI

from server.accounts import routes as accounts
from server.app import health

Lifespan = Callable[[FastAPI], AbstractAsyncContextManager[None]]

ROUTERS: tuple[APIRouter, ...] = (
    health.router,
    accounts.router,
)
"""All under `/api/v1`."""

PAGE_ROUTERS: tuple[APIRouter, ...] = ()
"""Those with addresses of their own, such as the viewer's page."""

LIFESPANS: tuple[Lifespan, ...] = ()
"""Entered in this order when the app starts (database and storage are there), left in reverse when it stops."""
