"""A client that goes away in the middle of its upload, at a real server."""

from __future__ import annotations

import socket
import threading
import time
from pathlib import Path

import httpx
import uvicorn

from server.app import create_app
from server.settings import Settings

HEAD = b"""POST /api/v1/imports HTTP/1.1\r
Host: 127.0.0.1\r
Content-Type: multipart/form-data; boundary=b\r
Content-Length: 9000000\r
\r
--b\r
Content-Disposition: form-data; name="files"; filename="a.png"\r
\r
"""


def wait_until(is_so, seconds: float = 10) -> None:
    end = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_nothing_is_kept_of_an_upload_whose_client_has_gone(tmp_path: Path) -> None:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        server = uvicorn.Server(uvicorn.Config(create_app(Settings(data_dir=tmp_path)), log_level="error"))
        thread = threading.Thread(target=server.run, args=([listener],))
        thread.start()
        try:
            wait_until(lambda: server.started, 30)
            port, uploads = listener.getsockname()[1], tmp_path / "uploads"
            with socket.create_connection(("127.0.0.1", port)) as client:
                client.sendall(HEAD + bytes(3_000_000))
                wait_until(lambda: any(path.stat().st_size > 1_000_000 for path in uploads.glob("*/files/a.png")))
            wait_until(lambda: list(uploads.iterdir()) == [])
            assert httpx.get(f"http://127.0.0.1:{port}/api/v1/health").status_code == 200
        finally:
            server.should_exit = True
            thread.join(20)
        assert not thread.is_alive()
