"""`/sequences/{sequence_id}/live` and the visits of those who listen to it."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Query, Request
from fastapi.responses import StreamingResponse
from starlette.requests import HTTPConnection

from server.access.policy import find_hidden
from server.access.service import CurrentAccount
from server.annotations.routes import ReplicaDep
from server.annotations.service import check_place
from server.database import DatabaseDep
from server.errors import OtherAccountError, error_responses
from server.jobs.routes import EVENT_STREAM, answer_stream
from server.live.feed import Listener, RecordingFeed
from server.live.schemas import VisitPut
from server.live.visits import Visit, Visits
from server.live.watch import Watches
from server.sequences.service import get_sequence

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["live"], responses=error_responses(404))


async def get_watches(connection: HTTPConnection) -> Watches:
    """The app's."""
    return connection.app.state.watches


async def get_visits(connection: HTTPConnection) -> Visits:
    """The app's."""
    return connection.app.state.visits


VisitsDep = Annotated[Visits, Depends(get_visits)]


async def get_listener(
    account: CurrentAccount,
    replica: ReplicaDep,
    visit: Annotated[uuid.UUID | None, Query(description="Of the page that listens; it ends with the stream.")] = None,
    reader: Annotated[uuid.UUID | None, Query(description="The account that the page was opened for.")] = None,
) -> Listener:
    """Who listens, who must be the one that the page was opened for."""
    if reader is not None and reader != account.id:
        raise OtherAccountError("This page belongs to somebody else. Log in again, or load the page.")
    return Listener(account, replica, visit)


@router.get("/live", response_class=StreamingResponse, responses=EVENT_STREAM)
def stream_recording(
    sequence_id: uuid.UUID,
    request: Request,
    database: DatabaseDep,
    listener: Annotated[Listener, Depends(get_listener)],
    watches: Annotated[Watches, Depends(get_watches)],
    visits: VisitsDep,
    after: Annotated[
        str | None, Query(max_length=200, description="As `Last-Event-ID`, or `~` and the time of the labels at hand.")
    ] = None,
    last_event_id: Annotated[str | None, Header()] = None,
) -> StreamingResponse:
    """What others do in a recording, within a second: `event: label` with a hand as it is now, `event: keys` with all
    key frames, `event: work` when an assignment or a comment has changed, `event: people` with who else is here,
    `event: sight` with what is hidden from whoever listens, and `event: job` as in `/jobs/events`."""
    with database.reading() as session:
        get_sequence(session, sequence_id)
        find_hidden(session, listener.account, sequence_id, listener.replica)
    return answer_stream(
        request, database, RecordingFeed.after(last_event_id or after, watches.of(sequence_id), visits, listener)
    )


@router.put("/visits/{visit_id}", status_code=204)
def put_visit(
    sequence_id: uuid.UUID,
    visit_id: uuid.UUID,
    body: VisitPut,
    database: DatabaseDep,
    account: CurrentAccount,
    visits: VisitsDep,
) -> None:
    """Say where one is in a recording; a page says it when it moves, and every 10 s. Who marks blindly is not shown."""
    with database.reading() as session:
        check_place(get_sequence(session, sequence_id), body.camera, body.frame, body.hand)
        is_blind = bool(find_hidden(session, account, sequence_id))
    if not is_blind:
        visits.put(visit_id, Visit(sequence_id, account.id, account.name, **body.model_dump()))
