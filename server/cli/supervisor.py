"""Keeps a worker process running beside the web server."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import TracebackType

from server.settings import Settings

log = logging.getLogger(__name__)

CODE = Path(__file__).resolve().parents[2]
"""Where Python finds `server`, installed or not."""

STOP_SECONDS = 8.0
FIRST_PAUSE, LONGEST_PAUSE = 0.5, 30.0
"""s before a worker that died is started again; doubled every time it dies young."""

YOUNG = 30.0
"""s."""


class WorkerSupervisor:
    """Starts a worker, and another whenever it dies. The worker ends with this process, even if this one is killed."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="worker-supervisor", daemon=True)

    def __enter__(self) -> WorkerSupervisor:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stopping.set()
        self._thread.join()

    def _run(self) -> None:
        pause = FIRST_PAUSE
        while not self._stopping.is_set():
            began = time.monotonic()
            code = self._run_once()
            if self._stopping.is_set():
                return
            if time.monotonic() - began > YOUNG:
                pause = FIRST_PAUSE
            log.error("the worker ended (%s); starting another in %.1f s", _describe_exit(code), pause)
            self._stopping.wait(pause)
            pause = min(2.0 * pause, LONGEST_PAUSE)

    def _run_once(self) -> int:
        """Run one worker to its end."""
        command = [sys.executable, "-m", "server.cli", "worker", "--with-parent"]
        environment = {**os.environ, "HANDLOOM_DATA_DIR": str(self._settings.data_dir)}
        if self._settings.database_url is not None:
            environment["HANDLOOM_DATABASE_URL"] = self._settings.database_url
        with subprocess.Popen(
            command, stdin=subprocess.PIPE, cwd=CODE, env=environment, start_new_session=True
        ) as process:
            while process.poll() is None:
                if self._stopping.wait(0.2):
                    process.terminate()
                    try:
                        process.wait(STOP_SECONDS)
                    except subprocess.TimeoutExpired:
                        process.kill()
            return process.returncode


def _describe_exit(code: int) -> str:
    return f"killed by signal {-code}" if code < 0 else f"exit code {code}"
