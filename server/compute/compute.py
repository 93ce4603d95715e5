"""Where the routes have computed what takes long."""

from __future__ import annotations

import logging
from asyncio import get_running_loop
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated, Concatenate, ParamSpec, TypeVar

from fastapi import Depends
from starlette.requests import HTTPConnection

from server.compute.context import ComputeContext
from server.compute.process import ComputeProcess, ComputeStoppedError
from server.database import Database
from server.settings import Settings
from server.storage import Storage

log = logging.getLogger(__name__)

THREADS = 6
"""Questions that are computed at once. They are answered on as many connections of the database, of 15."""

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


class Compute:
    """Computes in a process of its own once `start` was called, before that in threads of this one."""

    def __init__(self, settings: Settings, database: Database, storage: Storage) -> None:
        self._settings = settings
        self._here = ComputeContext(database, storage)
        self._threads = ThreadPoolExecutor(THREADS, "compute")
        self._process: ComputeProcess | None = None

    def start(self, prepare: Callable[[ComputeContext], None]) -> None:
        """From now on in a process of its own, which begins with `prepare` while nobody waits for it."""
        self._process = ComputeProcess(self._settings)
        self._threads.submit(self._prepare, prepare)

    async def run(
        self,
        work: Callable[Concatenate[ComputeContext, Arguments], Result],
        *arguments: Arguments.args,
        **named: Arguments.kwargs,
    ) -> Result:
        """What a function of a module gives. It, its arguments and its result go from process to process by pickle."""
        assert not named, "arguments go by their place"
        return await get_running_loop().run_in_executor(self._threads, self._compute, work, arguments)

    def ask(
        self,
        work: Callable[Concatenate[ComputeContext, Arguments], Result],
        *arguments: Arguments.args,
        **named: Arguments.kwargs,
    ) -> Result:
        """As `run`, for a route that waits in a thread of its own."""
        assert not named, "arguments go by their place"
        return self._threads.submit(self._compute, work, arguments).result()

    def close(self) -> None:
        """End the process and the threads."""
        if self._process is not None:
            self._process.close()
        self._threads.shutdown(cancel_futures=True)

    def _prepare(self, prepare: Callable[[ComputeContext], None]) -> None:
        try:
            if self._process is None:
                prepare(self._here)
            else:  # to compile takes as long as it takes
                self._process.ask(prepare, (), limit_seconds=None)
        except ComputeStoppedError as error:
            log.info("not prepared: %s", error)
        except Exception:
            log.exception("The process that computes is not prepared: the first question will take longer.")

    def _compute(self, work: Callable[..., Result], arguments: tuple[object, ...]) -> Result:
        if self._process is None:
            return work(self._here, *arguments)
        return self._process.ask(work, arguments)


async def get_compute(connection: HTTPConnection) -> Compute:
    """The app's."""
    return connection.app.state.compute


ComputeDep = Annotated[Compute, Depends(get_compute)]
