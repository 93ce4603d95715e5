"""The one handler: every error leaves as `{"error", "detail"}` with its status."""

from __future__ import annotations

import logging
import re
import sqlite3
from collections.abc import Sequence
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse, Response

from server.errors import StudioError
from tracker import TrackerError

log = logging.getLogger(__name__)

UPLOADED = re.compile(r"\b\w+_uploads/[0-9a-f-]{36}/")
"""Where an upload lies while it is read: people know their file by its own name."""

_NAMES = {404: "NotFoundError", 405: "MethodNotAllowedError", 413: "TooLargeError"}


def install_error_handler(app: FastAPI) -> None:
    """Have the app answer errors by `answer_error`; unexpected ones reach it from `RequestChecks`."""
    for kind in (StudioError, TrackerError, RequestValidationError, HTTPException):
        app.add_exception_handler(kind, answer_error)


def answer_error(request: Request, error: Exception) -> Response:
    """The answer to a request that failed with this error."""
    if isinstance(error, StudioError):
        body = {"error": type(error).__name__, "detail": error.detail, **error.extra}
        return JSONResponse(body, error.status_code, headers=error.headers)
    if isinstance(error, TrackerError):
        # its messages name files in full; where the studio keeps them is nobody's business
        detail = UPLOADED.sub("", str(error).replace(f"{request.app.state.settings.data_dir}/", ""))
        body: dict[str, Any] = {"error": type(error).__name__, "detail": detail}
        if details := getattr(error, "details", ()):
            body["details"] = list(details)
        return JSONResponse(body, 422)
    if isinstance(error, RequestValidationError):
        return _answer(422, "InvalidError", describe_faults(error.errors()))
    if isinstance(error, HTTPException) and error.status_code == 400:  # FastAPI's word for a body that is no text
        return _answer(422, "InvalidError", f"The body of the request cannot be read: needed {_needed(request)}.")
    if isinstance(error, HTTPException):
        name = _NAMES.get(error.status_code, "RequestError")
        detail = str(error.detail)
        if error.status_code in (404, 405) and detail in ("Not Found", "Method Not Allowed"):
            detail = f"There is nothing to {request.method} at {request.url.path}."
        return _answer(error.status_code, name, detail, dict(error.headers or {}))
    if isinstance(error, ClientDisconnect):
        log.info("%s %s: the client has gone", request.method, request.url.path)
        return _answer(400, "ClientGoneError", "The request did not arrive completely.")
    if isinstance(error, OperationalError) and _is_disk_full(error):
        log.error("%s %s: the disk is full", request.method, request.url.path)
        detail = "The disk of the studio is full; this was not stored; what was stored before is safe. Free some space."
        return _answer(507, "DiskFullError", detail, {"Retry-After": "5"})
    if isinstance(error, OperationalError):
        log.warning("%s %s: the database does not answer", request.method, request.url.path, exc_info=error)
        detail = "The database is busy or cannot be reached; nothing was stored. Try again."
        return _answer(503, "DatabaseUnavailableError", detail, {"Retry-After": "1"})
    log.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return _answer(
        500, "InternalError", "The studio failed to do this; its log says why. What was saved before is safe."
    )


def _is_disk_full(error: OperationalError) -> bool:
    original = error.orig
    if isinstance(original, sqlite3.Error):
        return getattr(original, "sqlite_errorcode", None) == sqlite3.SQLITE_FULL
    return getattr(original, "sqlstate", None) == "53100"


def describe_faults(faults: Sequence[Any]) -> str:
    """The first few of pydantic's findings, one sentence each, with the place and the value."""
    sentences = []
    for fault in faults[:5]:
        place = ".".join(str(part) for part in fault["loc"])
        value = repr(fault.get("input"))
        value = value if len(value) <= 80 else value[:77] + "..."
        sentences.append(f"{place}: {fault['msg']} (got {value}).")
    if len(faults) > 5:
        sentences.append(f"And {len(faults) - 5} more.")
    return " ".join(sentences)


def _needed(request: Request) -> str:
    if request.headers.get("content-type", "").startswith("multipart/"):
        return "a form as browsers send it, its boundary as in Content-Type"
    return "JSON in UTF-8"


def _answer(status: int, error: str, detail: str, headers: dict[str, str] | None = None) -> Response:
    return JSONResponse({"error": error, "detail": detail}, status, headers=headers)
