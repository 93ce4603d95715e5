"""`/viewer-sessions` of the API, and the viewer's page and socket under `/viewer/<id>/`."""

from __future__ import annotations

import uuid
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Annotated, Any

from fastapi import APIRouter, Depends, FastAPI, Response, WebSocket
from fastapi.responses import RedirectResponse
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from server.access.service import CurrentAccount
from server.database import DatabaseDep
from server.errors import StudioError, error_responses
from server.storage import StorageDep
from server.tracks.seen_track import get_seen_track
from server.viewer import proxy
from server.viewer.schemas import Show, ViewerSessionChange, ViewerSessionCreate, ViewerSessionOut
from server.viewer.sessions import OpenSession, ViewerSessions

router = APIRouter(tags=["viewer"], responses=error_responses())
page_router = APIRouter(include_in_schema=False)


@asynccontextmanager
async def lifespan(app: FastAPI) -> AsyncIterator[None]:
    """The sessions last as long as the app."""
    app.state.viewer_sessions = ViewerSessions()
    try:
        yield
    finally:
        await run_in_threadpool(app.state.viewer_sessions.stop)


async def get_sessions(connection: HTTPConnection) -> ViewerSessions:
    """The app's viewer sessions."""
    return connection.app.state.viewer_sessions


SessionsDep = Annotated[ViewerSessions, Depends(get_sessions)]


@router.post("/viewer-sessions", status_code=201, responses=error_responses(404, 500))
def create_viewer_session(
    body: ViewerSessionCreate,
    database: DatabaseDep,
    storage: StorageDep,
    sessions: SessionsDep,
    account: CurrentAccount,
) -> ViewerSessionOut:
    """Open a track in 3D."""
    track = get_seen_track(body.track_id, database, account)
    recording, folder = storage.folder("sequences", track.sequence_id), storage.folder("tracks", track.id)
    return _out(*sessions.open(track.id, recording, folder, body.frame, _changes(body.show)))


@router.put("/viewer-sessions/{session_id}", responses=error_responses(404, 500))
def change_viewer_session(session_id: uuid.UUID, body: ViewerSessionChange, sessions: SessionsDep) -> ViewerSessionOut:
    """Go to a frame, show or hide layers. Of requests that overtake each other the last one counts."""
    return _out(*sessions.show(session_id, body.frame, _changes(body.show)))


@router.delete("/viewer-sessions/{session_id}", status_code=204)
def close_viewer_session(session_id: uuid.UUID, sessions: SessionsDep) -> Response:
    """Close a session; closing it twice does no harm."""
    sessions.close(session_id)
    return Response(status_code=204)


@page_router.get("/viewer/{session_id}")
def redirect_to_viewer_page(session_id: uuid.UUID) -> RedirectResponse:
    return RedirectResponse(f"/viewer/{session_id}/")


@page_router.get("/viewer/{session_id}/{path:path}")
def get_viewer_page(session_id: uuid.UUID, path: str, sessions: SessionsDep) -> Response:
    return proxy.fetch_page(sessions.get(session_id).port, path)


@page_router.websocket("/viewer/{session_id}")
@page_router.websocket("/viewer/{session_id}/")
async def relay_viewer_socket(websocket: WebSocket, session_id: uuid.UUID, sessions: SessionsDep) -> None:
    """The socket of the page. Host and Origin were checked before anything gets here."""
    try:
        session = sessions.get(session_id)
    except StudioError:
        await websocket.close(1008, "no such view")
        return
    session.pages += 1
    try:
        await proxy.relay(websocket, session.port)
    finally:
        session.pages -= 1


ANSWERED = ("frame", "terms", "detections", "collisions", "contacts", "unknown", "distances", "milliseconds")


def _changes(show: Show | None) -> dict[str, Any]:
    return {} if show is None else show.model_dump(exclude_none=True)


def _out(session: OpenSession, answer: dict[str, Any]) -> ViewerSessionOut:
    return ViewerSessionOut.model_validate(
        {
            "id": session.id,
            "track_id": session.track_id,
            "url": f"/viewer/{session.id}/",
            **{name: answer[name] for name in ANSWERED},
        }
    )
