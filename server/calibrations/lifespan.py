"""What calibrations do when the app starts."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import FastAPI
from starlette.concurrency import run_in_threadpool

from server.calibrations.service import remove_abandoned

log = logging.getLogger(__name__)


@asynccontextmanager
async def clean_films(app: FastAPI) -> AsyncIterator[None]:
    """Remove films that nobody needs any more."""
    state = app.state
    hours = state.settings.abandoned_import_hours
    if removed := await run_in_threadpool(remove_abandoned, state.database, state.storage, hours):
        log.info("Removed %d abandoned uploads of films.", removed)
    yield
