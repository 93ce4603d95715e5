"""The web server of the studio."""

from __future__ import annotations

import socket
import sys
from types import FrameType

import uvicorn

from server.app import create_app
from server.settings import Settings
from server.suggestions.service import warm_up

GRACE_SECONDS = 3
"""How long open requests may take when the studio stops."""


class StudioServer(uvicorn.Server):
    """uvicorn, which tells the app when it stops, so that event streams end, and people where it is."""

    def __init__(self, settings: Settings, sock: socket.socket) -> None:
        host, port = sock.getsockname()[:2]
        app = create_app(settings.model_copy(update={"port": port}))
        self._address = f"http://{f'[{host}]' if ':' in host else host}:{port}"
        self._data_dir = settings.data_dir
        self._app = app
        super().__init__(
            uvicorn.Config(
                app,
                log_config=None,
                access_log=False,
                server_header=False,
                proxy_headers=False,
                ws_per_message_deflate=False,  # the viewer's arrays do not get smaller
                timeout_graceful_shutdown=GRACE_SECONDS,
            )
        )

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            sys.stdout.write(f"Handloom is at {self._address} (data in {self._data_dir}). Stop it with Ctrl+C.\n")
            sys.stdout.flush()
            self._app.state.viewer_sessions.prepare()
            self._app.state.compute.start(warm_up)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        self._app.state.is_stopping = True
        super().handle_exit(sig, frame)
