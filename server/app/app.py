"""The app factory."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from functools import cache

from fastapi import APIRouter, FastAPI
from fastapi.routing import APIRoute
from starlette.concurrency import run_in_threadpool
from starlette.routing import BaseRoute

from server.access.login_throttle import LoginThrottle
from server.app.authentication import Authentication
from server.app.browser_app import BrowserApp
from server.app.compression import Compression
from server.app.document import DocumentedApp
from server.app.error_handler import install_error_handler
from server.app.methods import Methods
from server.app.parts import (
    LIFESPANS,
    PAGE_ROUTERS,
    ROUTERS,
    SCAN_RESIZED,
    SCAN_SUMMARIES,
    SEQUENCE_SUMMARIES,
)
from server.app.request_checks import RequestChecks
from server.compute import Compute
from server.database import Admission, Database
from server.database.migrate import upgrade
from server.errors import error_responses
from server.live.visits import Visits
from server.live.watch import Watches
from server.sequences.frame_images import FrameImages
from server.settings import Settings
from server.storage import open_storage

log = logging.getLogger(__name__)

API = "/api/v1"


def create_app(settings: Settings | None = None) -> FastAPI:
    """The whole application. Its tables are brought up to date when it starts, not here."""
    settings = settings or Settings()
    app = DocumentedApp(
        title="Handloom",
        version="1",
        description="A studio that captures hands in action: recordings, annotations, tracking, scans, hand models.",
        openapi_url=f"{API}/openapi.json",
        docs_url=None,  # both of FastAPI's pages load scripts from elsewhere
        redoc_url=None,
        lifespan=_lifespan,
    )
    app.state.settings = settings
    app.state.login_throttle = LoginThrottle()
    app.state.visits = Visits()
    app.state.watches = Watches()
    app.state.sequence_summaries = SEQUENCE_SUMMARIES
    app.state.scan_summaries = SCAN_SUMMARIES
    app.state.scan_resized = SCAN_RESIZED
    install_error_handler(app)
    app.router.routes.extend(_routes())
    app.router.default = BrowserApp(settings.web_dist)  # what no route takes
    app.add_middleware(Methods, prefix=API, routers=ROUTERS)
    app.add_middleware(Compression)
    app.add_middleware(Authentication, settings=settings)
    app.add_middleware(RequestChecks, settings=settings)  # added last, so it stands outermost
    return app


@cache
def _routes() -> tuple[BaseRoute, ...]:
    """Of all rooms; apps of a process share them, because to read what their functions take is a third of a second."""
    whole = APIRouter(generate_unique_id_function=_operation_id)
    for router in ROUTERS:
        whole.include_router(router, prefix=API, responses=error_responses(401, 403, 404, 500, 503, 507))
    for router in PAGE_ROUTERS:
        whole.include_router(router)
    return tuple(whole.routes)


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    settings: Settings = app.state.settings
    async with AsyncExitStack() as stack:
        storage = app.state.storage = await run_in_threadpool(open_storage, settings)
        database = app.state.database = Database(settings.sqlalchemy_url)
        stack.callback(database.close)
        app.state.admission = Admission(database)
        stack.callback(app.state.admission.close)
        await run_in_threadpool(upgrade, database)
        app.state.compute = Compute(settings, database, storage)
        stack.push_async_callback(run_in_threadpool, app.state.compute.close)
        app.state.frame_images = FrameImages(database, storage, settings.image_cache_mb * 1_000_000)
        for lifespan in LIFESPANS:
            await stack.enter_async_context(lifespan(app))
        log.info("The studio's data: %s", settings.data_dir)
        yield


def _operation_id(route: APIRoute) -> str:
    return route.name
