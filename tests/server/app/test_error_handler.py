"""Every error leaves as `{"error", "detail"}` with its status, and tells nothing of where the studio keeps things."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from server.app.error_handler import answer_error, describe_faults
from server.errors import ConflictError
from tracker.errors import AnnotationError, ModelFileError


def asked(method: str = "GET", content_type: str = "application/json") -> Request:
    app = FastAPI()
    app.state.settings = SimpleNamespace(data_dir=Path("/srv/studio"))
    headers = [(b"content-type", content_type.encode())]
    scope = {"type": "http", "method": method, "path": "/api/v1/x", "headers": headers, "app": app}
    return Request({**scope, "query_string": b"", "server": ("localhost", 80), "scheme": "http"})


def answer(error: Exception, request: Request | None = None) -> tuple[int, dict[str, Any], dict[str, str]]:
    found = answer_error(request or asked(), error)
    return found.status_code, json.loads(cast(bytes, found.body)), dict(found.headers)


def full_disk() -> OperationalError:
    cause = sqlite3.OperationalError("database or disk is full")
    cause.sqlite_errorcode = sqlite3.SQLITE_FULL
    return OperationalError("INSERT", {}, cause)


@pytest.mark.parametrize(
    ("error", "status", "name", "told"),
    [
        (ConflictError("Somebody was first."), 409, "ConflictError", "Somebody was first."),
        (HTTPException(404), 404, "NotFoundError", "There is nothing to GET at /api/v1/x."),
        (HTTPException(405), 405, "MethodNotAllowedError", "There is nothing to GET at /api/v1/x."),
        (HTTPException(404, "No frame 9."), 404, "NotFoundError", "No frame 9."),
        (HTTPException(418, "tea"), 418, "RequestError", "tea"),
        (HTTPException(400), 422, "InvalidError", "needed JSON in UTF-8"),
        (ClientDisconnect(), 400, "ClientGoneError", "did not arrive"),
        (full_disk(), 507, "DiskFullError", "disk of the studio is full"),
        (OperationalError("SELECT", {}, Exception("locked")), 503, "DatabaseUnavailableError", "Try again"),
        (ZeroDivisionError("secret"), 500, "InternalError", "its log says why"),
    ],
)
def test_an_error_has_a_status_a_name_and_words_for_people(error: Exception, status: int, name: str, told: str) -> None:
    code, body, _ = answer(error)
    assert (code, body["error"]) == (status, name) and told in body["detail"] and "secret" not in body["detail"]


def test_what_will_pass_says_when_to_try_again() -> None:
    assert answer(full_disk())[2]["retry-after"] == "5"
    assert answer(OperationalError("SELECT", {}, Exception("locked")))[2]["retry-after"] == "1"


def test_further_members_of_an_error_are_in_the_body() -> None:
    assert answer(ConflictError("Newer.", theirs={"revision": 4}))[1]["theirs"] == {"revision": 4}


def test_files_are_told_by_their_own_names() -> None:
    upload = "/srv/studio/scan_uploads/01234567-89ab-cdef-0123-456789abcdef/hand.ply"
    code, body, _ = answer(ModelFileError(upload, "nothing", "a hand"))
    assert (code, body) == (422, {"error": "ModelFileError", "detail": "hand.ply: found nothing; needed a hand."})
    assert answer(AnnotationError("Two things.", ("one", "two")))[1]["details"] == ["one", "two"]


def test_a_form_that_cannot_be_read_is_said_to_be_a_form() -> None:
    told = answer(HTTPException(400), asked("POST", "multipart/form-data; boundary=x"))[1]["detail"]
    assert "a form as browsers send it" in told


def test_the_first_five_faults_of_a_request_are_told_with_place_and_value_cut_short() -> None:
    faults = [{"loc": ("body", "points", n), "msg": "Input should be a number", "input": "x" * 200} for n in range(7)]
    told = describe_faults(faults)
    assert told.startswith("body.points.0: Input should be a number (got 'xxx") and told.endswith("And 2 more.")
    assert told.count("Input should be") == 5 and len(told) < 800
    assert answer(RequestValidationError(faults))[:2] == (422, {"error": "InvalidError", "detail": told})
