"""Serves the built browser app: its files, and `index.html` for every address that the app routes itself."""

from __future__ import annotations

import mimetypes
from pathlib import Path

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, HTMLResponse, Response
from starlette.types import Receive, Scope, Send

from server.app.compression import find_codings

SERVER = Path(__file__).resolve().parents[1]
PACKAGED = SERVER / "app" / "static"
"""Where a wheel carries it."""
BUILT = SERVER.parent / "web" / "dist"
"""Where a clone builds it."""

PACKED = {"br": ".br", "gzip": ".gz"}
"""Files that the build packed beside themselves, the smallest first."""
IMMUTABLE = "public, max-age=31536000, immutable"
ICONS = ("/icon.svg", "/favicon.ico")
ICON = "public, max-age=86400"
"""A day: browsers ask for it at every change of address."""
NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Handloom</title>
<body style="font: 16px system-ui; max-width: 40em; margin: 4em auto">
<h1>The browser app is not built</h1>
<p>The server works: its API answers at <a href="/api/v1/health">/api/v1/health</a>. To build the app, run
<code>make setup</code> in the project's folder and load this page again. An app built elsewhere is named by
<code>HANDLOOM_WEB_DIST</code>.</p>"""

mimetypes.add_type("text/javascript", ".js")  # some systems say text/plain, and nosniff then refuses to run it
mimetypes.add_type("application/wasm", ".wasm")


class BrowserApp:
    """An ASGI app for all that no route takes.

    The files are listed anew whenever `index.html` changes; an address is looked up in that list, it never becomes a
    path.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder or (PACKAGED if (PACKAGED / "index.html").is_file() else BUILT)
        self._built_at: int | None = None
        self._files: dict[str, Path] = {}
        self._packed: dict[str, Path] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await send({"type": "websocket.close", "code": 1008, "reason": "not found"})
            return
        path = scope["path"]
        is_app_address = not path.startswith(("/api/", "/viewer/")) and path != "/api"
        if not is_app_address:
            raise HTTPException(404)
        if scope["method"] not in ("GET", "HEAD"):
            raise HTTPException(405, headers={"Allow": "GET, HEAD"})
        response = await run_in_threadpool(self._find, path, Headers(scope=scope))
        await response(scope, receive, send)

    def _find(self, path: str, headers: Headers) -> Response:
        files = self._list_files()
        if "/index.html" not in files:
            return HTMLResponse(
                NOT_BUILT, 503, headers={"Content-Security-Policy": "default-src 'self' 'unsafe-inline'"}
            )
        if path in files and path != "/index.html":
            is_hashed = path.startswith("/assets/")
            return self._answer(path, headers, IMMUTABLE if is_hashed else ICON if path in ICONS else "no-cache")
        if path.startswith("/assets/"):
            raise HTTPException(404)
        return self._answer("/index.html", headers, "no-cache")

    def _answer(self, name: str, headers: Headers, cache_control: str) -> Response:
        """A file, packed in a way that the browser takes where the build did so."""
        path, common = self._files[name], {"Cache-Control": cache_control}
        codings = find_codings(headers)
        packed = {coding: self._packed[name + end] for coding, end in PACKED.items() if name + end in self._packed}
        if packed:
            common["Vary"] = "Accept-Encoding"
        coding = next((coding for coding in packed if coding in codings), None)
        if coding is not None:
            common["Content-Encoding"] = coding
        kind = mimetypes.guess_type(path.name)[0]
        return _file(packed[coding] if coding else path, kind, headers, common)

    def _list_files(self) -> dict[str, Path]:
        try:
            built_at = (self.folder / "index.html").stat().st_mtime_ns
        except OSError:
            self._built_at, self._files, self._packed = None, {}, {}
            return {}
        if built_at != self._built_at:
            found = (path for path in self.folder.rglob("*") if path.is_file())
            known = {f"/{path.relative_to(self.folder).as_posix()}": path for path in found}
            self._packed = {name: known.pop(name) for name in list(known) if name.endswith((".br", ".gz"))}
            self._files = known
            self._built_at = built_at
        return self._files


def _file(path: Path, kind: str | None, headers: Headers, common: dict[str, str]) -> Response:
    """A file as it lies there; its tag is of its own bytes, so each way of packing has another."""
    try:
        stat = path.stat()
    except OSError:
        raise HTTPException(404) from None
    etag = f'"{stat.st_mtime_ns:x}-{stat.st_size:x}"'
    common = {**common, "ETag": etag}
    if etag in [tag.strip().removeprefix("W/") for tag in headers.get("if-none-match", "").split(",")]:
        return Response(status_code=304, headers={name: common[name] for name in common if name != "Content-Encoding"})
    return FileResponse(path, headers=common, stat_result=stat, media_type=kind)
