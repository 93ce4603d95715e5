"""What imports do when the app starts."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool

from server.imports.service import ImportContext, remove_abandoned

log = logging.getLogger(__name__)


@asynccontextmanager
async def clean_imports(app: FastAPI) -> AsyncIterator[None]:
    """Remove abandoned uploads."""
    context = ImportContext(app.state.database, app.state.storage, app.state.settings)
    if removed := await run_in_threadpool(remove_abandoned, context):
        log.info("Removed %d abandoned uploads.", removed)
    yield
